// Runs a compute shader of the tests over a loaded scene. It may include what the product's passes include.
#pragma once

#include "interop/frame.h"
#include "render/harness.h"
#include "scene/scene_kernel.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glint::testing {

class HitKernel {
public:
    // `shader` is a file of tests/render/shaders. It finds the scene through FrameConstants, runs `width`
    // invocations in workgroups of kRayGroupSize, reads its input from `rays` and `lights`, and writes words
    // to `counters`. `settings` decide what it is compiled with. Errors: those of compileShader,
    // "vulkan-call". `scene` must outlive the kernel.
    static Result<std::unique_ptr<HitKernel>> create(const gltf::Scene& scene, const LoadedScene& loaded,
                                                     const std::string& shader,
                                                     const compiler::CompileSettings& settings = {});

    // The same for a compiled shader.
    static Result<std::unique_ptr<HitKernel>> create(const LoadedScene& loaded,
                                                     const std::vector<std::uint32_t>& words);

    // Returns the first `outputs` words; words that the shader did not write are 0. `constants` may hold
    // further inputs.
    Result<std::vector<std::uint32_t>> run(const gpu::FrameConstants& constants,
                                           std::span<const gpu::RayRecord> rays, std::uint32_t invocations,
                                           std::size_t outputs);

private:
    explicit HitKernel(std::unique_ptr<SceneKernel> kernel);

    std::unique_ptr<SceneKernel> kernel_;
};

}  // namespace glint::testing
