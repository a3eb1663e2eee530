#include "context/context.h"
#include "context/vulkan_table.h"
#include "interop/frame.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace glint {
namespace {

constexpr const char* kExtensions[] = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                       VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

// Who needs a feature.
enum class Need : std::uint8_t {
    Runtime,      // the runtime, or all modules
    SomeModules,  // a device without it runs the packages whose modules do not need it
    RayQuery,     // the tracer
    RayPipeline,
};

// A feature's name, and the place of its bit in a DeviceRequirements.
struct Feature {
    Need need;
    const char* name;
    VkBool32& (*bit)(DeviceRequirements&);
};

#define GLINT_FEATURE(need, member, name)                                                          \
    Feature {                                                                                      \
        Need::need, #name,                                                                         \
            [](DeviceRequirements& requirements) -> VkBool32& { return requirements.member.name; } \
    }

constexpr Feature kFeatures[] = {
    GLINT_FEATURE(Runtime, vulkan12, bufferDeviceAddress),
    GLINT_FEATURE(Runtime, vulkan12, scalarBlockLayout),
    GLINT_FEATURE(Runtime, vulkan12, descriptorBindingPartiallyBound),
    GLINT_FEATURE(Runtime, vulkan12, descriptorBindingSampledImageUpdateAfterBind),
    GLINT_FEATURE(Runtime, vulkan12, hostQueryReset),
    GLINT_FEATURE(Runtime, vulkan13, dynamicRendering),
    GLINT_FEATURE(Runtime, vulkan13, synchronization2),
    GLINT_FEATURE(Runtime, accelerationStructure, accelerationStructure),
    GLINT_FEATURE(SomeModules, features.features, shaderStorageImageExtendedFormats),
    GLINT_FEATURE(SomeModules, features.features, shaderSampledImageArrayDynamicIndexing),
    GLINT_FEATURE(SomeModules, vulkan12, runtimeDescriptorArray),
    GLINT_FEATURE(SomeModules, vulkan12, shaderSampledImageArrayNonUniformIndexing),
    // An umbrella of the two above. Modules do not name it.
    GLINT_FEATURE(SomeModules, vulkan12, descriptorIndexing),
    GLINT_FEATURE(RayQuery, rayQuery, rayQuery),
    GLINT_FEATURE(RayPipeline, rayPipeline, rayTracingPipeline),
    // Lists of rays are dispatched by their length, which only the device knows. Modules do not name it.
    GLINT_FEATURE(RayPipeline, rayPipeline, rayTracingPipelineTraceRaysIndirect),
};
#undef GLINT_FEATURE

struct SubgroupOperation {
    const char* name;
    VkSubgroupFeatureFlagBits bit;
};
#define GLINT_SUBGROUP(bit) \
    SubgroupOperation {     \
#bit, bit           \
    }
constexpr SubgroupOperation kSubgroupOperations[] = {
    GLINT_SUBGROUP(VK_SUBGROUP_FEATURE_VOTE_BIT),
    GLINT_SUBGROUP(VK_SUBGROUP_FEATURE_ARITHMETIC_BIT),
    GLINT_SUBGROUP(VK_SUBGROUP_FEATURE_BALLOT_BIT),
    GLINT_SUBGROUP(VK_SUBGROUP_FEATURE_SHUFFLE_BIT),
    GLINT_SUBGROUP(VK_SUBGROUP_FEATURE_SHUFFLE_RELATIVE_BIT),
    GLINT_SUBGROUP(VK_SUBGROUP_FEATURE_CLUSTERED_BIT),
    GLINT_SUBGROUP(VK_SUBGROUP_FEATURE_QUAD_BIT),
};
#undef GLINT_SUBGROUP

struct TracerNeeds {
    package::Tracer tracer;
    Need need;
    const char* extension;
};
constexpr TracerNeeds kTracerNeeds[] = {
    {package::kTracerRayQuery, Need::RayQuery, VK_KHR_RAY_QUERY_EXTENSION_NAME},
    {package::kTracerRayPipeline, Need::RayPipeline, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME},
};

// Returns whether a device with these tracers is created with features of the need.
bool isNeeded(Need need, std::uint32_t tracers) {
    const auto* const ofTracer = std::ranges::find(kTracerNeeds, need, &TracerNeeds::need);
    return ofTracer == std::end(kTracerNeeds) || (tracers & ofTracer->tracer) != 0;
}

// The accessors take a mutable chain, but nothing is written through them here.
bool hasFeature(const DeviceReport& report, const Feature& feature) {
    return feature.bit(const_cast<DeviceRequirements&>(report.features)) != VK_FALSE;
}

// Returns the names of the features of a need that the report lacks, or of all.
std::vector<std::string> featuresOf(Need need, const DeviceReport* report = nullptr) {
    std::vector<std::string> names;
    for (const Feature& feature : kFeatures) {
        if (feature.need == need && (report == nullptr || !hasFeature(*report, feature))) {
            names.emplace_back(feature.name);
        }
    }
    return names;
}

// Returns a text such as "VK_KHR_ray_query (rayQuery) or VK_KHR_…".
std::string tracerChoices() {
    std::string text;
    for (const TracerNeeds& needs : kTracerNeeds) {
        text += (text.empty() ? "" : " or ") + std::string(needs.extension) + " (" +
                joinNames(featuresOf(needs.need)) + ")";
    }
    return text;
}

std::string versionName(std::uint32_t version) {
    return phrase(VK_API_VERSION_MAJOR(version), ".", VK_API_VERSION_MINOR(version));
}

// Numbers of the Vulkan registry, for headers that lack the names.
constexpr auto kPositionFetchFeatures = static_cast<VkStructureType>(1000481000);

}  // namespace

