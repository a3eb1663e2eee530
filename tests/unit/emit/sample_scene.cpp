#include "unit/emit/sample_scene.h"

#include "support/must.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

namespace glint::testing {

namespace {

gltf::Primitive makeTriangle(int index) {
    gltf::Primitive primitive;
    primitive.pointer = "/meshes/0/primitives/" + std::to_string(index);
    primitive.material = index;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    primitive.normals.assign(3, {0, 0, 1});
    primitive.texCoords0 = {{0, 0}, {1, 0}, {0, 1}};
    primitive.indices = {0, 1, 2};
    return primitive;
}

}  // namespace

gltf::Scene makeSampleScene() {
    gltf::Scene scene;
    scene.path = "models/sample scene.gltf";
    scene.images.resize(2);
    scene.samplers.resize(2);
    scene.samplers[1].wrapU = gltf::Wrap::MirroredRepeat;
    scene.samplers[1].mipmapped = false;
    scene.textures = {{0, 0}, {1, 1}};
    scene.files = {{"models/sample scene.gltf", 100, 1}, {"models/data/sample.bin", 200, 2}};

    scene.materials.resize(4);
    scene.materials[0].name = "plain */ \\";
    scene.materials[1].name = "textured\n\"red\"";
    scene.materials[1].texture("baseColorTexture").texture = 0;
    scene.materials[1].doubleSided = true;
    scene.materials[2].name = "transformed";
    scene.materials[2].texture("baseColorTexture").texture = 1;
    scene.materials[2].texture("occlusionTexture").texture = 1;
    scene.materials[2].texture("occlusionTexture").transform = {{0.25F, 0.5F}, 1.5707964F, {2, 3}};
    scene.materials[3].name = "";
    scene.materials[3].give("KHR_materials_unlit");
    scene.materials[3].alphaMode = materials::AlphaMode::Mask;
    scene.materials[3].texture("baseColorTexture").texture = 0;

    gltf::Mesh mesh;
    for (int i = 0; i < 4; ++i) {
        mesh.primitives.push_back(makeTriangle(i));
    }
    scene.meshes.push_back(std::move(mesh));
    return scene;
}

compiler::CompiledPackage compileSample(const compiler::CompileSettings& settings) {
    return must(compilePackage(makeSampleScene(), settings, &sharedModules()));
}

const compiler::PackageFile* findFile(const compiler::CompiledPackage& package, std::string_view name) {
    const auto place = std::ranges::find(package.files, name, &compiler::PackageFile::name);
    return place == package.files.end() ? nullptr : &*place;
}

std::string_view textOf(const compiler::PackageFile* file) {
    if (file == nullptr) {
        return {};
    }
    return {reinterpret_cast<const char*>(file->bytes.data()), file->bytes.size()};
}

}  // namespace glint::testing
