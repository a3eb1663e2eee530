// The Vulkan device that Glint works on. It is the caller's, or a headless device that Glint makes.
//
// Threads: functions without a comment of their own may be called from any thread at any time, do not wait
// for the device and submit nothing. Objects of one Context may be used on several threads at once, each
// object on one thread at a time. All submissions go to DeviceHandles::queue under HostServices::lockQueue;
// functions that submit say so.
#pragma once

#include <glint/package_shape.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Makes the error "vulkan-call" of a call of Vulkan that failed, with ErrorKind and code.
Diagnostic vulkanError(const char* call, VkResult result);

// The side that reads and writes a resource's memory.
enum class MemoryUse : std::uint32_t {
    Device,    // read and written by the device
    Upload,    // written by the host, coherent
    Shared,    // written by the host, coherent, and near the device if it has such memory
    Readback,  // read by the host, coherent, cached if the device has such memory
};

// A buffer or an image, or several of the same kind.
struct MemoryItem {
    std::string name;
    MemoryUse use = MemoryUse::Device;
    bool isImage = false;
    std::uint32_t count = 1;
    std::uint64_t bytes = 0;  // of all `count` resources together
};

// Handles of the caller's device. The caller owns them and keeps them alive as long as the Context.
struct DeviceHandles {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;  // graphics, compute and transfer
    std::uint32_t queueFamily = 0;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;  // null: the system's loader
    bool debugUtils = false;  // the instance has VK_EXT_debug_utils: passes then get labels
    // True if VkPhysicalDeviceFeatures::samplerAnisotropy is enabled on the device. Without it Glint runs
    // too, but textures are blurrier at grazing angles.
    bool samplerAnisotropy = false;
    // True if VK_KHR_ray_tracing_position_fetch is enabled on the device. Some packages need it.
    bool positionFetch = false;
    // True if VkPhysicalDeviceVulkan12Features::shaderFloat16 is enabled on the device. Some packages need
    // it.
    bool shaderFloat16 = false;
    // True if VK_KHR_pipeline_executable_properties and its feature are enabled on the device. Renderers can
    // then report the driver's statistics of their pipelines.
    bool pipelineStatistics = false;
    // True if VK_EXT_opacity_micromap and its feature `micromap` are enabled on the device. Scenes then get
    // micromaps for the triangles that need an alpha test (docs/alpha.md).
    bool opacityMicromaps = false;
    // True if VK_KHR_shader_clock and its feature shaderSubgroupClock are enabled on the device. Packages
    // with the layer "clocks" need it.
    bool shaderClock = false;
    // The package::Tracer bits whose extensions and features are enabled on the device. They are the bits
    // that its DeviceRequirements were made with.
    std::uint32_t tracers = package::kTracerRayQuery;
};

// Services of the caller's, which must live as long as the Context. Each may be left out, and Glint then does
// that work itself. Glint uses what is given for everything. There is no place for a descriptor pool: each
// set has a pool of exactly its size, and there is one set a scene and one a renderer.
//
// The functions may be called from any thread, several at once, and must not throw or call Glint.
struct HostServices {
    // A request for the memory of one buffer or image.
    struct MemoryRequest {
        VkMemoryRequirements requirements{};
        MemoryUse use = MemoryUse::Device;
        VkMemoryPropertyFlags required = 0;   // of the memory's type
        VkMemoryPropertyFlags preferred = 0;  // beside those
        VkMemoryAllocateFlags flags = 0;      // of the VkDeviceMemory
        bool isImage = false;                 // with optimal tiling; see bufferImageGranularity
        const char* name = "";                // what it is for, with HostServices::namePrefix
    };

    // A range of device memory.
    struct MemoryRange {
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkDeviceSize offset = 0;
        std::uint32_t type = 0;      // of the memory
        void* allocation = nullptr;  // for the allocator's own use
    };

