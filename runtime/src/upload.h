// Host data into device buffers and images, through a staging buffer of bounded size.
#pragma once

#include "commands.h"
#include "resources.h"

#include <cstdint>
#include <memory>
#include <span>

namespace glint {

class Uploader {
public:
    static Result<std::unique_ptr<Uploader>> create(Context::State& context);

    // `target` needs VK_BUFFER_USAGE_TRANSFER_DST_BIT and room for offset + bytes.
    Status copyToBuffer(std::span<const std::uint8_t> bytes, const Buffer& target, VkDeviceSize offset = 0);
    // Fills the first mips of an image of undefined layout with texels of `texelBytes` bytes, blits the
    // others that it has each from the one before, and leaves all of them in SHADER_READ_ONLY_OPTIMAL.
    // Requires one mip at least. `target` needs TRANSFER_DST usage, and TRANSFER_SRC usage where mips are
    // blitted.
    Status copyToImage(std::span<const std::span<const std::uint8_t>> mips, std::uint32_t texelBytes,
                       const DeviceImage& target);
    // Waits until everything is on the device, visible to all commands that are submitted later.
    Status finish();

private:
    explicit Uploader(Context::State& context) : context_(&context), pool_(context) {}
    // Room for at least `unit` bytes, at most `wanted`; submits what there is to make room.
    Result<VkDeviceSize> reserve(VkDeviceSize wanted, VkDeviceSize unit);
    Status start();
    // All mips become TRANSFER_DST_OPTIMAL.
    Status startImage(const DeviceImage& target);
    Status copyRows(std::span<const std::uint8_t> texels, std::uint32_t texelBytes, const DeviceImage& target,
                    std::uint32_t mip);
    // Blits the mips behind the first `given`, and makes all of them readable.
    void recordMips(const DeviceImage& target, std::uint32_t given);

    Context::State* context_;
    MemoryPool pool_;
    Buffer staging_;
    std::unique_ptr<CommandRunner> runner_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;  // null between recordings
    VkDeviceSize used_ = 0;
};

// Bytes of an array of plain structures.
template <typename T>
std::span<const std::uint8_t> bytesOf(std::span<const T> elements) {
    return {reinterpret_cast<const std::uint8_t*>(elements.data()), elements.size_bytes()};
}

}  // namespace glint
