// What fetchHit() makes of given hits of a scene.
#pragma once

#include "gltf/scene.h"

#include <cstdint>
#include <vector>

namespace glint::testing {

// What the kernel hit_values.comp writes for each hit: 26 words.
struct Values {
    Float3 position;
    Float3 geometricNormal;
    Float3 normal;
    Float2 texCoord;
    float frontFace;
    Float3 color;
    Float3 tangent;
    float tangentSign;
    float clearance;
    Float2 gradientAcross;  // (du, dv) by each axis of the footprint, of a texture of 1024 x 512 texels
    Float2 gradientAlong;
    std::uint32_t freeAbove;
    std::uint32_t freeBelow;
};
struct Query {
    std::uint32_t geometry = 0;
    std::uint32_t triangle = 0;
    Float2 barycentrics{};
    Float3 direction{0.0F, 0.0F, -1.0F};
    float coneWidth = 0.0F;
    float anisotropy = 1.0F;
};

// In the order of the queries; empty where the scene could not be loaded, and the test has failed then.
std::vector<Values> ask(const Scene& scene, const std::vector<Query>& queries);

}  // namespace glint::testing
