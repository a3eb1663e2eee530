// Decides alpha tests of triangles before tracing, so that rays need not run them.
#pragma once

#include "data/alpha_states.h"
#include "data/geometry.h"

#include <glint/package.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace glint {

// The decisions about the triangles of a scene.
struct DecidedTriangles {
    // By index into SceneView::primitives: the primitive's indices, tested triangles first, then opaque ones,
    // then those that let all rays through. A primitive that is unchanged has none.
    std::vector<std::vector<std::uint32_t>> sorted;
    std::map<std::uint32_t, OpacitySplit> splits;
    // The micromaps of the tested triangles of primitives with a split, in the order of these triangles.
    // Empty unless micromaps were requested.
    std::map<std::uint32_t, opacity::MicromapArray> micromaps;
    std::uint64_t tested = 0;       // triangles of materials that are tested, once for each mesh
    std::uint64_t opaque = 0;       // of those: proved opaque
    std::uint64_t transparent = 0;  // of those: proved transparent
};

// Proves states of the triangles of masked primitives, on all threads of the machine. `materials` are the
// records that the scene will have. A primitive stays as it is if its state may change or can't be known:
// its package tests no alpha by Glint's own code; its key has code of packs that changes UVs or opacity; it
// is blended, passes light or is a light; its material may be changed by updates of a scene that moves; its
// texture is streamed, or is in a block format without decoded texels; or it fills more than one BLAS.
// Micromaps have up to `level` levels; 0: none are made.
DecidedTriangles decideTriangles(const Package& package, const PackageScene& known, const SceneView& scene,
                                 std::span<const std::uint8_t> materials, const BlasCapacity& capacity,
                                 std::uint32_t level);

// Returns everything that an alpha test of a primitive reads besides vertices and texels, as bytes to
// compare.
std::vector<std::uint8_t> alphaInputs(const package::OpacityEntry& opacity, const MaterialTable& materials,
                                      const package::PrimitiveEntry& entry);

}  // namespace glint
