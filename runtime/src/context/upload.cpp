#include "context/upload.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace glint {
namespace {

// The largest staging buffer. It is small enough for every host-visible heap, and holds 32 rows of the
// largest image that a device may have (65536 pixels of 8 bytes).
constexpr VkDeviceSize kStagingBytes = VkDeviceSize{16} << 20;
// Copies start at multiples of a texel, and of the alignment that devices prefer.
constexpr VkDeviceSize kStagingAlignment = 256;
// The size of the first staging buffer. Each next one is as large as all before it together.
constexpr VkDeviceSize kFirstStagingBytes = VkDeviceSize{64} << 10;

constexpr VkPipelineStageFlags2 kCopyStages = VK_PIPELINE_STAGE_2_COPY_BIT;
constexpr VkPipelineStageFlags2 kBlitStages = VK_PIPELINE_STAGE_2_BLIT_BIT;
constexpr MemoryDependency kToShaders{kCopyStages | kBlitStages, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                      VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                      VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};

}  // namespace

void Uploader::recordWaiting(VkCommandBuffer commands) {
    for (const Command& command : queued_) {
        command(commands);
    }
    queued_.clear();
    current_ = 0;
    used_ = 0;
}

std::vector<Buffer> Uploader::record(VkCommandBuffer commands) {
    recordWaiting(commands);
    staged_ = 0;
    return std::exchange(staging_, {});
}

Status Uploader::finish() {
    if (queued_.empty()) {
        return okStatus();
    }
    if (!runner_) {
        GLINT_TRY(auto runner, CommandRunner::create(*context_));
        runner_ = std::make_unique<CommandRunner>(std::move(runner));
    }
    GLINT_TRY(const auto commands, runner_->begin());
    recordWaiting(commands);
    recordDependency(*context_, commands, kAllToAll);
    return runner_->submitAndWait();
}

Status Uploader::nextStaging(VkDeviceSize wanted, VkDeviceSize unit) {
    used_ = 0;
    const auto fits = [&](const Buffer& staging) { return staging.bytes >= unit; };
    // After a submission the buffers that are there are filled again.
    const std::size_t filled = std::min(current_ + 1, staging_.size());
    auto next = std::find_if(staging_.begin() + static_cast<std::ptrdiff_t>(filled), staging_.end(), fits);
    const VkDeviceSize size = std::clamp(std::max(wanted, staged_), kFirstStagingBytes, kStagingBytes);
    if (next == staging_.end() && !queued_.empty() && staged_ + size > mostStaged_) {
        GLINT_TRY_DO(finish());
        next = std::ranges::find_if(staging_, fits);
    }
    if (next != staging_.end()) {
        current_ = static_cast<std::size_t>(next - staging_.begin());
        return okStatus();
    }
    GLINT_TRY(auto staging,
              createBuffer(*context_, *pool_, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload));
    staged_ += size;
    staging_.push_back(std::move(staging));
    current_ = staging_.size() - 1;
    return okStatus();
}

Result<VkDeviceSize> Uploader::reserve(VkDeviceSize wanted, VkDeviceSize unit) {
    used_ = alignUp(used_, kStagingAlignment);
    if (staging_.empty() || used_ + unit > staging_[current_].bytes) {
        GLINT_TRY_DO(nextStaging(wanted, unit));
    }
    const VkDeviceSize room = (staging_[current_].bytes - used_) / unit * unit;
    return std::min(wanted, room);
}

Status Uploader::copyToBuffer(std::span<const std::uint8_t> bytes, const Buffer& target,
                              VkDeviceSize offset) {
    while (!bytes.empty()) {
        GLINT_TRY(auto room, reserve(bytes.size(), 1));
        std::memcpy(staging_[current_].mapped + used_, bytes.data(), room);
        add([&vk = context_->vk, region = VkBufferCopy{used_, offset, room},
             from = staging_[current_].handle.get(), to = target.handle.get()](VkCommandBuffer commands) {
            vk.CmdCopyBuffer(commands, from, to, 1, &region);
        });
        used_ += room;
        offset += room;
        bytes = bytes.subspan(room);
    }
    return okStatus();
}

void Uploader::transition(const ImageTransition& transition) {
    add([context = context_, transition](VkCommandBuffer commands) {
        recordTransition(*context, commands, transition);
    });
}

void Uploader::startImage(const DeviceImage& target) {
    transition({target.handle.get(),
                VK_IMAGE_LAYOUT_UNDEFINED,
                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                {VK_PIPELINE_STAGE_2_NONE, 0, kCopyStages | kBlitStages, VK_ACCESS_2_TRANSFER_WRITE_BIT}});
}

namespace {

bool isVolume(const DeviceImage& image) {
    return image.dimension == package::TextureEntry::Dimension::Volume;
}

// The size of a mip in rows of texels or blocks, and of a row in bytes.
struct RowSize {
    std::uint32_t rows = 0;
    VkDeviceSize bytes = 0;
};

RowSize rowSizeOf(const Uploader::MipRows& rows) {
    const std::uint32_t width = sizeAtLevel(rows.target->extent.width, rows.mip);
    const std::uint32_t height = sizeAtLevel(rows.target->extent.height, rows.mip);
    return {blocksAcross(height, rows.block.height),
            VkDeviceSize{rows.block.bytes} * blocksAcross(width, rows.block.width)};
}

}  // namespace

