#include "context/context.h"

#include "context/vulkan_table.h"

#include <glint/internal/package_modules.h>

#include <algorithm>
#include <utility>

namespace glint {

void ValidationLog::add(std::string message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
}

std::vector<std::string> ValidationLog::messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
}

Context::State::~State() {
    if (handles.device != VK_NULL_HANDLE) {
        if (services.pipelineCache == VK_NULL_HANDLE && pipelineCache != VK_NULL_HANDLE) {
            replacedCaches.push_back(pipelineCache);
        }
        for (VkPipelineCache cache : replacedCaches) {
            vk.DestroyPipelineCache(handles.device, cache, services.allocation);
        }
        if (ownsDevice && vk.DestroyDevice != nullptr) {
            vk.DestroyDevice(handles.device, nullptr);
        }
    }
    if (ownsInstance) {
        if (messenger != VK_NULL_HANDLE) {
            instance.DestroyDebugUtilsMessengerEXT(handles.instance, messenger, nullptr);
        }
        instance.DestroyInstance(handles.instance, nullptr);
    }
}

QueueLock::QueueLock(Context::State& context) : context_(context) {
    if (context_.services.lockQueue) {
        context_.services.lockQueue();
    } else {
        context_.queueMutex.lock();
    }
}

QueueLock::~QueueLock() {
    if (context_.services.unlockQueue) {
        context_.services.unlockQueue();
    } else {
        context_.queueMutex.unlock();
    }
}

namespace {

// This keeps textures sharp down to a cosine of 1 / 16.
constexpr float kMaxAnisotropy = 16.0F;

// Fills the limit `multiprocessors` and the features. Error "vulkan-call".
Status queryReport(Context::State& state) {
    DeviceReport report;
    GLINT_TRY_DO(queryDevice(state.instance, state.handles.physicalDevice, report));
    state.features = moduleFeatures(report, state.handles);
    if (hasExtension(report, VK_NV_SHADER_SM_BUILTINS_EXTENSION_NAME)) {
        VkPhysicalDeviceShaderSMBuiltinsPropertiesNV builtins{
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_SM_BUILTINS_PROPERTIES_NV};
        VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                               .pNext = &builtins};
        state.instance.GetPhysicalDeviceProperties2(state.handles.physicalDevice, &properties);
        state.limits.multiprocessors = builtins.shaderSMCount;
    }
    return okStatus();
}

void queryLimits(Context::State& state) {
    DeviceLimits& limits = state.limits;
    limits.accelerationStructure.sType =
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR;
    VkPhysicalDeviceVulkan13Properties vulkan13{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES,
        .pNext = &limits.accelerationStructure};
    if ((state.handles.tracers & package::kTracerRayPipeline) != 0) {
        limits.rayPipeline.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR;
        limits.accelerationStructure.pNext = &limits.rayPipeline;
    }
    if (state.handles.opacityMicromaps) {
        limits.opacityMicromap.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_OPACITY_MICROMAP_PROPERTIES_EXT;
        limits.opacityMicromap.pNext =
            std::exchange(limits.accelerationStructure.pNext, &limits.opacityMicromap);
    }
    VkPhysicalDeviceVulkan12Properties vulkan12{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES, .pNext = &vulkan13};
    VkPhysicalDeviceVulkan11Properties vulkan11{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES, .pNext = &vulkan12};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                           .pNext = &vulkan11};
    state.instance.GetPhysicalDeviceProperties2(state.handles.physicalDevice, &properties);
    limits.accelerationStructure.pNext = nullptr;
    limits.opacityMicromap.pNext = nullptr;
    limits.core = properties.properties.limits;
    limits.maxAllocationBytes = vulkan11.maxMemoryAllocationSize;
    limits.maxBufferBytes = vulkan13.maxBufferSize;
    limits.maxTextures = vulkan12.maxPerStageDescriptorUpdateAfterBindSampledImages;
    limits.maxSamplers = vulkan12.maxPerStageDescriptorUpdateAfterBindSamplers;
    // Mesa's lavapipe (25.0) has the feature, but with explicit gradients it reads the level of the longer
    // one.
    if (state.handles.samplerAnisotropy && vulkan12.driverID != VK_DRIVER_ID_MESA_LLVMPIPE) {
        limits.samplerAnisotropy = std::min(kMaxAnisotropy, limits.core.maxSamplerAnisotropy);
    }
    limits.deviceType = properties.properties.deviceType;
    limits.subgroupSize = vulkan11.subgroupSize;
    limits.subgroupOperations = vulkan11.subgroupSupportedOperations;
    limits.deviceName = properties.properties.deviceName;
    limits.driverName = std::string(vulkan12.driverName) + " " + vulkan12.driverInfo;
    limits.cacheOwner = {properties.properties.vendorID,
                         properties.properties.deviceID,
                         vulkan12.driverID,
                         properties.properties.driverVersion,
                         {}};
    std::ranges::copy(properties.properties.pipelineCacheUUID, limits.cacheOwner.cacheUuid.begin());
    state.instance.GetPhysicalDeviceMemoryProperties(state.handles.physicalDevice, &limits.memory);
    constexpr VkFormatFeatureFlags kTexture = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT |
                                              VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
                                              VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT;
    VkFormatProperties wide{};
    state.instance.GetPhysicalDeviceFormatProperties(state.handles.physicalDevice,
                                                     VK_FORMAT_R16G16B16A16_UNORM, &wide);
    limits.wideTextures = (wide.optimalTilingFeatures & kTexture) == kTexture;
    limits.texelFormats = queryTexelFormats(state.instance, state.handles.physicalDevice);
    if (limits.wideTextures) {
        limits.texelFormats.add(TexelFormat::Rgba16, false);
        limits.texelFormats.add(TexelFormat::Rgba16, true);
    }
    VkFormatProperties floats{};
    state.instance.GetPhysicalDeviceFormatProperties(state.handles.physicalDevice,
                                                     VK_FORMAT_R32G32B32A32_SFLOAT, &floats);
    limits.filteredFloats =
        (floats.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
}

