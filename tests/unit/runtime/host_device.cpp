#include "host_device.h"

#include <iterator>

namespace glint::test {
namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL collect(VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/,
                                       VkDebugUtilsMessageTypeFlagsEXT /*types*/,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data, void* messages) {
    static_cast<std::vector<std::string>*>(messages)->emplace_back(data->pMessage);
    return VK_FALSE;
}

}  // namespace

bool HostDevice::create(std::uint32_t tracers) {
    handles_.tracers = tracers;
    Result<std::shared_ptr<VulkanLibrary>> library = VulkanLibrary::open();
    if (!library) {
        return false;
    }
    library_ = *library;
    return createInstance() && createDevice();
}

bool HostDevice::createInstance() {
    const Result<GlobalTable> global = loadGlobalTable(library_->getInstanceProcAddr());
    if (!global) {
        return false;
    }
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = DeviceRequirements::kApiVersion;
    const char* const layers[] = {"VK_LAYER_KHRONOS_validation"};
    const char* const extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = std::size(layers);
    info.ppEnabledLayerNames = layers;
    info.enabledExtensionCount = std::size(extensions);
    info.ppEnabledExtensionNames = extensions;
    handles_.debugUtils = global->CreateInstance(&info, nullptr, &handles_.instance) == VK_SUCCESS;
    if (!handles_.debugUtils) {
        info.enabledLayerCount = 0;
        info.enabledExtensionCount = 0;
        if (global->CreateInstance(&info, nullptr, &handles_.instance) != VK_SUCCESS) {
            return false;
        }
    }
    instance_ = *loadInstanceTable(library_->getInstanceProcAddr(), handles_.instance);
    if (handles_.debugUtils) {
        VkDebugUtilsMessengerCreateInfoEXT messenger{};
        messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
        messenger.messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
        messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
        messenger.pfnUserCallback = collect;
        messenger.pUserData = &messages_;
        instance_.CreateDebugUtilsMessengerEXT(handles_.instance, &messenger, nullptr, &messenger_);
    }
    return true;
}

bool HostDevice::createDevice() {
    std::uint32_t count = 0;
    instance_.EnumeratePhysicalDevices(handles_.instance, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    instance_.EnumeratePhysicalDevices(handles_.instance, &count, devices.data());
    for (VkPhysicalDevice device : devices) {
        if (handles_.physicalDevice == VK_NULL_HANDLE &&
            (deviceTracers(device) & handles_.tracers) == handles_.tracers) {
            handles_.physicalDevice = device;
        }
    }
    if (handles_.physicalDevice == VK_NULL_HANDLE) {
        return false;
    }
    const DeviceRequirements requirements(handles_.tracers);
    const float priority = 1.0F;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &requirements.features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = static_cast<std::uint32_t>(requirements.extensions.size());
    info.ppEnabledExtensionNames = requirements.extensions.data();
    if (instance_.CreateDevice(handles_.physicalDevice, &info, nullptr, &handles_.device) != VK_SUCCESS) {
        return false;
    }
    device_ = *loadDeviceTable(instance_, handles_);
    device_.GetDeviceQueue(handles_.device, 0, 0, &handles_.queue);
    return true;
}

void HostDevice::destroy() {
    if (handles_.device != VK_NULL_HANDLE) {
        device_.DestroyDevice(handles_.device, nullptr);
    }
    if (messenger_ != VK_NULL_HANDLE) {
        instance_.DestroyDebugUtilsMessengerEXT(handles_.instance, messenger_, nullptr);
    }
    if (handles_.instance != VK_NULL_HANDLE) {
        instance_.DestroyInstance(handles_.instance, nullptr);
    }
    handles_ = {};
    messenger_ = VK_NULL_HANDLE;
}

}  // namespace glint::test
