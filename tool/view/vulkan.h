// Small owners of the window's objects on the device, and its errors. The window links the Vulkan loader, as
// Dear ImGui's backend does.
#pragma once

#include <glint/context.h>
#include <glint/result.h>

#include <vulkan/vulkan.h>

#include <cstddef>
#include <cstdint>
#include <utility>

namespace glint::view {

// Returns the error "vulkan-call" for a call that failed.
Diagnostic callError(const char* call, VkResult result);
Status checkCall(const char* call, VkResult result);

// A handle that the device destroys with its owner.
template <typename Handle, auto Destroy>
class Owned {
public:
    Owned() = default;
    Owned(VkDevice device, Handle handle) : device_(device), handle_(handle) {}
    Owned(const Owned&) = delete;
    Owned& operator=(const Owned&) = delete;
    Owned(Owned&& other) noexcept {
        *this = std::move(other);
    }
    Owned& operator=(Owned&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Owned() {
        if (handle_ != VK_NULL_HANDLE) {
            Destroy(device_, handle_, nullptr);
        }
    }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    Handle handle_ = VK_NULL_HANDLE;
};
using OwnedMemory = Owned<VkDeviceMemory, vkFreeMemory>;

// An image of RGBA with 8 bits that shaders and copies write and that is copied to the window.
class DeviceImage {
public:
    // Leaves the image in the layout UNDEFINED.
    static Result<DeviceImage> create(const Context& context, std::uint32_t width, std::uint32_t height);

    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    std::uint32_t width = 0;   // pixels
    std::uint32_t height = 0;  // pixels

private:
    OwnedMemory memory_;
    Owned<VkImage, vkDestroyImage> image_;
    Owned<VkImageView, vkDestroyImageView> view_;
};

// A buffer in the host's memory that is copied to the device.
class HostBuffer {
public:
    static Result<HostBuffer> create(const Context& context, std::size_t bytes);

    VkBuffer handle = VK_NULL_HANDLE;
    std::uint8_t* data = nullptr;  // its memory, which the device sees without further calls
    std::size_t bytes = 0;

private:
    OwnedMemory memory_;
    Owned<VkBuffer, vkDestroyBuffer> buffer_;
};

// Makes a pool of commands that are short-lived, and its command buffer. The caller destroys `pool`, also
// after an error.
Status createCommands(const Context& context, VkCommandPool& pool, VkCommandBuffer& commands);

// A command buffer that is recorded and submitted once. The device must be done with it when it is destroyed.
class OneTimeCommands {
public:
    // Begins to record.
    static Result<OneTimeCommands> create(const Context& context);

    VkCommandBuffer handle() const {
        return commands_;
    }
    // Submits them to the context's queue, before all that is submitted later.
    Status submit(const Context& context);

private:
    Owned<VkCommandPool, vkDestroyCommandPool> pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

// Records that all commands so far are done, and visible, before all later ones.
void recordBarrier(VkCommandBuffer commands);

// Records that an image changes its layout, after all commands before and before all later ones.
void recordLayout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to);

}  // namespace glint::view
