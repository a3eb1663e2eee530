// Runs a compute shader of the caller's own over a scene that is on the device. It is for tools and tests
// that evaluate the shading code itself.
#pragma once

#include <glint/result.h>
#include <glint/scene.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace glint {

class SceneKernel {
public:
    // `words` is the SPIR-V of a compute shader with workgroups of kRayGroupSize threads in x. It may use
    // descriptor set 0 and the push constants of Glint's passes, and finds the scene through FrameConstants.
    // `scene` must outlive the kernel. Error "vulkan-call".
    static Result<std::unique_ptr<SceneKernel>> create(GpuScene& scene, std::span<const std::uint32_t> words);
    ~SceneKernel();
    SceneKernel(const SceneKernel&) = delete;
    SceneKernel& operator=(const SceneKernel&) = delete;

    // Runs FrameConstants::width = `invocations` threads, in one dimension: at most 65535 workgroups. The
    // shader reads `input` from FrameConstants::orderedHits and writes words to FrameConstants::counters.
    // Returns the first `outputs` of these; those that it did not write are 0. Waits for the device. Errors:
    // those of buffers and submissions.
    Result<std::vector<std::uint32_t>> run(std::span<const std::uint32_t> input, std::uint32_t invocations,
                                           std::size_t outputs);

    struct State;
    State& state();

private:
    explicit SceneKernel(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace glint