    // Give and take back device memory; all three or none. Without memory the result is an error of Vulkan's;
    // VK_ERROR_OUT_OF_DEVICE_MEMORY says that no heap that fits has any left. `mapMemory` sets the address
    // of a range whose MemoryUse is not Device, which stays valid until it is freed.
    std::function<VkResult(const MemoryRequest& request, MemoryRange& range)> allocateMemory;
    std::function<void(const MemoryRange& range)> freeMemory;
    std::function<VkResult(const MemoryRange& range, void*& mapped)> mapMemory;
    // Is given to each function of Vulkan that makes or destroys an object.
    const VkAllocationCallbacks* allocation = nullptr;
    // All pipelines are made with it. The caller fills, saves and destroys it.
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;
    // Enclose each submission to DeviceHandles::queue; both or none. Programs that submit to the queue from
    // other threads need them.
    std::function<void()> lockQueue;
    std::function<void()> unlockQueue;
    // Runs a job later on another thread. It makes a pipeline in the background or destroys replaced ones,
    // which may take seconds. All jobs must run or be destroyed before the Context is destroyed.
    std::function<void(std::function<void()> job)> runJob;
    // Stands before the names of objects and of labels in command buffers, with DeviceHandles::debugUtils.
    std::string namePrefix = "glint ";
    // Is told what no function returns: failures in the background, and memory taken from another heap than
    // the preferred one.
    std::function<void(const Diagnostic& message)> message;
};

enum class Validation { Off, On, Synchronization };

struct HeadlessOptions {
    // Every value but Off requires the Khronos validation layer and collects its messages.
    Validation validation = Validation::Off;
    std::string deviceName;  // part of the device's name; empty: the first device with all features
    // The package::Tracer bits to enable. Those that the device lacks are left out; it must support at least
    // one.
    std::uint32_t tracers = package::kAllTracers;
    // Enables VK_KHR_ray_tracing_position_fetch, which some packages need. If the device lacks it, the error
    // is "device-features".
    bool positionFetch = false;
    // Enables 16-bit float arithmetic, which some packages need. If the device lacks it, the error is
    // "device-features".
    bool shaderFloat16 = false;
    // Enables VK_KHR_pipeline_executable_properties if the device supports it;
    // DeviceHandles::pipelineStatistics then says whether it does.
    bool pipelineStatistics = false;
    // Enables VK_EXT_opacity_micromap if the device supports it; DeviceHandles::opacityMicromaps then says
    // whether it does.
    bool opacityMicromaps = true;
    // Further extensions to enable, for programs that show pictures in windows. A device that lacks one of
    // the device extensions is not chosen; Vulkan's error for a missing extension of the instance is
    // returned.
    std::vector<std::string> instanceExtensions{};
    std::vector<std::string> deviceExtensions{};
    // Enables VK_KHR_shader_clock, which packages with the layer "clocks" need. If the device lacks it, the
    // error is "device-features".
    bool shaderClock = false;
};

// Returns the package::Tracer bits that a device can be created with. 0 means that Glint does not run on it.
std::uint32_t deviceTracers(VkPhysicalDevice device);

// The extensions and features that a device must be created with for Glint to use it. Chain `features.pNext`
// into VkDeviceCreateInfo. Some of the features are needed by some modules only; leaveOutLacking() clears
// those that a device lacks. The structure points into static memory and into itself, so it can be neither
// copied nor moved.
struct DeviceRequirements {
    // `tracers` are the bits to enable, a subset of deviceTracers(). The device then runs packages that have
    // one of these tracers. Some packages need `positionFetch` or `shaderFloat16`.
    // Renderer::pipelineStatistics() needs `pipelineStatistics`.
    explicit DeviceRequirements(std::uint32_t tracers = package::kTracerRayQuery, bool positionFetch = false,
                                bool shaderFloat16 = false, bool pipelineStatistics = false,
                                bool opacityMicromaps = false, bool shaderClock = false);
    DeviceRequirements(const DeviceRequirements&) = delete;
    DeviceRequirements& operator=(const DeviceRequirements&) = delete;

    // Clears the features that only some modules need and that `device` lacks. Renderers whose package has
    // such a module name it and the feature.
    void leaveOutLacking(VkPhysicalDevice device);

    // Has the layout of VkPhysicalDeviceRayTracingPositionFetchFeaturesKHR, which Vulkan headers
    // before 1.3.249 lack.
    struct PositionFetchFeatures {
        VkStructureType sType;
        void* pNext;
        VkBool32 rayTracingPositionFetch;
    };
    static constexpr std::uint32_t kApiVersion = VK_API_VERSION_1_3;
    std::vector<const char*> extensions;
    VkPhysicalDeviceFeatures2 features;  // head of the chain of the structures below
    VkPhysicalDeviceVulkan11Features vulkan11;
    VkPhysicalDeviceVulkan12Features vulkan12;
    VkPhysicalDeviceVulkan13Features vulkan13;
    VkPhysicalDeviceAccelerationStructureFeaturesKHR accelerationStructure;
    VkPhysicalDeviceRayQueryFeaturesKHR rayQuery;               // in the chain if `tracers` has it
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR rayPipeline;  // in the chain if `tracers` has it
    PositionFetchFeatures positionFetch;                        // in the chain if it is asked for
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR pipelineExecutables;  // in the chain if asked for
    VkPhysicalDeviceOpacityMicromapFeaturesEXT opacityMicromap;                   // in the chain if asked for
    VkPhysicalDeviceShaderClockFeaturesKHR clock;                                 // in the chain if asked for
};

