// The part of a Context that the runtime's own sources see.
#pragma once

#include "context/vulkan_table.h"
#include "renderer/pipeline_cache.h"

#include <glint/context.h>
#include <glint/package_format.h>
#include <glint/texel_format.h>

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Collects the messages of the validation layer. The driver may report from several threads.
class ValidationLog {
public:
    void add(std::string message);
    std::vector<std::string> messages() const;

private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

// The limits that uploads and renderers check against.
struct DeviceLimits {
    VkPhysicalDeviceLimits core{};
    VkPhysicalDeviceMemoryProperties memory{};
    VkDeviceSize maxAllocationBytes = 0;
    VkDeviceSize maxBufferBytes = 0;
    VkPhysicalDeviceAccelerationStructurePropertiesKHR accelerationStructure{};
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR rayPipeline{};   // zeros where it is not enabled
    VkPhysicalDeviceOpacityMicromapPropertiesEXT opacityMicromap{};  // zeros where it is not enabled
    std::uint32_t maxTextures = 0;  // sampled images that one stage can see, updated after bind
    std::uint32_t maxSamplers = 0;
    float samplerAnisotropy = 1.0F;        // anisotropy of texture samplers; 1: none
    bool wideTextures = false;             // R16G16B16A16_UNORM can be sampled, filtered and blitted
    TexelFormats texelFormats;             // see Context::texelFormats()
    bool filteredFloats = false;           // R32G32B32A32_SFLOAT can be filtered
    std::uint32_t timestampValidBits = 0;  // valid bits of the queue family's timestamps; 0: it has none
    std::uint32_t subgroupSize = 0;        // lanes
    VkSubgroupFeatureFlags subgroupOperations = 0;
    std::uint32_t multiprocessors = 0;  // 0: the device does not say
    VkPhysicalDeviceType deviceType = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    std::string deviceName;
    std::string driverName;
    PipelineCacheOwner cacheOwner;
};

struct LeafBox;
// The function that orders leaves: halvingOrder(), or a replacement in a benchmark.
using LeafOrder = std::vector<std::uint32_t> (*)(std::span<const LeafBox> leaves, std::uint32_t threads);

struct Context::State {
    State() = default;
    ~State();
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    // Null if the caller gave its own vkGetInstanceProcAddr. It is declared first, so that it is closed last.
    std::shared_ptr<VulkanLibrary> library;
    InstanceTable instance;
    DeviceTable vk;
    DeviceHandles handles;
    bool ownsInstance = false;
    bool ownsDevice = false;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    ValidationLog log;
    DeviceLimits limits;
    LeafOrder leafOrder = nullptr;  // null: halvingOrder()
    // The features of the device that modules may use: moduleFeatures().
    std::vector<std::string> features;
    // The renderers of this context share this cache.
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;
};

// Fills the fields that follow from the handles: device functions, limits, pipeline cache.
Status finishContext(Context::State& state);

// Returns the stages of the passes that are not raster passes: compute, and the stages of ray tracing
// pipelines if the device has them.
VkShaderStageFlags passStages(const Context::State& state);

}  // namespace glint
