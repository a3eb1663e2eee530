// Preloaded into sanitized tests: libraries stay loaded to the end, so that a report of leaks can name the
// driver or the layer that a block comes from, and tests/lsan.supp can tell it from ours.
extern "C" int dlclose(void* /*handle*/) {
    return 0;
}
