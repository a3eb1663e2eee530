#include "cli/command_line.h"

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
    try {
        return glint::runCommandLine(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "glint: error: %s\n", error.what());
        return glint::kExitFailed;
    }
}
