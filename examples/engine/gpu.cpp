#include "gpu.h"

#include <glint/context.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>

namespace engine {
namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/,
                                         VkDebugUtilsMessageTypeFlagsEXT /*types*/,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    std::cerr << data->pMessage << '\n';
    ++*static_cast<std::uint32_t*>(user);
    return VK_FALSE;
}

}  // namespace

void fail(const std::string& message) {
    std::cerr << "engine: " << message << '\n';
    std::exit(1);
}

void check(VkResult result, const char* call) {
    if (result != VK_SUCCESS) {
        fail(std::string(call) + " returned " + std::to_string(result));
    }
}

Gpu::Gpu(bool validation, std::uint32_t wanted) {
    createInstance(validation);
    createDevice(wanted);
    VkCommandPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    info.queueFamilyIndex = family;
    check(vkCreateCommandPool(device, &info, nullptr, &pool), "vkCreateCommandPool");
    later([this] { vkDestroyCommandPool(device, pool, nullptr); });
}

Gpu::~Gpu() {
    vkDeviceWaitIdle(device);
    for (; !destroyers_.empty(); destroyers_.pop_back()) {
        destroyers_.back()();
    }
}

void Gpu::createInstance(bool validation) {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = glint::DeviceRequirements::kApiVersion;
    const char* const layers[] = {"VK_LAYER_KHRONOS_validation"};
    const char* const extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    constexpr VkValidationFeatureEnableEXT kEnabled[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = kEnabled;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    if (validation) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = layers;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = extensions;
    }
    check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
    later([this] { vkDestroyInstance(instance, nullptr); });
    if (!validation) {
        return;
    }
    VkDebugUtilsMessengerCreateInfoEXT messenger{};
    messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    messenger.pfnUserCallback = onMessage;
    messenger.pUserData = &messages_;
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
    VkDebugUtilsMessengerEXT handle = VK_NULL_HANDLE;
    check(create(instance, &messenger, nullptr, &handle), "vkCreateDebugUtilsMessengerEXT");
    later([this, handle] {
        reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"))(instance, handle, nullptr);
    });
}