Status checkQueueFamily(Context::State& state) {
    const std::vector<VkQueueFamilyProperties> families =
        queueFamilies(state.instance, state.handles.physicalDevice);
    const std::uint32_t family = state.handles.queueFamily;
    if (family >= families.size() || !isSuitable(families[family])) {
        return makeError("context-queue", "", phrase("queue family ", family, " has no graphics and compute"),
                         "pass a queue of a family with VK_QUEUE_GRAPHICS_BIT and VK_QUEUE_COMPUTE_BIT");
    }
    state.limits.timestampValidBits = families[family].timestampValidBits;
    return okStatus();
}

std::string tracerNames(std::uint32_t tracers) {
    std::vector<std::string> names;
    for (const package::Tracer tracer : package::kTracers) {
        if ((tracers & tracer) != 0) {
            names.emplace_back(nameOf(tracer));
        }
    }
    return joinNames(names);
}

Status checkHandles(const DeviceHandles& handles) {
    const std::pair<bool, const char*> needed[] = {
        {handles.instance != VK_NULL_HANDLE, "instance"},
        {handles.physicalDevice != VK_NULL_HANDLE, "physicalDevice"},
        {handles.device != VK_NULL_HANDLE, "device"},
        {handles.queue != VK_NULL_HANDLE, "queue"}};
    for (const auto& [present, name] : needed) {
        if (!present) {
            return makeError("context-handles", "", std::string("DeviceHandles::") + name + " is null",
                             "fill every handle before Context::adopt()");
        }
    }
    if (handles.tracers == 0 || handles.tracers > package::kAllTracers) {
        return makeError("context-handles", "", "DeviceHandles::tracers is no set of tracers",
                         "give the tracers that the device was created with");
    }
    return okStatus();
}

Status checkServices(const HostServices& services) {
    const bool allocates[] = {services.allocateMemory != nullptr, services.freeMemory != nullptr,
                              services.mapMemory != nullptr};
    const bool locks[] = {services.lockQueue != nullptr, services.unlockQueue != nullptr};
    if (std::ranges::count(allocates, true) % std::ssize(allocates) != 0 || locks[0] != locks[1]) {
        return makeError("context-services", "", "HostServices has a part of an allocator or of a lock",
                         "give all functions of a service, or none");
    }
    return okStatus();
}

}  // namespace