DeviceRequirements::DeviceRequirements(std::uint32_t tracers, bool fetchesPositions, bool computesHalf,
                                       bool tellsOfPipelines, bool usesMicromaps, bool readsClock)
    : extensions(std::begin(kExtensions), std::end(kExtensions)),
      features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &vulkan11, {}},
      vulkan11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, &vulkan12},
      vulkan12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &vulkan13},
      vulkan13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, &accelerationStructure},
      accelerationStructure{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR},
      rayQuery{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR},
      rayPipeline{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR},
      positionFetch{kPositionFetchFeatures},
      pipelineExecutables{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR},
      opacityMicromap{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_OPACITY_MICROMAP_FEATURES_EXT},
      clock{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_CLOCK_FEATURES_KHR} {
    const auto chain = [&](auto& feature) {
        feature.pNext = std::exchange(accelerationStructure.pNext, &feature);
    };
    const auto demand = [&](auto& feature, VkBool32& bit, const char* extension) {
        chain(feature);
        bit = VK_TRUE;
        extensions.push_back(extension);
    };
    if ((tracers & package::kTracerRayQuery) != 0) {
        chain(rayQuery);
    }
    if ((tracers & package::kTracerRayPipeline) != 0) {
        chain(rayPipeline);
    }
    if (fetchesPositions) {
        demand(positionFetch, positionFetch.rayTracingPositionFetch, kPositionFetchExtension);
    }
    if (tellsOfPipelines) {
        demand(pipelineExecutables, pipelineExecutables.pipelineExecutableInfo,
               VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    }
    if (usesMicromaps) {
        demand(opacityMicromap, opacityMicromap.micromap, VK_EXT_OPACITY_MICROMAP_EXTENSION_NAME);
    }
    if (readsClock) {
        demand(clock, clock.shaderSubgroupClock, VK_KHR_SHADER_CLOCK_EXTENSION_NAME);
    }
    vulkan12.shaderFloat16 = computesHalf ? VK_TRUE : VK_FALSE;
    for (const Feature& feature : kFeatures) {
        if (isNeeded(feature.need, tracers)) {
            feature.bit(*this) = VK_TRUE;
        }
    }
    for (const TracerNeeds& needs : kTracerNeeds) {
        if ((tracers & needs.tracer) != 0) {
            extensions.push_back(needs.extension);
        }
    }
}

void leaveOutLacking(const DeviceReport& report, DeviceRequirements& requirements) {
    for (const Feature& feature : kFeatures) {
        if (feature.need == Need::SomeModules) {
            feature.bit(requirements) = hasFeature(report, feature) ? VK_TRUE : VK_FALSE;
        }
    }
}

std::vector<std::string> moduleFeatures(const DeviceReport& report, const DeviceHandles& handles) {
    std::vector<std::string> features;
    for (const Feature& feature : kFeatures) {
        if (feature.need == Need::SomeModules ? hasFeature(report, feature)
                                              : isNeeded(feature.need, handles.tracers)) {
            features.emplace_back(feature.name);
        }
    }
    for (const SubgroupOperation& operation : kSubgroupOperations) {
        if ((report.subgroupOperations & operation.bit) != 0) {
            features.emplace_back(operation.name);
        }
    }
    const std::pair<bool, const char*> chosen[] = {{handles.positionFetch, "rayTracingPositionFetch"},
                                                   {handles.shaderFloat16, "shaderFloat16"},
                                                   {handles.shaderClock, "shaderSubgroupClock"}};
    for (const auto& [enabled, name] : chosen) {
        if (enabled) {
            features.emplace_back(name);
        }
    }
    return features;
}

bool hasExtension(const DeviceReport& report, const char* name) {
    return std::ranges::find(report.extensions, name) != report.extensions.end();
}

std::uint32_t tracersOf(const DeviceReport& report) {
    std::uint32_t tracers = 0;
    for (const TracerNeeds& needs : kTracerNeeds) {
        if (featuresOf(needs.need, &report).empty() && hasExtension(report, needs.extension)) {
            tracers |= needs.tracer;
        }
    }
    return tracers;
}

std::vector<std::string> missingFrom(const DeviceReport& report) {
    std::vector<std::string> missing;
    if (report.apiVersion < DeviceRequirements::kApiVersion) {
        missing.push_back("Vulkan " + versionName(DeviceRequirements::kApiVersion) + " (the device has " +
                          versionName(report.apiVersion) + ")");
    }
    for (const char* extension : kExtensions) {
        if (!hasExtension(report, extension)) {
            missing.emplace_back(extension);
        }
    }
    std::ranges::move(featuresOf(Need::Runtime, &report), std::back_inserter(missing));
    if (tracersOf(report) == 0) {
        missing.push_back(tracerChoices());
    }
    if ((report.subgroupStages & VK_SHADER_STAGE_COMPUTE_BIT) == 0) {
        missing.emplace_back("subgroup operations in compute shaders");
    }
    if (report.maxPushConstantBytes < sizeof(gpu::PushConstants)) {
        missing.push_back(std::to_string(sizeof(gpu::PushConstants)) + " bytes of push constants");
    }
    if (report.maxWorkgroupThreads < gpu::kScanGroupSize) {
        missing.push_back(phrase("workgroups of ", gpu::kScanGroupSize, " threads"));
    }
    if (!report.hasQueue) {
        missing.emplace_back("a queue family with graphics and compute");
    }
    return missing;
}

std::string joinNames(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) {
            text += i + 1 == names.size() ? " and " : ", ";
        }
        text += names[i];
    }
    return text;
}