Status Uploader::copyRows(const MipRows& rows, std::uint32_t first, std::uint32_t end) {
    const DeviceImage& target = *rows.target;
    const std::uint32_t width = sizeAtLevel(target.extent.width, rows.mip);
    const std::uint32_t height = sizeAtLevel(target.extent.height, rows.mip);
    const VkDeviceSize rowBytes = rowSizeOf(rows).bytes;
    while (first < end) {
        GLINT_TRY(auto room, reserve(rowBytes * (end - first), rowBytes));
        const auto count = static_cast<std::uint32_t>(room / rowBytes);
        std::memcpy(staging_[current_].mapped + used_, rows.texels.data() + first * rowBytes, room);
        const std::uint32_t top = first * rows.block.height;
        VkBufferImageCopy region{
            .bufferOffset = used_,
            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, rows.mip, isVolume(target) ? 0 : rows.layer, 1},
            .imageOffset = {0, static_cast<std::int32_t>(top),
                            isVolume(target) ? static_cast<std::int32_t>(rows.layer) : 0},
            .imageExtent = {width, std::min(count * rows.block.height, height - top), 1}};
        add([&vk = context_->vk, region, from = staging_[current_].handle.get(),
             to = target.handle.get()](VkCommandBuffer commands) {
            vk.CmdCopyBufferToImage(commands, from, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        });
        used_ += room;
        first += count;
    }
    return okStatus();
}

Status Uploader::copyToImage(std::span<const std::span<const std::uint8_t>> mips, const TexelBlock& block,
                             const DeviceImage& target) {
    startImage(target);
    for (std::uint32_t mip = 0; mip < mips.size(); ++mip) {
        const std::uint32_t layers = isVolume(target) ? sizeAtLevel(target.layers, mip) : target.layers;
        const std::size_t bytes = mips[mip].size() / layers;
        for (std::uint32_t layer = 0; layer < layers; ++layer) {
            const MipRows rows{&target, mip, 0, mips[mip].subspan(layer * bytes, bytes), block, layer};
            GLINT_TRY_DO(copyRows(rows, 0, rowSizeOf(rows).rows));
        }
    }
    addMips(target, static_cast<std::uint32_t>(mips.size()));
    return okStatus();
}

Result<std::uint32_t> Uploader::copyMipRows(const MipRows& rows, VkDeviceSize mostBytes) {
    const RowSize size = rowSizeOf(rows);
    const auto room = static_cast<std::uint32_t>(
        std::clamp<VkDeviceSize>(mostBytes / size.bytes, 1, size.rows - rows.firstRow));
    if (rows.firstRow == 0) {
        transition({rows.target->handle.get(),
                    VK_IMAGE_LAYOUT_UNDEFINED,
                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                    {VK_PIPELINE_STAGE_2_NONE, 0, kCopyStages, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                    rows.mip,
                    1});
    }
    GLINT_TRY_DO(copyRows(rows, rows.firstRow, rows.firstRow + room));
    if (rows.firstRow + room == size.rows) {
        transition({rows.target->handle.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kToShaders, rows.mip, 1});
    }
    return room;
}

void Uploader::addMips(const DeviceImage& target, std::uint32_t given) {
    const VkImage image = target.handle.get();
    const std::uint32_t last = given - 1;
    auto width = static_cast<std::int32_t>(std::max(target.extent.width >> last, 1U));
    auto height = static_cast<std::int32_t>(std::max(target.extent.height >> last, 1U));
    auto depth = isVolume(target) ? static_cast<std::int32_t>(std::max(target.layers >> last, 1U)) : 1;
    const std::uint32_t layers = isVolume(target) ? 1 : target.layers;
    for (std::uint32_t mip = given; mip < target.mips; ++mip) {
        transition({image,
                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                    {kCopyStages | kBlitStages, VK_ACCESS_2_TRANSFER_WRITE_BIT, kBlitStages,
                     VK_ACCESS_2_TRANSFER_READ_BIT},
                    mip - 1,
                    1});
        VkImageBlit region{.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 0, layers}};
        region.srcOffsets[1] = {width, height, depth};
        width = std::max(width / 2, 1);
        height = std::max(height / 2, 1);
        depth = std::max(depth / 2, 1);
        region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, layers};
        region.dstOffsets[1] = {width, height, depth};
        add([&vk = context_->vk, image, region](VkCommandBuffer commands) {
            vk.CmdBlitImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
        });
    }
    const auto addReadable = [&](VkImageLayout layout, std::uint32_t first, std::uint32_t count) {
        if (count > 0) {
            transition({image, layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kToShaders, first, count});
        }
    };
    // The mips that were blitted from have the source layout, and the others the target layout.
    addReadable(VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 0, last);
    addReadable(VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, last, target.mips - given);
    addReadable(VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, target.mips - 1, 1);
}

void StagedCopies::record(VkCommandBuffer commands, std::uint64_t frameNumber) {
    frame = frameNumber;
    kept = uploader->record(commands);
    recordDependency(context, commands, kAllToAll);
}

}  // namespace glint
