// A program that reads glTF, and links neither the compiler nor the runtime.
#include "gltf/import.h"

#include <iostream>

int main(int argc, char** argv) {
    const glint::Result<glint::gltf::Scene> scene = glint::gltf::importScene(argc > 1 ? argv[1] : "", {});
    if (!scene) {
        std::cerr << glint::toString(scene.error()) << '\n';
        return 1;
    }
    std::cout << scene->meshes.size() << " meshes, " << scene->materials.size() << " materials\n";
    return 0;
}
