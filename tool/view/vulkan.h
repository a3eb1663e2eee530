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

// An image of RGBA with 8 bits that shaders and copies write and that is copied to the window.
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

// A buffer in the host's memory that is copied to the device.
class HostBuffer {
public:
    static Result<HostBuffer> create(const Context& context, std::size_t bytes);
    HostBuffer() = default;
    HostBuffer(const HostBuffer&) = delete;
    HostBuffer& operator=(const HostBuffer&) = delete;
    HostBuffer(HostBuffer&& other) noexcept {
        *this = std::move(other);
    }
    HostBuffer& operator=(HostBuffer&& other) noexcept;
    ~HostBuffer();

    VkBuffer handle() const {
        return buffer_;
    }
    // Its memory, which the device sees without further calls.
    std::uint8_t* data() const {
        return data_;
    }
    std::size_t bytes() const {
        return bytes_;
    }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    std::uint8_t* data_ = nullptr;
    std::size_t bytes_ = 0;
};

// Makes a pool of commands that are short-lived, and its command buffer. The caller destroys `pool`, also
// after an error.
Status createCommands(const Context& context, VkCommandPool& pool, VkCommandBuffer& commands);

// A command buffer that is recorded and submitted once.
class OneTimeCommands {
public:
    // Begins to record.
    static Result<OneTimeCommands> create(const Context& context);
    OneTimeCommands() = default;
    OneTimeCommands(const OneTimeCommands&) = delete;
    OneTimeCommands& operator=(const OneTimeCommands&) = delete;
    OneTimeCommands(OneTimeCommands&& other) noexcept {
        *this = std::move(other);
    }
    OneTimeCommands& operator=(OneTimeCommands&& other) noexcept;
    // The device must be done with the commands.
    ~OneTimeCommands();

    VkCommandBuffer handle() const {
        return commands_;
    }
    // Submits them to the context's queue, before all that is submitted later.
    Status submit(const Context& context);

private:
    VkDevice device_ = VK_NULL_HANDLE;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

// Records that all commands so far are done, and visible, before all later ones.
void recordBarrier(VkCommandBuffer commands);

// Records that an image changes its layout, after all commands before and before all later ones.
void recordLayout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to);

}  // namespace glint::view
