// Draws of the raster pass that one call makes: many instances of a primitive.
#pragma once

#include "geometry.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// Instance i shows the GeometryRecord geometry + i * stride.
struct DrawBatch {
    std::uint32_t geometry = 0;
    std::uint32_t stride = 0;
    std::uint32_t count = 0;
    std::uint32_t vertexCount = 0;
    bool doubleSided = false;
    bool mirrored = false;
};

// Batches of draws whose instances follow each other with the same primitives, in the order of their first
// draws; hidden draws are in none. `draws` are those of SceneLayout: instance by instance. Pure; O(draws).
std::vector<DrawBatch> batchDraws(std::span<const Draw> draws);

}  // namespace glint
