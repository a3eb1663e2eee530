// glint-view: the window of `glint view`. It takes the same command line as glint.
#include "cli/command_line.h"
#include "view/request.h"

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
    try {
        return glint::cli::runCommandLine(argc, argv, {.showWindow = glint::view::showWindow});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "glint: error: %s\n", error.what());
        return glint::cli::kExitFailed;
    }
}
