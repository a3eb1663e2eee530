// glint view, with a script of input in place of a person: glint-view-script FILE view SCENE ...
#include "cli/command_line.h"
#include "view/request.h"
#include "view/script.h"

#include <cstdio>
#include <string>

namespace {

std::string scriptFile;

glint::Status showScripted(const glint::view::Request& request) {
    glint::view::Request driven = request;
    driven.drive = [](const glint::view::WindowAccess& access) {
        return glint::testing::readScript(scriptFile, access);
    };
    return glint::view::showWindow(driven);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fputs("usage: glint-view-script FILE view SCENE ...\n", stderr);
        return 2;
    }
    scriptFile = argv[1];
    return glint::cli::runCommandLine(argc - 1, argv + 1, {.showWindow = showScripted});
}
