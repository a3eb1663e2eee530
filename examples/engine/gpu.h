// The engine's own layer over Vulkan: as much as the example needs. An error ends the program with a message.
#pragma once

#include <glint/package_shape.h>

#include <vulkan/vulkan.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace engine {

// Ends the program unless `result` is VK_SUCCESS.
void check(VkResult result, const char* call);
[[noreturn]] void fail(const std::string& message);

struct Buffer {
    VkBuffer handle = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceAddress address = 0;
    VkDeviceSize bytes = 0;
    void* mapped = nullptr;  // null if the host can't see it
};

struct Image {
    VkImage handle = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkFormat format = VK_FORMAT_UNDEFINED;
};

struct AccelerationStructure {
    Buffer buffer;
    VkAccelerationStructureKHR handle = VK_NULL_HANDLE;
    VkDeviceAddress address = 0;
    VkDeviceAddress scratch = 0;
};

// Instance, device and queue. Everything that it made is destroyed with it.
class Gpu {
public:
    // Takes the first device that has one of the tracers (package::Tracer bits) and what Glint needs.
    explicit Gpu(bool validation, std::uint32_t tracers = glint::package::kAllTracers);
    ~Gpu();
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;

    Buffer buffer(VkDeviceSize bytes, bool hostVisible, VkBufferUsageFlags usage = 0);
    Buffer upload(std::span<const std::uint8_t> bytes, VkBufferUsageFlags usage = 0);
    Image image(VkFormat format, VkExtent2D extent, std::uint32_t mips, VkImageUsageFlags usage);
    // An image that shaders sample, with all mips; each is blitted from the one before.
    Image texture(std::span<const std::uint8_t> rgba8, VkExtent2D extent, bool srgb);
    VkShaderModule shader(const std::string& file);
    // Records commands, submits them and waits.
    void once(const std::function<void(VkCommandBuffer)>& record);
    // Builds a structure anew, in `target` if that has been built with the same counts. Both commands and
    // scratch live as long as the Gpu.
    void build(VkCommandBuffer commands, VkAccelerationStructureTypeKHR type,
               std::span<const VkAccelerationStructureGeometryKHR> geometries,
               std::span<const std::uint32_t> counts, AccelerationStructure& target);
    // Orders all earlier commands before all later ones.
    void barrier(VkCommandBuffer commands);

    // The number of errors and warnings of the validation layer.
    std::uint32_t messages() const {
        return messages_;
    }
    std::string name() const;

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t family = 0;
    std::uint32_t tracers = 0;  // all that the device has; they are enabled
    float anisotropy = 1.0F;    // of the filter of textures; 1 for none
    VkCommandPool pool = VK_NULL_HANDLE;

    // Runs `destroy` when the Gpu is destroyed, the last one first.
    void later(std::function<void()> destroy) {
        destroyers_.push_back(std::move(destroy));
    }

private:
    VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted);
    void createInstance(bool validation);
    void createDevice(std::uint32_t wanted);

    std::vector<std::function<void()>> destroyers_;
    std::uint32_t messages_ = 0;
    PFN_vkCreateAccelerationStructureKHR createStructure_ = nullptr;
    PFN_vkDestroyAccelerationStructureKHR destroyStructure_ = nullptr;
    PFN_vkGetAccelerationStructureBuildSizesKHR buildSizes_ = nullptr;
    PFN_vkCmdBuildAccelerationStructuresKHR cmdBuild_ = nullptr;
    PFN_vkGetAccelerationStructureDeviceAddressKHR structureAddress_ = nullptr;
};

}  // namespace engine
