// A headless device that Glint makes: the instance, validation, and the choice of the physical device.
#include "context/context.h"
#include "context/vulkan_table.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

namespace glint {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL collectMessage(VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/,
                                              VkDebugUtilsMessageTypeFlagsEXT /*types*/,
                                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* log) {
    const char* text = data->pMessage != nullptr ? data->pMessage : "(no text)";
    static_cast<ValidationLog*>(log)->add(text);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationLog& log) {
    return {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
            .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                               VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
            // GENERAL is left out, because its messages from the loader are about other drivers' files.
            .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
            .pfnUserCallback = collectMessage,
            .pUserData = &log};
}

bool hasLayer(const GlobalTable& table, const char* name) {
    std::vector<VkLayerProperties> layers;
    const Status listed =
        listAll("vkEnumerateInstanceLayerProperties", layers, table.EnumerateInstanceLayerProperties);
    return listed && std::ranges::any_of(layers, [name](const VkLayerProperties& layer) {
               return std::strcmp(layer.layerName, name) == 0;
           });
}

bool hasInstanceExtension(const GlobalTable& table, const char* name) {
    std::vector<VkExtensionProperties> extensions;
    const Status listed = listAll("vkEnumerateInstanceExtensionProperties", extensions,
                                  [&](std::uint32_t* count, VkExtensionProperties* list) {
                                      return table.EnumerateInstanceExtensionProperties(nullptr, count, list);
                                  });
    return listed && std::ranges::any_of(extensions, [name](const auto& extension) {
               return std::strcmp(extension.extensionName, name) == 0;
           });
}

// Creates the instance and, with validation, the messenger.
Status createInstance(const GlobalTable& table, const HeadlessOptions& options, Context::State& state) {
    const Validation validation = options.validation;
    std::vector<const char*> extensions;
    for (const std::string& extension : options.instanceExtensions) {
        extensions.push_back(extension.c_str());
    }
    std::vector<const char*> layers;
    const bool labels = hasInstanceExtension(table, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (validation != Validation::Off) {
        if (!hasLayer(table, kValidationLayer) || !labels) {
            return makeError(
                "validation-layer", "",
                std::string("validation was asked for, and ") + kValidationLayer + " is not installed",
                "install vulkan-validationlayers or turn validation off");
        }
        layers.push_back(kValidationLayer);
    }
    if (validation == Validation::Synchronization) {
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);  // an extension of the layer
    }
    if (labels) {
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }

    VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                  .pApplicationName = "glint",
                                  .apiVersion = DeviceRequirements::kApiVersion};

    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(state.log);
    constexpr VkValidationFeatureEnableEXT kEnabled =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT validationFeatures{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                               .pNext = &messenger,
                                               .enabledValidationFeatureCount = 1,
                                               .pEnabledValidationFeatures = &kEnabled};

    VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                              .pApplicationInfo = &application,
                              .enabledLayerCount = static_cast<std::uint32_t>(layers.size()),
                              .ppEnabledLayerNames = layers.data(),
                              .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                              .ppEnabledExtensionNames = extensions.data()};
    if (validation == Validation::On) {
        info.pNext = &messenger;
    } else if (validation == Validation::Synchronization) {
        info.pNext = &validationFeatures;
    }
    const VkResult result = table.CreateInstance(&info, nullptr, &state.handles.instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        return makeError("device-missing", "", "there is no Vulkan driver on this machine",
                         "install a driver, for instance mesa-vulkan-drivers");
    }
    GLINT_TRY_DO(statusOf("vkCreateInstance", result));
    GLINT_TRY(state.instance, loadInstanceTable(table.GetInstanceProcAddr, state.handles.instance));
    state.ownsInstance = true;
    state.handles.debugUtils = labels;
    if (validation != Validation::Off) {
        return statusOf("vkCreateDebugUtilsMessengerEXT",
                        state.instance.CreateDebugUtilsMessengerEXT(state.handles.instance, &messenger,
                                                                    nullptr, &state.messenger));
    }
    return okStatus();
}

Result<std::vector<VkPhysicalDevice>> enumerateDevices(const Context::State& state) {
    std::vector<VkPhysicalDevice> devices;
    GLINT_TRY_DO(
        listAll("vkEnumeratePhysicalDevices", devices, [&](std::uint32_t* count, VkPhysicalDevice* list) {
            return state.instance.EnumeratePhysicalDevices(state.handles.instance, count, list);
        }));
    if (devices.empty()) {
        return makeError("device-missing", "", "there is no Vulkan device on this machine",
                         "install a driver, for instance mesa-vulkan-drivers");
    }
    return devices;
}

