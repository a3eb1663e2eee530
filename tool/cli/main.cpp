#include "cli/command_line.h"

#include <cstdio>
#include <exception>
#include <new>

int main(int argc, char** argv) {
    try {
        return glint::cli::runCommandLine(argc, argv);
    } catch (const std::bad_alloc&) {
        std::fputs(
            "error: the work does not fit into memory; use smaller inputs, or a machine with more"
            " [out-of-memory]\n",
            stderr);
        return glint::cli::kExitFailed;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "glint: error: %s\n", error.what());
        return glint::cli::kExitFailed;
    }
}