void Gpu::createDevice(std::uint32_t wanted) {
    std::uint32_t count = 0;
    vkEnumeratePhysicalDevices(instance, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    vkEnumeratePhysicalDevices(instance, &count, devices.data());
    const auto found = std::ranges::find_if(devices, [wanted](VkPhysicalDevice candidate) {
        return (glint::deviceTracers(candidate) & wanted) != 0;
    });
    if (found == devices.end()) {
        fail("no device has what Glint and this example need");
    }
    physical = *found;
    tracers = glint::deviceTracers(physical);
    std::vector<VkQueueFamilyProperties> families;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    families.resize(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    while (family < count && (families[family].queueFlags & kNeeded) != kNeeded) {
        ++family;
    }
    // Glint needs the same features as the engine, but for the filter of its textures.
    glint::DeviceRequirements requirements(tracers);
    VkPhysicalDeviceFeatures features{};
    vkGetPhysicalDeviceFeatures(physical, &features);
    requirements.features.features.samplerAnisotropy = features.samplerAnisotropy;
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(physical, &properties);
    // On a CPU such a filter costs more than all else.
    if (features.samplerAnisotropy == VK_TRUE && properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU) {
        anisotropy = std::min(16.0F, properties.limits.maxSamplerAnisotropy);
    }
    const float priority = 1.0F;
    VkDeviceQueueCreateInfo queueInfo{};
    queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queueInfo.queueFamilyIndex = family;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &requirements.features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queueInfo;
    info.enabledExtensionCount = static_cast<std::uint32_t>(requirements.extensions.size());
    info.ppEnabledExtensionNames = requirements.extensions.data();
    check(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
    later([this] { vkDestroyDevice(device, nullptr); });
    vkGetDeviceQueue(device, family, 0, &queue);
    const auto load = [this](auto& function, const char* name) {
        function =
            reinterpret_cast<std::remove_reference_t<decltype(function)>>(vkGetDeviceProcAddr(device, name));
    };
    load(createStructure_, "vkCreateAccelerationStructureKHR");
    load(destroyStructure_, "vkDestroyAccelerationStructureKHR");
    load(buildSizes_, "vkGetAccelerationStructureBuildSizesKHR");
    load(cmdBuild_, "vkCmdBuildAccelerationStructuresKHR");
    load(structureAddress_, "vkGetAccelerationStructureDeviceAddressKHR");
}

std::string Gpu::name() const {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(physical, &properties);
    return properties.deviceName;
}

VkDeviceMemory Gpu::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties types{};
    vkGetPhysicalDeviceMemoryProperties(physical, &types);
    std::uint32_t type = 0;
    while (type < types.memoryTypeCount && ((needs.memoryTypeBits >> type & 1U) == 0 ||
                                            (types.memoryTypes[type].propertyFlags & wanted) != wanted)) {
        ++type;
    }
    VkMemoryAllocateFlagsInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.pNext = &flags;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(vkAllocateMemory(device, &info, nullptr, &memory), "vkAllocateMemory");
    later([this, memory] { vkFreeMemory(device, memory, nullptr); });
    return memory;
}

Buffer Gpu::buffer(VkDeviceSize bytes, bool hostVisible, VkBufferUsageFlags usage) {
    Buffer result;
    result.bytes = std::max<VkDeviceSize>(bytes, 16);
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = result.bytes;
    info.usage = usage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    check(vkCreateBuffer(device, &info, nullptr, &result.handle), "vkCreateBuffer");
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device, result.handle, &needs);
    result.memory = allocate(
        needs, hostVisible ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                           : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    later([this, handle = result.handle] { vkDestroyBuffer(device, handle, nullptr); });
    check(vkBindBufferMemory(device, result.handle, result.memory, 0), "vkBindBufferMemory");
    if (hostVisible) {
        check(vkMapMemory(device, result.memory, 0, VK_WHOLE_SIZE, 0, &result.mapped), "vkMapMemory");
    }
    VkBufferDeviceAddressInfo address{};
    address.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    address.buffer = result.handle;
    result.address = vkGetBufferDeviceAddress(device, &address);
    return result;
}

Buffer Gpu::upload(std::span<const std::uint8_t> bytes, VkBufferUsageFlags usage) {
    const Buffer staging = buffer(bytes.size(), true);
    std::memcpy(staging.mapped, bytes.data(), bytes.size());
    const Buffer target = buffer(bytes.size(), false, usage);
    once([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, staging.bytes};
        vkCmdCopyBuffer(commands, staging.handle, target.handle, 1, &region);
    });
    return target;
}

Image Gpu::image(VkFormat format, VkExtent2D extent, std::uint32_t mips, VkImageUsageFlags usage) {
    Image result;
    result.format = format;
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = mips;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    check(vkCreateImage(device, &info, nullptr, &result.handle), "vkCreateImage");
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device, result.handle, &needs);
    result.memory = allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    later([this, handle = result.handle] { vkDestroyImage(device, handle, nullptr); });
    check(vkBindImageMemory(device, result.handle, result.memory, 0), "vkBindImageMemory");
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = result.handle;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {
        static_cast<VkImageAspectFlags>(format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT
                                                                       : VK_IMAGE_ASPECT_COLOR_BIT),
        0, mips, 0, 1};
    check(vkCreateImageView(device, &view, nullptr, &result.view), "vkCreateImageView");
    later([this, handle = result.view] { vkDestroyImageView(device, handle, nullptr); });
    return result;
}

