// Runs the benchmark's compute shader on the device. The shader only traces.
#pragma once

#include "context/commands.h"
#include "context/resources.h"
#include "oracle/traversal/rays.h"
#include "scene/gpu_scene_state.h"

#include <cstdint>
#include <memory>
#include <span>

namespace glint::traversal {

class TraceKernel {
public:
    // Makes a kernel for scenes of this context, which must outlive it, and for up to `rays` rays at a time.
    // `layout` may be that of any scene, because all have the same.
    static Result<std::unique_ptr<TraceKernel>> create(Context& context, VkDescriptorSetLayout layout,
                                                       std::size_t rays);

    // Returns device milliseconds. distances() then has the distance of each ray's nearest hit, from either
    // side of a triangle; it is negative if there is none.
    Result<double> trace(GpuScene& scene, std::span<const Ray> rays);
    std::span<const float> distances() const;

private:
    TraceKernel(Context::State& context, CommandRunner runner, Timer timer)
        : context_(context), pool_(context), runner_(std::move(runner)), timer_(std::move(timer)) {}

    Status createPipeline(VkDescriptorSetLayout layout);

    Context::State& context_;
    MemoryPool pool_;
    CommandRunner runner_;
    Timer timer_;
    Buffer rays_;
    Buffer distances_;
    UniquePipelineLayout layout_;
    UniquePipeline pipeline_;
    std::size_t count_ = 0;
};

}  // namespace glint::traversal
