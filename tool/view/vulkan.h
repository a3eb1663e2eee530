// Small owners of what the window makes on the device, and its errors. The window links the Vulkan loader, as
// Dear ImGui's backend does.
#pragma once

#include <glint/context.h>
#include <glint/result.h>

#include <vulkan/vulkan.h>

#include <cstdint>
#include <utility>

namespace glint::view {

// Returns the error "vulkan-call" for a call that failed.
Diagnostic callError(const char* call, VkResult result);

// An image of RGBA with 8 bits that shaders write and that is copied to the window.
class DeviceImage {
public:
    // Leaves the image in the layout UNDEFINED.
    static Result<DeviceImage> create(const Context& context, std::uint32_t width, std::uint32_t height);
    DeviceImage() = default;
    DeviceImage(const DeviceImage&) = delete;
    DeviceImage& operator=(const DeviceImage&) = delete;
    DeviceImage(DeviceImage&& other) noexcept {
        *this = std::move(other);
    }
    DeviceImage& operator=(DeviceImage&& other) noexcept;
    ~DeviceImage();

    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    std::uint32_t width = 0;   // pixels
    std::uint32_t height = 0;  // pixels

private:
    VkDevice device_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
};

// Records that all commands so far are done, and visible, before all later ones.
void recordBarrier(VkCommandBuffer commands);

// Records that an image changes its layout, after all commands before and before all later ones.
void recordLayout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to);

}  // namespace glint::view
