// The scene as an engine has it: meshes, instances and textures in its own memory. The materials are those of
// scene/cubes.gltf; meshes and images have the same numbers as there.
#pragma once

#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <vector>

class Cubes {
public:
    Cubes();

    // The view is valid as long as the object.
    glint::SceneView view() const;

private:
    static constexpr std::uint32_t kMeshCount = 4;
    static constexpr std::uint32_t kTilesAcross = 8;

    std::vector<std::array<float, 3>> positions_;
    std::vector<std::array<float, 3>> normals_;
    std::vector<std::array<float, 2>> texCoords_;
    std::vector<std::uint32_t> indices_;
    std::vector<std::uint8_t> tiles_;
    std::vector<glint::PrimitiveView> primitives_;
    std::vector<glint::InstanceView> instances_;
    std::vector<glint::ImageView> images_;
    std::vector<glint::LightView> lights_;
};
