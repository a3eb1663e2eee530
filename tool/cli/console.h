// Where the command writes: results to stdout, diagnostics and progress to stderr.
#pragma once

#include <glint/result.h>

#include <span>
#include <string_view>

namespace glint {

class Console {
public:
    // Colour and progress only where stderr is a terminal, colour only where NO_COLOR is unset or empty.
    Console();

    // A result; `text` ends with a line break where one is wanted.
    void print(std::string_view text) const;
    void report(const Diagnostic& diagnostic) const;
    void report(std::span<const Diagnostic> diagnostics) const;
    // One line that the next message replaces; silent unless stderr is a terminal. Empty text clears it.
    void progress(std::string_view text) const;
    // Writes what is buffered. Error "output" where stdout can't take it, for instance on a full disk.
    Status flush() const;

private:
    bool terminal_ = false;
    bool color_ = false;
};

}  // namespace glint
