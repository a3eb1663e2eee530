// The part of a Context that the runtime's own sources see: the device, its limits, and what Glint requires
// of it.
#pragma once

#include "context/parallel.h"
#include "context/vulkan_table.h"

#include <glint/context.h>
#include <glint/internal/package_format.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <vulkan/vulkan_core.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace glint {

// The device and driver that a cache belongs to.
struct PipelineCacheOwner {
    std::uint32_t vendorId = 0;
    std::uint32_t deviceId = 0;
    std::uint32_t driverId = 0;
    std::uint32_t driverVersion = 0;
    std::array<std::uint8_t, VK_UUID_SIZE> cacheUuid{};

    friend bool operator==(const PipelineCacheOwner&, const PipelineCacheOwner&) = default;
};

// Returns the owner in hexadecimal digits and hyphens.
std::string nameOf(const PipelineCacheOwner& owner);

// `data` must come from vkGetPipelineCacheData.
std::vector<std::uint8_t> wrapPipelineCache(const PipelineCacheOwner& owner,
                                            std::span<const std::uint8_t> data);

// Returns the data inside a result of wrapPipelineCache(). Error "pipeline-cache": it is damaged or has
// another owner.
Result<std::span<const std::uint8_t>> unwrapPipelineCache(const PipelineCacheOwner& owner,
                                                          std::span<const std::uint8_t> wrapped);

// Makes a cache with the data of an earlier one, which may be empty. The caller destroys it. Error
// "vulkan-call".
Result<VkPipelineCache> createPipelineCache(const Context::State& state, std::span<const std::uint8_t> data);

// --- The part of a Context that the runtime's own sources see ---

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
    explicit State(HostServices given = {}) : services(std::move(given)), jobs(services) {}
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
    HostServices services;
    // All pipelines are made with this cache. Threads may still use those that addPipelineCache() has
    // replaced, so they live as long as the context.
    std::atomic<VkPipelineCache> pipelineCache{VK_NULL_HANDLE};
    std::mutex cacheMutex;
    std::vector<VkPipelineCache> replacedCaches;
    std::mutex queueMutex;  // without HostServices::lockQueue
    Jobs jobs;              // the last, so that its threads end first
};

// Locks the queue as long as it lives.
class QueueLock {
public:
    explicit QueueLock(Context::State& context);
    ~QueueLock();
    QueueLock(const QueueLock&) = delete;
    QueueLock& operator=(const QueueLock&) = delete;

private:
    Context::State& context_;
};

// Fills the fields that follow from the handles: device functions, limits, pipeline cache.
Status finishContext(Context::State& state);

// Returns the stages of the passes that are not raster passes: compute, and the stages of ray tracing
// pipelines if the device has them.
VkShaderStageFlags passStages(const Context::State& state);

// --- Pure functions that compare the report of a device with Glint's requirements ---

// A device that supports the extension supports its feature too (Vulkan 1.3 specification, "Feature
// Requirements").
inline constexpr const char* kPositionFetchExtension = "VK_KHR_ray_tracing_position_fetch";

// The report of a physical device: features in a DeviceRequirements chain, limits and extensions.
struct DeviceReport {
    std::uint32_t apiVersion = 0;
    std::vector<std::string> extensions;
    DeviceRequirements features{package::kAllTracers};
    VkShaderStageFlags subgroupStages = 0;
    VkSubgroupFeatureFlags subgroupOperations = 0;
    std::uint32_t maxPushConstantBytes = 0;
    std::uint32_t maxWorkgroupThreads = 0;
    bool hasQueue = false;  // it has a queue family with graphics and compute
};

// Returns the names of the requirements that `report` lacks, the API version first. The list is empty if
// Glint runs on such a device.
std::vector<std::string> missingFrom(const DeviceReport& report);

// Clears the features that only some modules need and that the device lacks.
void leaveOutLacking(const DeviceReport& report, DeviceRequirements& requirements);

// Returns the features and subgroup operations that modules may use on a device, by the names of
// package::featuresOf(). Those of DeviceRequirements that the physical device has count as enabled.
std::vector<std::string> moduleFeatures(const DeviceReport& report, const DeviceHandles& handles);

// Returns the package::Tracer bits whose extensions and features `report` has in full.
std::uint32_t tracersOf(const DeviceReport& report);

bool hasExtension(const DeviceReport& report, const char* name);

// Compares what the handles say is enabled with the device. Error "device-features".
Status checkClaims(const DeviceHandles& handles, const DeviceReport& report);

// Returns the queue families of a device. Glint works on those that are suitable: with graphics and compute.
std::vector<VkQueueFamilyProperties> queueFamilies(const InstanceTable& table, VkPhysicalDevice device);
bool isSuitable(const VkQueueFamilyProperties& family);

// Fills `report` by asking `device`. Error "vulkan-call".
Status queryDevice(const InstanceTable& table, VkPhysicalDevice device, DeviceReport& report);

// Joins the parts of a message: texts and whole numbers.
template <typename... Parts>
std::string phrase(const Parts&... parts) {
    std::string text;
    const auto add = [&](const auto& part) {
        if constexpr (std::is_integral_v<std::remove_cvref_t<decltype(part)>>) {
            text += std::to_string(part);
        } else {
            text += part;
        }
    };
    (add(parts), ...);
    return text;
}

// Returns a list such as "a, b and c".
std::string joinNames(const std::vector<std::string>& names);

// --- Texel formats in Vulkan's terms ---

// Returns VK_FORMAT_UNDEFINED if there is none: single channels, and 16 bits, are never in sRGB.
VkFormat vulkanFormat(TexelFormat format, bool srgb);

VkComponentMapping vulkanComponents(const TexelChannels& channels);

// Returns the formats besides Rgba16 that the device can sample, filter and copy to.
TexelFormats queryTexelFormats(const InstanceTable& instance, VkPhysicalDevice device);

}  // namespace glint