Image Gpu::texture(std::span<const std::uint8_t> rgba8, VkExtent2D extent, bool srgb) {
    const auto mips = static_cast<std::uint32_t>(std::bit_width(std::max(extent.width, extent.height)));
    const Image result =
        image(srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM, extent, mips,
              VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    const Buffer staging = buffer(rgba8.size(), true);
    std::memcpy(staging.mapped, rgba8.data(), rgba8.size());
    once([&](VkCommandBuffer commands) {
        const auto move = [&](std::uint32_t mip, VkImageLayout from, VkImageLayout to) {
            VkImageMemoryBarrier2 moved{};
            moved.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
            moved.srcStageMask = moved.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
            moved.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
            moved.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
            moved.oldLayout = from;
            moved.newLayout = to;
            moved.image = result.handle;
            moved.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 1, 0, 1};
            VkDependencyInfo dependency{};
            dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
            dependency.imageMemoryBarrierCount = 1;
            dependency.pImageMemoryBarriers = &moved;
            vkCmdPipelineBarrier2(commands, &dependency);
        };
        for (std::uint32_t mip = 0; mip < mips; ++mip) {
            move(mip, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        }
        const VkBufferImageCopy copy{
            0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {0, 0, 0}, {extent.width, extent.height, 1}};
        vkCmdCopyBufferToImage(commands, staging.handle, result.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                               1, &copy);
        const auto corner = [&](std::uint32_t mip) {
            return VkOffset3D{static_cast<std::int32_t>(std::max(extent.width >> mip, 1U)),
                              static_cast<std::int32_t>(std::max(extent.height >> mip, 1U)), 1};
        };
        for (std::uint32_t mip = 1; mip < mips; ++mip) {
            move(mip - 1, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
            const VkImageBlit blit{{VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 0, 1},
                                   {{0, 0, 0}, corner(mip - 1)},
                                   {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1},
                                   {{0, 0, 0}, corner(mip)}};
            vkCmdBlitImage(commands, result.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, result.handle,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
            move(mip - 1, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        }
        move(mips - 1, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    });
    return result;
}

VkShaderModule Gpu::shader(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
    if (bytes.empty() || bytes.size() % 4 != 0) {
        fail(file + " is no SPIR-V");
    }
    std::vector<std::uint32_t> words(bytes.size() / 4);
    std::memcpy(words.data(), bytes.data(), bytes.size());
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = bytes.size();
    info.pCode = words.data();
    VkShaderModule shaderModule = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device, &info, nullptr, &shaderModule), "vkCreateShaderModule");
    later([this, shaderModule] { vkDestroyShaderModule(device, shaderModule, nullptr); });
    return shaderModule;
}

void Gpu::once(const std::function<void(VkCommandBuffer)>& record) {
    VkCommandBufferAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocation.commandPool = pool;
    allocation.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocation.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(vkAllocateCommandBuffers(device, &allocation, &commands), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    record(commands);
    check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    check(vkQueueWaitIdle(queue), "vkQueueWaitIdle");
    vkFreeCommandBuffers(device, pool, 1, &commands);
}

void Gpu::build(VkCommandBuffer commands, VkAccelerationStructureTypeKHR type,
                std::span<const VkAccelerationStructureGeometryKHR> geometries,
                std::span<const std::uint32_t> counts, AccelerationStructure& target) {
    VkAccelerationStructureBuildGeometryInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
    info.type = type;
    info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    info.geometryCount = static_cast<std::uint32_t>(geometries.size());
    info.pGeometries = geometries.data();
    VkAccelerationStructureBuildSizesInfoKHR sizes{};
    sizes.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
    buildSizes_(device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, counts.data(), &sizes);
    if (target.handle == VK_NULL_HANDLE) {
        constexpr VkDeviceSize kAlignment = 256;  // at least that of any device's scratch
        const Buffer scratch = buffer(sizes.buildScratchSize + kAlignment, false);
        target.buffer = buffer(sizes.accelerationStructureSize, false,
                               VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
        VkAccelerationStructureCreateInfoKHR create{};
        create.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
        create.buffer = target.buffer.handle;
        create.size = sizes.accelerationStructureSize;
        create.type = type;
        check(createStructure_(device, &create, nullptr, &target.handle), "vkCreateAccelerationStructureKHR");
        later([this, handle = target.handle] { destroyStructure_(device, handle, nullptr); });
        VkAccelerationStructureDeviceAddressInfoKHR address{};
        address.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR;
        address.accelerationStructure = target.handle;
        target.address = structureAddress_(device, &address);
        target.scratch = (scratch.address + kAlignment - 1) / kAlignment * kAlignment;
    }
    info.dstAccelerationStructure = target.handle;
    info.scratchData.deviceAddress = target.scratch;
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
    for (const std::uint32_t count : counts) {
        ranges.push_back({count, 0, 0, 0});
    }
    const VkAccelerationStructureBuildRangeInfoKHR* const first = ranges.data();
    cmdBuild_(commands, 1, &info, &first);
}

void Gpu::barrier(VkCommandBuffer commands) {
    VkMemoryBarrier2 memory{};
    memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    memory.srcStageMask = memory.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    memory.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    memory.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &memory;
    vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace engine
