// The programs glint and, with the window linked in, glint-view.
#include "cli/command_line.h"
#ifdef GLINT_WINDOW
#include "view/request.h"
#endif

int main(int argc, char** argv) {
#ifdef GLINT_WINDOW
    return glint::cli::runCommandLine(argc, argv, {.showWindow = glint::view::showWindow});
#else
    return glint::cli::runCommandLine(argc, argv);
#endif
}
