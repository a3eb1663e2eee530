// A program that links only the runtime, like a shipped game.
#include <glint/context.h>
#include <glint/package.h>
#include <glint/renderer.h>

#include <cstdio>

int main() {
    const glint::Result<glint::Package> package = glint::Package::load("there is no such folder");
    if (package.ok() || package.error().id != "package-missing") {
        return 1;
    }
    auto context = glint::Context::createHeadless();
    if (!context) {
        std::printf("%s\n", glint::toString(context.error()).c_str());
        return 0;
    }
    std::printf("%s\n", (*context)->deviceName().c_str());
    // Refers to the rest of the library in a way that no optimiser can remove, so that all of it is linked.
    auto* volatile create = &glint::Renderer::create;
    auto* volatile upload = &glint::GpuScene::upload;
    return create == nullptr || upload == nullptr ? 1 : 0;
}
