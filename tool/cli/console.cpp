#include "cli/console.h"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <unistd.h>

namespace glint {

namespace {

constexpr const char* kClearLine = "\r\x1b[K";
constexpr const char* kReset = "\x1b[0m";

void write(std::FILE* stream, std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stream);
}

const char* colorOf(Severity severity) {
    switch (severity) {
        case Severity::Error:
            return "\x1b[1;31m";
        case Severity::Warning:
            return "\x1b[1;33m";
        case Severity::Note:
            break;
    }
    return "\x1b[1;36m";
}

}  // namespace

Console::Console() {
    const char* noColor = std::getenv("NO_COLOR");
    terminal_ = isatty(STDERR_FILENO) != 0;
    color_ = terminal_ && (noColor == nullptr || *noColor == '\0');
}

void Console::print(std::string_view text) const {
    progress("");
    write(stdout, text);
}

void Console::report(const Diagnostic& diagnostic) const {
    progress("");
    std::string text = toString(diagnostic);
    if (color_) {
        // The severity stands right after the place, up to the first colon.
        const std::size_t begin = diagnostic.where.empty() ? 0 : diagnostic.where.size() + 2;
        const std::size_t end = text.find(':', begin);
        text.insert(end, kReset);
        text.insert(begin, colorOf(diagnostic.severity));
    }
    write(stderr, text + "\n");
}

void Console::report(std::span<const Diagnostic> diagnostics) const {
    for (const Diagnostic& diagnostic : diagnostics) {
        report(diagnostic);
    }
}

void Console::progress(std::string_view text) const {
    if (terminal_) {
        write(stderr, kClearLine);
        write(stderr, text);
        std::fflush(stderr);
    }
}

Status Console::flush() const {
    progress("");
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        return makeError("output", "stdout", "can't be written", "check the free space and the reader");
    }
    return okStatus();
}

}  // namespace glint