namespace {

Status queryExtensions(const InstanceTable& table, VkPhysicalDevice device, DeviceReport& report) {
    std::vector<VkExtensionProperties> extensions;
    GLINT_TRY_DO(listAll("vkEnumerateDeviceExtensionProperties", extensions,
                         [&](std::uint32_t* count, VkExtensionProperties* list) {
                             return table.EnumerateDeviceExtensionProperties(device, nullptr, count, list);
                         }));
    for (const VkExtensionProperties& extension : extensions) {
        report.extensions.emplace_back(extension.extensionName);
    }
    return okStatus();
}

// Below Vulkan 1.3 the chains of queryFeatures() are not defined, so the report then has the version only.
void queryFeatures(const InstanceTable& table, VkPhysicalDevice device, DeviceReport& report) {
    VkPhysicalDeviceVulkan11Properties subgroup{.sType =
                                                    VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                           .pNext = &subgroup};
    table.GetPhysicalDeviceProperties2(device, &properties);
    report.subgroupStages = subgroup.subgroupSupportedStages;
    report.subgroupOperations = subgroup.subgroupSupportedOperations;
    const VkPhysicalDeviceLimits& limits = properties.properties.limits;
    report.maxPushConstantBytes = limits.maxPushConstantsSize;
    report.maxWorkgroupThreads =
        std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]);

    table.GetPhysicalDeviceFeatures2(device, &report.features.features);
}

}  // namespace

