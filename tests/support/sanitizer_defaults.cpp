// This library is preloaded into sanitized tests and the commands that they run.

// Libraries stay loaded to the end, so that a report of leaks can name the driver or layer that allocated a
// block.
extern "C" int dlclose(void* /*handle*/) {
    return 0;
}

// The run-time libraries of the sanitizers ask for these by name.
// NOLINTBEGIN(bugprone-reserved-identifier, readability-identifier-naming)

extern "C" const char* __asan_default_options() {
    return "verify_asan_link_order=0";  // this library comes before theirs
}

extern "C" const char* __ubsan_default_options() {
    return "print_stacktrace=1";
}

// These leaks are not ours to fix: the validation layer's table of enabled features.
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libVkLayer_khronos_validation.so\n";
}

extern "C" const char* __lsan_default_options() {
    return "print_suppressions=0";
}

// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming)