// A device that has one of these extensions has its feature too (Vulkan 1.3 specification, "Feature
// Requirements").
Status checkClaims(const DeviceHandles& handles, const DeviceReport& report) {
    if (const std::vector<std::string> missing = missingFrom(report); !missing.empty()) {
        return makeError("device-features", "", "the device lacks " + joinNames(missing),
                         "update the driver or use another device");
    }
    if (const std::uint32_t absent = handles.tracers & ~tracersOf(report); absent != 0) {
        return makeError("device-features", "",
                         "DeviceHandles::tracers has " + tracerNames(absent) + ", which the device lacks",
                         "create the device with some of deviceTracers()");
    }
    const auto has = [&](const char* extension) { return hasExtension(report, extension); };
    const struct {
        const char* member;
        bool claimed;
        const char* feature;
        bool present;
    } claims[] = {
        {"positionFetch", handles.positionFetch, kPositionFetchExtension, has(kPositionFetchExtension)},
        {"shaderFloat16", handles.shaderFloat16, "shaderFloat16",
         report.features.vulkan12.shaderFloat16 == VK_TRUE},
        {"shaderClock", handles.shaderClock, VK_KHR_SHADER_CLOCK_EXTENSION_NAME,
         has(VK_KHR_SHADER_CLOCK_EXTENSION_NAME)},
        {"opacityMicromaps", handles.opacityMicromaps, VK_EXT_OPACITY_MICROMAP_EXTENSION_NAME,
         has(VK_EXT_OPACITY_MICROMAP_EXTENSION_NAME)},
        {"pipelineStatistics", handles.pipelineStatistics,
         VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME,
         has(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME)},
        {"samplerAnisotropy", handles.samplerAnisotropy, "samplerAnisotropy",
         report.features.features.features.samplerAnisotropy == VK_TRUE}};
    for (const auto& claim : claims) {
        if (claim.claimed && !claim.present) {
            return makeError("device-features", "",
                             std::string("DeviceHandles::") + claim.member +
                                 " is set, and the device lacks " + claim.feature,
                             "leave it false");
        }
    }
    return okStatus();
}

Status finishContext(Context::State& state) {
    GLINT_TRY(state.vk, loadDeviceTable(state.instance, state.handles));
    queryLimits(state);
    GLINT_TRY_DO(queryReport(state));
    GLINT_TRY_DO(checkQueueFamily(state));
    if (state.services.pipelineCache != VK_NULL_HANDLE) {
        state.pipelineCache = state.services.pipelineCache;
        return okStatus();
    }
    GLINT_TRY(state.pipelineCache, createPipelineCache(state, {}));
    return okStatus();
}

VkShaderStageFlags passStages(const Context::State& state) {
    constexpr VkShaderStageFlags kRayStages =
        VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_ANY_HIT_BIT_KHR |
        VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR | VK_SHADER_STAGE_MISS_BIT_KHR;
    const bool rayPipeline = (state.handles.tracers & package::kTracerRayPipeline) != 0;
    return VK_SHADER_STAGE_COMPUTE_BIT | (rayPipeline ? kRayStages : 0U);
}

Result<std::unique_ptr<Context>> Context::adopt(const DeviceHandles& handles,
                                                const HostServices& services) try {
    GLINT_TRY_DO(checkHandles(handles));
    GLINT_TRY_DO(checkServices(services));
    auto state = std::make_unique<State>(services);
    state->handles = handles;
    if (handles.getInstanceProcAddr == nullptr) {
        GLINT_TRY(state->library, VulkanLibrary::open());
        state->handles.getInstanceProcAddr = state->library->getInstanceProcAddr();
    }
    GLINT_TRY(state->instance, loadInstanceTable(state->handles.getInstanceProcAddr, handles.instance));
    DeviceReport report;
    GLINT_TRY_DO(queryDevice(state->instance, handles.physicalDevice, report));
    GLINT_TRY_DO(checkClaims(handles, report));
    GLINT_TRY_DO(finishContext(*state));
    return std::unique_ptr<Context>(new Context(std::move(state)));
}
GLINT_CATCH

Context::Context(std::unique_ptr<State> state) : state_(std::move(state)) {}

Context::~Context() = default;

const DeviceHandles& Context::handles() const {
    return state_->handles;
}

std::string Context::deviceName() const {
    return state_->limits.deviceName;
}

std::string Context::driverName() const {
    return state_->limits.driverName;
}

VkPhysicalDeviceType Context::deviceType() const {
    return state_->limits.deviceType;
}

TexelFormats Context::texelFormats() const {
    return state_->limits.texelFormats;
}

std::uint32_t Context::subgroupSize() const {
    return state_->limits.subgroupSize;
}

std::vector<std::string> Context::validationMessages() const {
    return state_->log.messages();
}

Context::State& Context::state() {
    return *state_;
}

}  // namespace glint
