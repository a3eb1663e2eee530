// Calls fetchHit() for given hits of a scene.
#pragma once

#include "gltf/scene.h"

#include <cstdint>
#include <vector>

namespace glint::testing {

// The values that the kernel hit_values.comp writes for each hit: 26 words.
struct Values {
    gltf::Float3 position;
    gltf::Float3 geometricNormal;
    gltf::Float3 normal;
    gltf::Float2 texCoord;
    float frontFace;
    gltf::Float3 color;
    gltf::Float3 tangent;
    float tangentSign;
    float clearance;
    gltf::Float2 gradientAcross;  // (du, dv) by each axis of the footprint, of a texture of 1024 x 512 texels
    gltf::Float2 gradientAlong;
    std::uint32_t freeAbove;
    std::uint32_t freeBelow;
};
struct Query {
    std::uint32_t geometry = 0;
    std::uint32_t triangle = 0;
    gltf::Float2 barycentrics{};
    gltf::Float3 direction{0.0F, 0.0F, -1.0F};
    float coneWidth = 0.0F;
    float anisotropy = 1.0F;
};

// Returns values in the order of the queries. If the scene could not be loaded, the test fails and the result
// is empty.
std::vector<Values> ask(const gltf::Scene& scene, const std::vector<Query>& queries);

}  // namespace glint::testing