// Returns the name of every extension and feature that `device` lacks. The list is empty if Glint runs on the
// device, which needs only one of the tracers.
std::vector<std::string> missingRequirements(VkPhysicalDevice device);

class Context {
public:
    // Uses the caller's device. Errors: "context-handles", "context-queue", "context-services" (an incomplete
    // service), "device-features" (it names each feature or extension that the physical device lacks), and
    // those of loading Vulkan's functions.
    static Result<std::unique_ptr<Context>> adopt(const DeviceHandles& handles,
                                                  const HostServices& services = {});
    // Makes an instance, a device and a queue. Makes no surface. Errors: "validation-layer",
    // "device-missing", "device-features", and those of the loader and of Vulkan's calls.
    static Result<std::unique_ptr<Context>> createHeadless(const HeadlessOptions& options = {});

    // Everything that was made with the Context must be destroyed before. Waits for jobs of the background.
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    const DeviceHandles& handles() const;
    std::string deviceName() const;
    std::string driverName() const;
    VkPhysicalDeviceType deviceType() const;
    std::uint32_t subgroupSize() const;  // lanes
    // Returns the formats of ImageView that the device samples with filters, by vkGetPhysicalDeviceFormat-
    // Properties. RGBA8 is always among them. RGBA16 may be given to every device: it is stored with 8 bits
    // where it is not among them.
    TexelFormats texelFormats() const;
    // Returns the warnings and errors of the validation layer so far. The list is empty with Validation::Off
    // and after adopt().
    std::vector<std::string> validationMessages() const;

    // Returns the driver's cache of the pipelines made so far. Another run on the same device and driver can
    // pass it to addPipelineCache(), and then makes these pipelines faster. With HostServices::pipelineCache
    // it is the data of that cache. Error "vulkan-call".
    Result<std::vector<std::uint8_t>> pipelineCacheData() const;
    // Adds the data that pipelineCacheData() returned in an earlier run. Pipelines that are being made
    // meanwhile do without it. The data is not trusted: error "pipeline-cache" if it is damaged or belongs
    // to another device or driver, or if the cache is HostServices::pipelineCache, which only its owner may
    // change. An error leaves the cache unchanged.
    Status addPipelineCache(std::span<const std::uint8_t> data);
    // Returns a name that identifies the device and the driver, for the file that keeps the data. It consists
    // of hexadecimal digits and hyphens.
    std::string pipelineCacheName() const;

    struct State;  // for the runtime's own sources
    State& state();

private:
    explicit Context(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

// --- The times of a frame's passes ---

// The part of a frame that a time belongs to. docs/design.md explains it in "Passes of a frame".
enum class Pass : std::uint32_t {
    Frame,  // the whole frame, with Timing::Frame
    Hits,   // a round of rays, from their list to their shaded hits, with Timing::Frame
    Gbuffer,
    FirstOrder,  // the order of the pixels by the case of what they see
    FirstShade,  // the shading of pixels, except in passes of one case
    FirstCase,
    EffectWalk,
    EffectRays,
    PathRays,
    RayDispatch,
    Trace,
    Count,
    Offset,
    Copy,
    CheckOrder,
    Shade,  // the shading of hits, except in passes of one case
    ShadeCase,
    ShadowDispatch,
    Shadow,
    Compose,
};

// Returns whether a pass shades one case, whose shader ID is PassTiming::shaderId.
constexpr bool isOfCase(Pass pass) {
    return pass == Pass::FirstCase || pass == Pass::ShadeCase;
}

struct PassTiming {
    std::string name;  // for people; it is also the debug label of the pass
    double milliseconds = 0.0;
    Pass pass = Pass::Frame;
    std::uint32_t shaderId = 0;  // of Pass::FirstCase and Pass::ShadeCase
};

}  // namespace glint