// Returns the first device that has that name and all features. The error lists the faults of each device.
// Reduces `tracers` to those that the chosen device supports.
Result<VkPhysicalDevice> chooseDevice(const Context::State& state, const HeadlessOptions& options,
                                      std::uint32_t& tracers) {
    const std::string& wanted = options.deviceName;
    GLINT_TRY(auto devices, enumerateDevices(state));
    std::vector<std::string> names;
    std::vector<std::string> complaints;
    for (VkPhysicalDevice device : devices) {
        VkPhysicalDeviceProperties properties{};
        state.instance.GetPhysicalDeviceProperties(device, &properties);
        const std::string name = properties.deviceName;
        names.push_back(name);
        if (name.find(wanted) == std::string::npos) {
            continue;
        }
        DeviceReport report;
        GLINT_TRY_DO(queryDevice(state.instance, device, report));
        std::vector<std::string> missing = missingFrom(report);
        const std::uint32_t common = tracersOf(report) & tracers;
        if (missing.empty() && common == 0) {
            missing.emplace_back("the tracers that were asked for");
        }
        if (options.positionFetch && !hasExtension(report, kPositionFetchExtension)) {
            missing.emplace_back(kPositionFetchExtension);
        }
        if (options.shaderFloat16 && report.features.vulkan12.shaderFloat16 == VK_FALSE) {
            missing.emplace_back("shaderFloat16, which --precision 16 needs");
        }
        for (const std::string& extension : options.deviceExtensions) {
            if (!hasExtension(report, extension.c_str())) {
                missing.push_back(extension);
            }
        }
        // A device that has the extension has its feature too (Vulkan 1.3 specification, "Feature
        // Requirements").
        if (options.shaderClock && !hasExtension(report, VK_KHR_SHADER_CLOCK_EXTENSION_NAME)) {
            missing.emplace_back(std::string(VK_KHR_SHADER_CLOCK_EXTENSION_NAME) +
                                 ", which the layer clocks needs");
        }
        if (missing.empty()) {
            tracers = common;
            return device;
        }
        complaints.push_back(name + " lacks " + joinNames(missing));
    }
    if (complaints.empty()) {
        return makeError("device-missing", "", "no Vulkan device has a name with \"" + wanted + "\"",
                         "the devices are: " + joinNames(names));
    }
    std::string message = "no Vulkan device can run Glint";
    for (const std::string& complaint : complaints) {
        message += ": " + complaint;
    }
    return makeError("device-features", "", message, "update the driver or use another device");
}

Status createDevice(Context::State& state, std::span<const std::string> further) {
    DeviceRequirements requirements(state.handles.tracers, state.handles.positionFetch,
                                    state.handles.shaderFloat16, state.handles.pipelineStatistics,
                                    state.handles.opacityMicromaps, state.handles.shaderClock);
    DeviceReport report;
    GLINT_TRY_DO(queryDevice(state.instance, state.handles.physicalDevice, report));
    leaveOutLacking(report, requirements);
    const VkBool32 anisotropy = report.features.features.features.samplerAnisotropy;
    requirements.features.features.samplerAnisotropy = anisotropy;
    state.handles.samplerAnisotropy = anisotropy == VK_TRUE;
    const std::vector<VkQueueFamilyProperties> families =
        queueFamilies(state.instance, state.handles.physicalDevice);
    // chooseDevice() has checked that one is suitable.
    state.handles.queueFamily =
        static_cast<std::uint32_t>(std::ranges::find_if(families, isSuitable) - families.begin());
    const float priority = 1.0F;
    VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                  .queueFamilyIndex = state.handles.queueFamily,
                                  .queueCount = 1,
                                  .pQueuePriorities = &priority};
    VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                            .pNext = &requirements.features,
                            .queueCreateInfoCount = 1,
                            .pQueueCreateInfos = &queue};
    for (const std::string& extension : further) {
        requirements.extensions.push_back(extension.c_str());
    }
    info.enabledExtensionCount = static_cast<std::uint32_t>(requirements.extensions.size());
    info.ppEnabledExtensionNames = requirements.extensions.data();
    GLINT_TRY_DO(statusOf("vkCreateDevice", state.instance.CreateDevice(state.handles.physicalDevice, &info,
                                                                        nullptr, &state.handles.device)));
    state.ownsDevice = true;
    GLINT_TRY_DO(finishContext(state));
    state.vk.GetDeviceQueue(state.handles.device, state.handles.queueFamily, 0, &state.handles.queue);
    return okStatus();
}

}  // namespace

Result<std::unique_ptr<Context>> Context::createHeadless(const HeadlessOptions& options) try {
    auto state = std::make_unique<State>();
    GLINT_TRY(state->library, VulkanLibrary::open());
    state->handles.getInstanceProcAddr = state->library->getInstanceProcAddr();
    GLINT_TRY(auto table, loadGlobalTable(state->handles.getInstanceProcAddr));
    GLINT_TRY_DO(createInstance(table, options, *state));
    state->handles.tracers = options.tracers;
    state->handles.positionFetch = options.positionFetch;
    state->handles.shaderFloat16 = options.shaderFloat16;
    state->handles.shaderClock = options.shaderClock;
    GLINT_TRY(auto device, chooseDevice(*state, options, state->handles.tracers));
    state->handles.physicalDevice = device;
    if (options.pipelineStatistics || options.opacityMicromaps) {
        DeviceReport report;
        GLINT_TRY_DO(queryDevice(state->instance, device, report));
        // A device that supports one of these extensions supports its feature too (Vulkan 1.3 specification,
        // "Feature Requirements").
        state->handles.pipelineStatistics =
            options.pipelineStatistics &&
            hasExtension(report, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
        state->handles.opacityMicromaps =
            options.opacityMicromaps && hasExtension(report, VK_EXT_OPACITY_MICROMAP_EXTENSION_NAME);
    }
    GLINT_TRY_DO(createDevice(*state, options.deviceExtensions));
    return std::unique_ptr<Context>(new Context(std::move(state)));
}
GLINT_CATCH

}  // namespace glint
