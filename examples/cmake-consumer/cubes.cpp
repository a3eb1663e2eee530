#include "cubes.h"

#include <cstddef>

namespace {

// The rows of a matrix that first scales and then moves.
glint::InstanceView place(std::uint32_t mesh, const std::array<float, 3>& at,
                          const std::array<float, 3>& scale) {
    return {mesh, {scale[0], 0, 0, at[0], 0, scale[1], 0, at[1], 0, 0, scale[2], at[2]}};
}

}  // namespace

Cubes::Cubes() {
    // Builds a unit cube, face by face: the normal n, then u and v so that u × v = n.
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const float sign : {1.0F, -1.0F}) {
            const auto first = static_cast<std::uint32_t>(positions_.size());
            for (const auto& [s, t] :
                 {std::array{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}}) {
                std::array<float, 3> position{};
                position[axis] = 0.5F * sign;
                position[(axis + 1) % 3] = 0.5F * sign * s;
                position[(axis + 2) % 3] = 0.5F * t;
                std::array<float, 3> normal{};
                normal[axis] = sign;
                positions_.push_back(position);
                normals_.push_back(normal);
                texCoords_.push_back({(s + 1.0F) / 2.0F, (1.0F - t) / 2.0F});
            }
            for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) {
                indices_.push_back(first + corner);
            }
        }
    }
    // Four meshes have the same geometry, and each has its own material.
    for (std::uint32_t mesh = 0; mesh < kMeshCount; ++mesh) {
        glint::PrimitiveView primitive;
        primitive.mesh = mesh;
        primitive.positions = positions_;
        primitive.normals = normals_;
        primitive.texCoords0 = texCoords_;
        primitive.indices = indices_;
        primitives_.push_back(primitive);
    }
    instances_ = {place(0, {0.0F, -0.05F, 0.0F}, {6.0F, 0.1F, 6.0F}),
                  place(1, {-1.4F, 0.5F, 0.0F}, {1, 1, 1}), place(2, {0.0F, 0.5F, -0.6F}, {1, 1, 1}),
                  place(3, {1.4F, 0.5F, 0.0F}, {1, 1, 1})};

    for (std::uint32_t i = 0; i < kTilesAcross * kTilesAcross; ++i) {
        const bool light = (i % kTilesAcross + i / kTilesAcross) % 2 == 0;
        const std::array<std::uint8_t, 4> color = light ? std::array<std::uint8_t, 4>{212, 205, 190, 255}
                                                        : std::array<std::uint8_t, 4>{58, 74, 92, 255};
        tiles_.insert(tiles_.end(), color.begin(), color.end());
    }
    images_.push_back({kTilesAcross, kTilesAcross, tiles_});
    glint::LightView sun;
    sun.intensity = {3.0F, 2.85F, 2.6F};
    sun.direction = {0.371F, -0.743F, -0.557F};
    lights_.push_back(sun);
}

glint::SceneView Cubes::view() const {
    return {primitives_, instances_, images_, lights_};
}
