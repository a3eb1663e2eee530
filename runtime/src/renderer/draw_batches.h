// Batches of the raster pass: one call draws many instances of a primitive.
#pragma once

#include "scene/geometry.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// Instance i of the batch shows the GeometryRecord geometry + i * stride.
struct DrawBatch {
    std::uint32_t geometry = 0;
    std::uint32_t stride = 0;
    std::uint32_t count = 0;
    std::uint32_t vertexCount = 0;
    bool doubleSided = false;
    bool mirrored = false;
};

// Joins draws into batches whose instances and geometry records follow each other and have the same
// primitives. Batches are in the order of their first draws. Hidden draws are left out. `draws` are those of
// SceneLayout, instance by instance. Pure; O(draws).
std::vector<DrawBatch> batchDraws(std::span<const Draw> draws);

}  // namespace glint
