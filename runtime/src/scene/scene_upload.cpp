// The part of an upload that scenes do not have later: opacity micromaps.
#include "scene/scene_upload.h"

#include "context/vulkan_table.h"
#include "data/acceleration.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace glint {
namespace {

// VkMicromapBuildInfoEXT requires this alignment (VUID-vkCmdBuildMicromapsEXT-pInfos-07515).
constexpr VkDeviceSize kInputAlignment = 256;

constexpr MemoryDependency kMicromapToStructures{
    VK_PIPELINE_STAGE_2_MICROMAP_BUILD_BIT_EXT, VK_ACCESS_2_MICROMAP_WRITE_BIT_EXT,
    VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR | VK_PIPELINE_STAGE_2_MICROMAP_BUILD_BIT_EXT,
    VK_ACCESS_2_MICROMAP_READ_BIT_EXT};

Result<AlignedBuffer> uploadInput(Context::State& context, MemoryPool& pool, Uploader& uploader,
                                  std::span<const std::uint8_t> bytes) {
    GLINT_TRY(auto input, createAligned(context, pool, bytes.size(), kInputAlignment,
                                        VK_BUFFER_USAGE_MICROMAP_BUILD_INPUT_READ_ONLY_BIT_EXT |
                                            VK_BUFFER_USAGE_TRANSFER_DST_BIT));
    GLINT_TRY_DO(uploader.copyToBuffer(bytes, input.buffer, input.offset()));
    return input;
}

// The resources of one micromap's build, which must stay until it is done.
struct PendingMicromap {
    AlignedBuffer data;
    AlignedBuffer records;
    AlignedBuffer scratch;
    std::vector<VkMicromapUsageEXT> usages;
    VkMicromapBuildInfoEXT info{};
};

class MicromapBuilder {
public:
    MicromapBuilder(SceneUpload& upload, MemoryPool& pool)
        : upload_(upload), context_(upload.context), pool_(pool) {}

    Status add(const opacity::MicromapArray& array, DeviceMicromap& made) {
        Uploader& uploader = *upload_.uploader;
        if (Status status = addIndices(array, uploader, made); !status || array.records.empty()) {
            return status;
        }
        PendingMicromap pending;
        GLINT_TRY(pending.data, uploadInput(context_, upload_.pool, uploader, array.data));
        GLINT_TRY(pending.records,
                  uploadInput(context_, upload_.pool, uploader, bytesOf(std::span(array.records))));
        pending.usages = array.usages;
        GLINT_TRY_DO(create(pending, made));
        upload_.keep(std::move(pending.data.buffer));
        upload_.keep(std::move(pending.records.buffer));
        upload_.keep(std::move(pending.scratch.buffer));
        pending_->push_back(std::move(pending));
        return okStatus();
    }

    // Queues the builds, after the copies.
    void build() {
        if (pending_->empty()) {
            return;
        }
        upload_.uploader->add([&context = context_, pending = pending_](VkCommandBuffer commands) {
            std::vector<VkMicromapBuildInfoEXT> infos;
            for (PendingMicromap& one : *pending) {
                one.info.pUsageCounts = one.usages.data();
                infos.push_back(one.info);
            }
            recordDependency(context, commands, kAllToAll);
            context.vk.CmdBuildMicromapsEXT(commands, static_cast<std::uint32_t>(infos.size()), infos.data());
            recordDependency(context, commands, kMicromapToStructures);
        });
    }

private:
    Status addIndices(const opacity::MicromapArray& array, Uploader& uploader, DeviceMicromap& made) {
        const std::span<const std::uint8_t> bytes = bytesOf(std::span(array.indices));
        GLINT_TRY(made.indices,
                  createBuffer(context_, pool_, bytes.size(),
                               VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
                                   VK_BUFFER_USAGE_MICROMAP_BUILD_INPUT_READ_ONLY_BIT_EXT |
                                   VK_BUFFER_USAGE_TRANSFER_DST_BIT));
        made.usages = opacity::usagesOf(array);
        made.bytes = bytes.size();
        return uploader.copyToBuffer(bytes, made.indices);
    }

    Status create(PendingMicromap& pending, DeviceMicromap& made) {
        VkMicromapBuildInfoEXT& info = pending.info;
        info.sType = VK_STRUCTURE_TYPE_MICROMAP_BUILD_INFO_EXT;
        info.type = VK_MICROMAP_TYPE_OPACITY_MICROMAP_EXT;
        info.flags = VK_BUILD_MICROMAP_PREFER_FAST_TRACE_BIT_EXT;
        info.mode = VK_BUILD_MICROMAP_MODE_BUILD_EXT;
        info.usageCountsCount = static_cast<std::uint32_t>(pending.usages.size());
        info.pUsageCounts = pending.usages.data();
        info.data.deviceAddress = pending.data.address;
        info.triangleArray.deviceAddress = pending.records.address;
        info.triangleArrayStride = sizeof(opacity::MicromapRecord);
        VkMicromapBuildSizesInfoEXT sizes{.sType = VK_STRUCTURE_TYPE_MICROMAP_BUILD_SIZES_INFO_EXT};
        context_.vk.GetMicromapBuildSizesEXT(context_.handles.device,
                                             VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &sizes);
        GLINT_TRY(made.buffer, createBuffer(context_, pool_, sizes.micromapSize,
                                            VK_BUFFER_USAGE_MICROMAP_STORAGE_BIT_EXT));
        made.bytes += sizes.micromapSize;
        const VkMicromapCreateInfoEXT creation{.sType = VK_STRUCTURE_TYPE_MICROMAP_CREATE_INFO_EXT,
                                               .buffer = made.buffer.handle.get(),
                                               .size = sizes.micromapSize,
                                               .type = VK_MICROMAP_TYPE_OPACITY_MICROMAP_EXT};
        GLINT_TRY(made.handle, createHandle<UniqueMicromap>(context_, context_.vk.CreateMicromapEXT,
                                                            "vkCreateMicromapEXT", creation));
        info.dstMicromap = made.handle.get();
        GLINT_TRY(pending.scratch, createScratch(context_, upload_.pool, sizes.buildScratchSize));
        info.scratchData.deviceAddress = pending.scratch.address;
        return okStatus();
    }

    SceneUpload& upload_;
    Context::State& context_;
    MemoryPool& pool_;
    // The upload owns its buffers.
    std::shared_ptr<std::vector<PendingMicromap>> pending_ = std::make_shared<std::vector<PendingMicromap>>();
};

}  // namespace

std::uint32_t micromapLevel(const Context::State& context) {
    const VkPhysicalDeviceOpacityMicromapPropertiesEXT& limits = context.limits.opacityMicromap;
    return std::min({limits.maxOpacity2StateSubdivisionLevel, limits.maxOpacity4StateSubdivisionLevel,
                     opacity::kMaxLevel});
}

Result<std::vector<DeviceMicromap>> addMicromaps(SceneUpload& upload, MemoryPool& pool,
                                                 std::span<const opacity::MicromapArray> arrays) {
    std::vector<DeviceMicromap> made(arrays.size());
    MicromapBuilder builder(upload, pool);
    for (std::size_t i = 0; i < arrays.size(); ++i) {
        GLINT_TRY_DO(builder.add(arrays[i], made[i]));
    }
    builder.build();
    return made;
}

}  // namespace glint
