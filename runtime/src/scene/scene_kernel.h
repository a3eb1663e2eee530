// The part of a SceneKernel that tests see: a run with frame constants of their own.
#pragma once

#include "context/resources.h"
#include "interop/frame.h"

#include <glint/internal/scene_kernel.h>

namespace glint {

struct SceneKernel::State {
    GpuScene::State& scene;
    UniquePipelineLayout layout;
    UniquePipeline pipeline;
};

// As SceneKernel::run(). The addresses of the scene, the number of threads, the input (also as `rays`) and
// the output of `constants` are set here.
Result<std::vector<std::uint32_t>> runSceneKernel(SceneKernel::State& kernel, gpu::FrameConstants constants,
                                                  std::span<const std::uint8_t> input,
                                                  std::uint32_t invocations, std::size_t outputs);

}  // namespace glint
