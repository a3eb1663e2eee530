// What the runtime's own sources see of a Context.
#pragma once

#include "pipeline_cache.h"
#include "vulkan_table.h"

#include <glint/context.h>
#include <glint/package_format.h>

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Messages of the validation layer; the driver may report from several threads.
class ValidationLog {
public:
    void add(std::string message);
    std::vector<std::string> messages() const;

private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

// Limits that uploads and renderers check against.
struct DeviceLimits {
    VkPhysicalDeviceLimits core{};
    VkPhysicalDeviceMemoryProperties memory{};
    VkDeviceSize maxAllocationBytes = 0;
    VkDeviceSize maxBufferBytes = 0;
    VkPhysicalDeviceAccelerationStructurePropertiesKHR accelerationStructure{};
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR rayPipeline{};  // zeros where it is not enabled
    std::uint32_t maxTextures = 0;  // sampled images that one stage can see, updated after bind
    std::uint32_t maxSamplers = 0;
    float samplerAnisotropy = 1.0F;        // that texture samplers are made with; 1: none
    bool wideTextures = false;             // R16G16B16A16_UNORM can be sampled, filtered and blitted
    bool filteredFloats = false;           // R32G32B32A32_SFLOAT can be filtered
    std::uint32_t timestampValidBits = 0;  // of the queue family; 0: no timestamps
    std::uint32_t subgroupSize = 0;        // lanes
    VkSubgroupFeatureFlags subgroupOperations = 0;
    std::uint32_t multiprocessors = 0;  // 0: the device does not say
    VkPhysicalDeviceType deviceType = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    std::string deviceName;
    std::string driverName;
    PipelineCacheOwner cacheOwner;
};

struct LeafBox;
// halvingOrder(), or what a benchmark has in its place.
using LeafOrder = std::vector<std::uint32_t> (*)(std::span<const LeafBox> leaves, std::uint32_t threads);

struct Context::State {
    State() = default;
    ~State();
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    // Null where the caller gave its own vkGetInstanceProcAddr. Declared first: closed last.
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
    // Shared by the renderers of this context.
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;
};

// Fills what follows from the handles: device functions, limits, pipeline cache.
Status finishContext(Context::State& state);

// Stages of the passes that are not raster passes: compute, and those of ray tracing pipelines where the
// device has them.
VkShaderStageFlags passStages(const Context::State& state);

}  // namespace glint
