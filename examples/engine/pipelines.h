// The engine's own pipelines.
#pragma once

#include "gpu.h"

#include <glint/package_shape.h>

#include <string>

namespace engine {

// `shader` is the path of a compute shader's SPIR-V.
VkPipeline computePipeline(Gpu& gpu, VkPipelineLayout layout, const std::string& shader);

// Pulls vertices and stores what each pixel sees in one attachment of two integers, with reversed depth.
// `shaders` is the folder with the engine's SPIR-V.
VkPipeline gbufferPipeline(Gpu& gpu, VkPipelineLayout layout, const std::string& shaders, VkExtent2D extent,
                           VkFormat seen, VkFormat depth);

// The pass that lights what the camera sees. It traces shadow rays in a compute shader by ray queries, or in
// a ray tracing pipeline.
class PrimaryPass {
public:
    PrimaryPass(Gpu& gpu, VkPipelineLayout layout, const std::string& shaders, glint::package::Tracer tracer);

    // Covers an image. Descriptor sets and push constants are bound already.
    void record(VkCommandBuffer commands, VkExtent2D extent) const;

private:
    void makeRayPipeline(Gpu& gpu, VkPipelineLayout layout, const std::string& shaders);

    VkPipeline pipeline_ = VK_NULL_HANDLE;
    // The regions of the shader binding table, and the call that uses it; null with ray queries.
    VkStridedDeviceAddressRegionKHR generation_{}, miss_{}, hit_{};
    PFN_vkCmdTraceRaysKHR traceRays_ = nullptr;
};

}  // namespace engine
