// Calls fetchHit() for given hits of a scene.
#pragma once

#include "gltf/scene.h"

#include <cstdint>
#include <vector>

namespace glint::testing {

// The values that the kernel hit_values.comp writes for each hit: 26 words.
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

// Returns values in the order of the queries. If the scene could not be loaded, the test fails and the result
// is empty.
std::vector<Values> ask(const Scene& scene, const std::vector<Query>& queries);

}  // namespace glint::testing