std::vector<VkQueueFamilyProperties> queueFamilies(const InstanceTable& table, VkPhysicalDevice device) {
    std::uint32_t count = 0;
    table.GetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    table.GetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    return families;
}

bool isSuitable(const VkQueueFamilyProperties& family) {
    constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    return (family.queueFlags & kNeeded) == kNeeded;
}

Status queryDevice(const InstanceTable& table, VkPhysicalDevice device, DeviceReport& report) {
    VkPhysicalDeviceProperties properties{};
    table.GetPhysicalDeviceProperties(device, &properties);
    report.apiVersion = properties.apiVersion;
    GLINT_TRY_DO(queryExtensions(table, device, report));
    // A device leaves structures of extensions that it lacks untouched, so the query starts from cleared
    // features.
    for (const Feature& feature : kFeatures) {
        feature.bit(report.features) = VK_FALSE;
    }
    if (report.apiVersion >= DeviceRequirements::kApiVersion) {
        queryFeatures(table, device, report);
    }
    report.hasQueue = std::ranges::any_of(queueFamilies(table, device), isSuitable);
    return okStatus();
}

namespace {

// Fills `report` through the system's loader. Returns the names of everything that this needs and the system
// lacks.
std::vector<std::string> askLoader(VkPhysicalDevice device, DeviceReport& report) {
    if (device == VK_NULL_HANDLE) {
        return {"a physical device"};
    }
    Result<std::shared_ptr<VulkanLibrary>> library = VulkanLibrary::open();
    if (!library) {
        return {"a Vulkan loader (libvulkan.so.1)"};
    }
    // The loader exports these functions for any instance, and the handle decides which driver answers.
    InstanceTable table;
#define GLINT_LOAD(name)                                                         \
    table.name = reinterpret_cast<PFN_vk##name>((*library)->symbol("vk" #name)); \
    if (table.name == nullptr) {                                                 \
        return {"vk" #name " in the Vulkan loader"};                             \
    }
    GLINT_INSTANCE_FUNCTIONS(GLINT_LOAD)
#undef GLINT_LOAD
    if (Status status = queryDevice(table, device, report); !status) {
        return {status.error().message};
    }
    return {};
}

}  // namespace

std::vector<std::string> missingRequirements(VkPhysicalDevice device) {
    DeviceReport report;
    std::vector<std::string> missing = askLoader(device, report);
    return missing.empty() ? missingFrom(report) : missing;
}

void DeviceRequirements::leaveOutLacking(VkPhysicalDevice device) {
    DeviceReport report;
    if (askLoader(device, report).empty()) {
        glint::leaveOutLacking(report, *this);
    }
}

std::uint32_t deviceTracers(VkPhysicalDevice device) {
    DeviceReport report;
    const bool complete = askLoader(device, report).empty() && missingFrom(report).empty();
    return complete ? tracersOf(report) : 0U;
}

namespace {

struct FormatPair {
    VkFormat linear;
    VkFormat srgb;
};

// Indexed by TexelFormat.
constexpr std::array<FormatPair, kTexelFormatCount> kVulkanFormats{{
    {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB},
    {VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_UNDEFINED},
    {VK_FORMAT_BC1_RGBA_UNORM_BLOCK, VK_FORMAT_BC1_RGBA_SRGB_BLOCK},
    {VK_FORMAT_BC2_UNORM_BLOCK, VK_FORMAT_BC2_SRGB_BLOCK},
    {VK_FORMAT_BC3_UNORM_BLOCK, VK_FORMAT_BC3_SRGB_BLOCK},
    {VK_FORMAT_BC4_UNORM_BLOCK, VK_FORMAT_UNDEFINED},
    {VK_FORMAT_BC5_UNORM_BLOCK, VK_FORMAT_UNDEFINED},
    {VK_FORMAT_BC7_UNORM_BLOCK, VK_FORMAT_BC7_SRGB_BLOCK},
    {VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, VK_FORMAT_ETC2_R8G8B8_SRGB_BLOCK},
    {VK_FORMAT_ETC2_R8G8B8A1_UNORM_BLOCK, VK_FORMAT_ETC2_R8G8B8A1_SRGB_BLOCK},
    {VK_FORMAT_ETC2_R8G8B8A8_UNORM_BLOCK, VK_FORMAT_ETC2_R8G8B8A8_SRGB_BLOCK},
    {VK_FORMAT_EAC_R11_UNORM_BLOCK, VK_FORMAT_UNDEFINED},
    {VK_FORMAT_EAC_R11G11_UNORM_BLOCK, VK_FORMAT_UNDEFINED},
    {VK_FORMAT_ASTC_4x4_UNORM_BLOCK, VK_FORMAT_ASTC_4x4_SRGB_BLOCK},
    {VK_FORMAT_ASTC_5x4_UNORM_BLOCK, VK_FORMAT_ASTC_5x4_SRGB_BLOCK},
    {VK_FORMAT_ASTC_5x5_UNORM_BLOCK, VK_FORMAT_ASTC_5x5_SRGB_BLOCK},
    {VK_FORMAT_ASTC_6x5_UNORM_BLOCK, VK_FORMAT_ASTC_6x5_SRGB_BLOCK},
    {VK_FORMAT_ASTC_6x6_UNORM_BLOCK, VK_FORMAT_ASTC_6x6_SRGB_BLOCK},
    {VK_FORMAT_ASTC_8x5_UNORM_BLOCK, VK_FORMAT_ASTC_8x5_SRGB_BLOCK},
    {VK_FORMAT_ASTC_8x6_UNORM_BLOCK, VK_FORMAT_ASTC_8x6_SRGB_BLOCK},
    {VK_FORMAT_ASTC_8x8_UNORM_BLOCK, VK_FORMAT_ASTC_8x8_SRGB_BLOCK},
    {VK_FORMAT_ASTC_10x5_UNORM_BLOCK, VK_FORMAT_ASTC_10x5_SRGB_BLOCK},
    {VK_FORMAT_ASTC_10x6_UNORM_BLOCK, VK_FORMAT_ASTC_10x6_SRGB_BLOCK},
    {VK_FORMAT_ASTC_10x8_UNORM_BLOCK, VK_FORMAT_ASTC_10x8_SRGB_BLOCK},
    {VK_FORMAT_ASTC_10x10_UNORM_BLOCK, VK_FORMAT_ASTC_10x10_SRGB_BLOCK},
    {VK_FORMAT_ASTC_12x10_UNORM_BLOCK, VK_FORMAT_ASTC_12x10_SRGB_BLOCK},
    {VK_FORMAT_ASTC_12x12_UNORM_BLOCK, VK_FORMAT_ASTC_12x12_SRGB_BLOCK},
}};

VkComponentSwizzle swizzleOf(TexelChannel channel) {
    constexpr VkComponentSwizzle kSwizzles[] = {VK_COMPONENT_SWIZZLE_R,    VK_COMPONENT_SWIZZLE_G,
                                                VK_COMPONENT_SWIZZLE_B,    VK_COMPONENT_SWIZZLE_A,
                                                VK_COMPONENT_SWIZZLE_ZERO, VK_COMPONENT_SWIZZLE_ONE};
    return kSwizzles[static_cast<std::uint32_t>(channel)];
}

}  // namespace

VkFormat vulkanFormat(TexelFormat format, bool srgb) {
    const FormatPair& pair = kVulkanFormats[static_cast<std::size_t>(format)];
    return srgb ? pair.srgb : pair.linear;
}

VkComponentMapping vulkanComponents(const TexelChannels& channels) {
    return {swizzleOf(channels[0]), swizzleOf(channels[1]), swizzleOf(channels[2]), swizzleOf(channels[3])};
}

TexelFormats queryTexelFormats(const InstanceTable& instance, VkPhysicalDevice device) {
    constexpr VkFormatFeatureFlags kTexture = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT |
                                              VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
                                              VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    TexelFormats formats;
    for (std::uint32_t i = 0; i < kTexelFormatCount; ++i) {
        const auto format = static_cast<TexelFormat>(i);
        for (const bool srgb : {false, true}) {
            const VkFormat vulkan = vulkanFormat(format, srgb);
            if (vulkan == VK_FORMAT_UNDEFINED || format == TexelFormat::Rgba16) {
                continue;
            }
            VkFormatProperties properties{};
            instance.GetPhysicalDeviceFormatProperties(device, vulkan, &properties);
            if ((properties.optimalTilingFeatures & kTexture) == kTexture) {
                formats.add(format, srgb);
            }
        }
    }
    return formats;
}

}  // namespace glint
