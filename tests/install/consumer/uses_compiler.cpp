// A program that compiles materials itself: a scene of one triangle becomes a package in memory.
#include "emit/compile.h"

#include <iostream>

int main() {
    glint::gltf::Scene scene;
    scene.materials.emplace_back();
    glint::gltf::Primitive triangle;
    triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.indices = {0, 1, 2};
    scene.meshes.push_back({"triangle", {triangle}});
    const glint::Result<glint::compiler::CompiledPackage> package =
        glint::compiler::compilePackage(scene, {});
    if (!package) {
        std::cerr << glint::toString(package.error()) << '\n';
        return 1;
    }
    return package->plan.cases.size() == 1 ? 0 : 1;
}
