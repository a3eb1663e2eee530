// A frame with everything that tests need to know about its rays.
#pragma once

#include "interop/frame.h"
#include "render/harness.h"

#include <vector>

namespace glint::testing {

struct TracedFrame {
    LinearImage image;
    Renderer::Counters counters;             // of the last sample, as all that follows
    std::vector<Renderer::PixelPath> paths;  // of each pixel
    std::vector<gpu::RayRecord> rays;        // the list, as readRays() has it
};

// Reads the list of the last recording and the samples that it names. Their origins are known in packages
// with paths of several bounces, if the frame has one; in others light has taken their place.
Result<std::vector<gpu::RayRecord>> readRays(Renderer& renderer, std::uint32_t count);

// Renders with the validation layers on and reads back. If that fails, the test fails and the image has no
// size. Expects for every frame that each pixel has one path, and that paths and counters agree.
TracedFrame traceFrame(const LoadedScene& scene, package::Strategy strategy, const RenderSetup& setup);

// Returns a sphere with `rows` rows and twice as many columns of quads, with smooth normals, seen from
// outside.
gltf::Primitive makeSphere(int material, gltf::Float3 centre, float radius, int rows);

}  // namespace glint::testing
