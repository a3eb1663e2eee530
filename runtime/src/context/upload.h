// Copies host data into device buffers and images, through staging memory.
#pragma once

#include "context/commands.h"
#include "context/resources.h"

#include <glint/scene_view.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace glint {

// A block of texels that is stored as a whole; a texel by itself is one, too.
struct TexelBlock {
    std::uint32_t width = 1;  // texels
    std::uint32_t height = 1;
    std::uint32_t bytes = 4;
};
inline TexelBlock blockOf(TexelFormat format) {
    const TexelFormatInfo& info = infoOf(format);
    return {info.blockWidth, info.blockHeight, info.blockBytes};
}

// Keeps copies and other commands in their order until they are recorded. The data is copied into staging
// memory at once.
class Uploader {
public:
    using Command = std::function<void(VkCommandBuffer)>;

    static constexpr VkDeviceSize kUnlimited = ~VkDeviceSize{0};

    // Commands wait for record(). Staging memory is from `pool`, which must outlive the uploader. If it would
    // have more than `mostStaged` bytes of it, it submits the commands that wait, and waits for the device.
    Uploader(Context::State& context, MemoryPool& pool, VkDeviceSize mostStaged = kUnlimited)
        : context_(&context), pool_(&pool), mostStaged_(mostStaged) {}

    // Queues a command. Everything that it refers to must stay until it is recorded.
    void add(Command command) {
        queued_.push_back(std::move(command));
    }
    // `target` needs VK_BUFFER_USAGE_TRANSFER_DST_BIT and room for offset + bytes.
    Status copyToBuffer(std::span<const std::uint8_t> bytes, const Buffer& target, VkDeviceSize offset = 0);
    // Fills the first mips of an undefined image with texels or blocks, each with its layers one after the
    // other. Blits each remaining mip from the one before, and leaves all of them in
    // SHADER_READ_ONLY_OPTIMAL. Requires at least one mip, and all of them for blocks. `target` needs
    // TRANSFER_DST usage, and TRANSFER_SRC usage if mips are blitted.
    Status copyToImage(std::span<const std::span<const std::uint8_t>> mips, const TexelBlock& block,
                       const DeviceImage& target);

    // These copy one mip part by part. The mip must be undefined before the first, and only the last leaves
    // it readable by shaders. Rows are of texels or blocks. Returns how many rows were copied: at least one,
    // and at most as many as `mostBytes` hold if these are more than a row.
    struct MipRows {
        const DeviceImage* target = nullptr;
        std::uint32_t mip = 0;
        std::uint32_t firstRow = 0;
        std::span<const std::uint8_t> texels;  // of the whole mip of one layer
        TexelBlock block{};
        std::uint32_t layer = 0;  // or slice of a 3D image
    };
    Result<std::uint32_t> copyMipRows(const MipRows& rows, VkDeviceSize mostBytes);
    // Submits the commands that wait, with a dependency that makes their results visible to all commands that
    // are submitted later, and waits for the device.
    Status finish();

    // Returns how many commands wait.
    std::size_t waiting() const {
        return queued_.size();
    }
    // Forgets the commands after the first `count`, whose targets are about to be destroyed.
    void forgetAfter(std::size_t count) {
        queued_.resize(count);
    }
    // Records the waiting commands. Returns the staging buffers that they read, which the caller must keep
    // until the device has completed them. The targets are then to be made visible to their readers.
    std::vector<Buffer> record(VkCommandBuffer commands);
    // The staging buffers of commands that wait.
    const std::vector<Buffer>& staging() const {
        return staging_;
    }

private:
    // Records the waiting commands, and begins with the first staging buffer again.
    void recordWaiting(VkCommandBuffer commands);
    // Makes a staging buffer with room for at least `unit` bytes the current one.
    Status nextStaging(VkDeviceSize wanted, VkDeviceSize unit);
    // Returns room for at least `unit` and at most `wanted` bytes in the current staging buffer.
    Result<VkDeviceSize> reserve(VkDeviceSize wanted, VkDeviceSize unit);
    void transition(const ImageTransition& transition);
    // Moves all mips to TRANSFER_DST_OPTIMAL.
    void startImage(const DeviceImage& target);
    // Copies rows [first, end) of texels or blocks of a mip in TRANSFER_DST_OPTIMAL.
    Status copyRows(const MipRows& rows, std::uint32_t first, std::uint32_t end);
    // Blits the mips after the first `given`, and makes all of them readable.
    void addMips(const DeviceImage& target, std::uint32_t given);

    Context::State* context_;
    MemoryPool* pool_;  // of staging memory
    VkDeviceSize mostStaged_;
    std::vector<Buffer> staging_;
    std::size_t current_ = 0;  // index of the staging buffer that is being filled
    VkDeviceSize used_ = 0;    // bytes of it
    VkDeviceSize staged_ = 0;  // bytes of all staging buffers
    std::vector<Command> queued_;
    std::unique_ptr<CommandRunner> runner_;  // null until something is submitted
};

// Copies that are recorded into a host's command buffer, with their staging memory.
struct StagedCopies {
    // `mostStaged` is as in Uploader.
    explicit StagedCopies(Context::State& contextState, VkDeviceSize mostStaged = Uploader::kUnlimited)
        : context(contextState),
          pool(contextState),
          uploader(std::make_unique<Uploader>(contextState, pool, mostStaged)) {}

    // Records the uploader's commands, and makes their results visible to all later commands.
    void record(VkCommandBuffer commands, std::uint64_t frameNumber);

    Context::State& context;
    MemoryPool pool;                     // of the staging memory. Members are destroyed in reverse order.
    std::vector<Buffer> kept;            // staging memory, and what else the commands need
    std::unique_ptr<Uploader> uploader;  // all commands, in their order
    std::uint64_t frame = 0;             // frame of the commands
};

// Returns the bytes of an array of plain structures.
template <typename T>
std::span<const std::uint8_t> bytesOf(std::span<const T> elements) {
    return {reinterpret_cast<const std::uint8_t*>(elements.data()), elements.size_bytes()};
}

}  // namespace glint
