// Copies host data into device buffers and images, through a staging buffer of bounded size.
#pragma once

#include "context/commands.h"
#include "context/resources.h"

#include <cstdint>
#include <memory>
#include <span>

namespace glint {

class Uploader {
public:
    static Result<std::unique_ptr<Uploader>> create(Context::State& context);

    // `target` needs VK_BUFFER_USAGE_TRANSFER_DST_BIT and room for offset + bytes.
    Status copyToBuffer(std::span<const std::uint8_t> bytes, const Buffer& target, VkDeviceSize offset = 0);
    // Fills the first mips of an undefined image with texels of `texelBytes` bytes. Blits each remaining mip
    // from the one before, and leaves all of them in SHADER_READ_ONLY_OPTIMAL. Requires at least one mip.
    // `target` needs TRANSFER_DST usage, and TRANSFER_SRC usage if mips are blitted.
    Status copyToImage(std::span<const std::span<const std::uint8_t>> mips, std::uint32_t texelBytes,
                       const DeviceImage& target);
    // Waits until all data is on the device and visible to all commands that are submitted later.
    Status finish();

private:
    explicit Uploader(Context::State& context) : context_(&context), pool_(context) {}
    // Returns room for at least `unit` and at most `wanted` bytes. If there is too little, it submits the
    // pending copies to make room.
    Result<VkDeviceSize> reserve(VkDeviceSize wanted, VkDeviceSize unit);
    Status start();
    // Moves all mips to TRANSFER_DST_OPTIMAL.
    Status startImage(const DeviceImage& target);
    Status copyRows(std::span<const std::uint8_t> texels, std::uint32_t texelBytes, const DeviceImage& target,
                    std::uint32_t mip);
    // Blits the mips after the first `given`, and makes all of them readable.
    void recordMips(const DeviceImage& target, std::uint32_t given);

    Context::State* context_;
    MemoryPool pool_;
    Buffer staging_;
    std::unique_ptr<CommandRunner> runner_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;  // null between recordings
    VkDeviceSize used_ = 0;
};

// Returns the bytes of an array of plain structures.
template <typename T>
std::span<const std::uint8_t> bytesOf(std::span<const T> elements) {
    return {reinterpret_cast<const std::uint8_t*>(elements.data()), elements.size_bytes()};
}

}  // namespace glint
