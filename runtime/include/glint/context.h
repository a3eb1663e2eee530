// The Vulkan device that Glint works on: the caller's, or a headless one of its own.
#pragma once

#include <glint/package_format.h>
#include <glint/result.h>

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Handles that the caller owns and keeps alive as long as the Context.
struct DeviceHandles {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;  // graphics, compute and transfer
    std::uint32_t queueFamily = 0;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;  // null: the system's loader
    bool debugUtils = false;  // VK_EXT_debug_utils is enabled on the instance: passes are labelled
    // VkPhysicalDeviceFeatures::samplerAnisotropy is enabled on the device. Glint runs without it, with
    // textures that are blurrier at grazing angles.
    bool samplerAnisotropy = false;
    // VK_KHR_ray_tracing_position_fetch is enabled on the device: packages run that need it.
    bool positionFetch = false;
    // VkPhysicalDeviceVulkan12Features::shaderFloat16 is enabled on the device: packages run that need it.
    bool shaderFloat16 = false;
    // VK_KHR_pipeline_executable_properties with its feature is enabled on the device: Renderers can tell
    // what the driver says of their pipelines.
    bool pipelineStatistics = false;
    // package::Tracer bits whose extensions and features are enabled on the device: those that its
    // DeviceRequirements were made with.
    std::uint32_t tracers = package::kTracerRayQuery;
};

enum class Validation { Off, On, Synchronization };

struct HeadlessOptions {
    // Anything but Off requires the Khronos validation layer and collects its messages.
    Validation validation = Validation::Off;
    std::string deviceName;  // part of the wanted device's name; empty: the first that has all features
    // package::Tracer bits to enable where the device has them; it has at least one of them.
    std::uint32_t tracers = package::kAllTracers;
    // VK_KHR_ray_tracing_position_fetch, for packages that need it. Error "device-features" where it is
    // missing.
    bool positionFetch = false;
    // 16-bit float arithmetic, for packages that need it. Error "device-features" where it is missing.
    bool shaderFloat16 = false;
    // VK_KHR_pipeline_executable_properties, where the device has it: DeviceHandles::pipelineStatistics.
    bool pipelineStatistics = false;
};

// package::Tracer bits that a device can be created with; 0: Glint does not run on it.
std::uint32_t deviceTracers(VkPhysicalDevice device);

// VkPhysicalDeviceRayTracingPositionFetchFeaturesKHR, which Vulkan headers before 1.3.249 lack.
struct PositionFetchFeatures {
    VkStructureType sType;
    void* pNext;
    VkBool32 rayTracingPositionFetch;
};

// What a device must be created with for Glint to use it: chain `features.pNext` into VkDeviceCreateInfo.
// Points into static memory or itself; neither copy nor move.
struct DeviceRequirements {
    // `tracers`: which to enable, some of deviceTracers(). Packages run whose tracer is among them.
    // positionFetch, shaderFloat16: for packages that need them. pipelineStatistics: for
    // Renderer::pipelineStatistics().
    explicit DeviceRequirements(std::uint32_t tracers = package::kTracerRayQuery, bool positionFetch = false,
                                bool shaderFloat16 = false, bool pipelineStatistics = false);
    DeviceRequirements(const DeviceRequirements&) = delete;
    DeviceRequirements& operator=(const DeviceRequirements&) = delete;

    static constexpr std::uint32_t kApiVersion = VK_API_VERSION_1_3;
    std::vector<const char*> extensions;
    VkPhysicalDeviceFeatures2 features;  // chain of everything below
    VkPhysicalDeviceVulkan11Features vulkan11;
    VkPhysicalDeviceVulkan12Features vulkan12;
    VkPhysicalDeviceVulkan13Features vulkan13;
    VkPhysicalDeviceAccelerationStructureFeaturesKHR accelerationStructure;
    VkPhysicalDeviceRayQueryFeaturesKHR rayQuery;               // in the chain if among the tracers
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR rayPipeline;  // likewise
    PositionFetchFeatures positionFetch;                        // in the chain if asked for
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR pipelineExecutables;  // likewise
};

// Every extension and feature that `device` lacks, by name; empty if Glint runs on it. Of the tracers it
// needs one.
std::vector<std::string> missingRequirements(VkPhysicalDevice device);

class Context {
public:
    // Uses the caller's device. The error names each missing feature or extension of the physical device.
    static Result<std::unique_ptr<Context>> adopt(const DeviceHandles& handles);
    // Makes an instance, a device and a queue without a surface.
    static Result<std::unique_ptr<Context>> createHeadless(const HeadlessOptions& options = {});

    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    const DeviceHandles& handles() const;
    std::string deviceName() const;
    std::string driverName() const;
    VkPhysicalDeviceType deviceType() const;
    std::uint32_t subgroupSize() const;  // lanes
    // Messages of the validation layer so far, warnings and errors; empty with Validation::Off or adopt().
    std::vector<std::string> validationMessages() const;

    // What the driver knows of the pipelines that were made so far, for addPipelineCache() in another run on
    // the same device and driver, which make them faster for it. Error "vulkan-call".
    Result<std::vector<std::uint8_t>> pipelineCacheData() const;
    // Adds what an earlier run got; no Renderer or GpuScene may be in the making. `data` is not trusted:
    // error "pipeline-cache" where it is damaged or of another device or driver. With an error nothing has
    // changed.
    Status addPipelineCache(std::span<const std::uint8_t> data);
    // Of the device and driver, with hexadecimal digits and hyphens: for the name of a file that keeps the
    // data.
    std::string pipelineCacheName() const;

    struct State;  // for the runtime's own sources
    State& state();

private:
    explicit Context(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace glint
