// A program with the runtime alone: loading what is not there is an error value that says so.
#include <glint/package.h>
#include <glint/renderer.h>

#include <iostream>

int main(int argc, char** argv) {
    const glint::Result<glint::Package> package = glint::Package::load(argc > 1 ? argv[1] : "");
    if (package || package.error().message.empty()) {
        return 1;
    }
    std::cout << glint::toString(package.error()) << '\n';
    return 0;
}
