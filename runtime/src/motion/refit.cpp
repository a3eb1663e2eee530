#include "motion/refit.h"

#include "context/commands.h"
#include "context/memory_report.h"

#include <algorithm>

namespace glint {
namespace {

// The size of shared scratch, unless a single build needs more.
constexpr VkDeviceSize kScratchBytes = VkDeviceSize{64} << 20;

// After it, scratch is free again and the built structures may be read.
constexpr MemoryDependency kBuildToRefit{
    VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
    VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR | VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR,
    VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
    VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR | VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR};

VkDeviceSize scratchOf(const BlasBuild& build) {
    return std::max(build.scratchBytes, build.updateScratchBytes);
}

}  // namespace

Result<RefittedBlases> RefittedBlases::create(Context::State& context, MemoryPool& pool,
                                              std::span<const BlasInput> inputs) {
    RefittedBlases blases(context);
    VkDeviceSize all = 0;
    VkDeviceSize largest = 0;
    for (const BlasInput& input : inputs) {
        BlasBuild build = describeBuild(context, input);
        GLINT_TRY(auto structure, createStructure(context, pool, build.structureBytes,
                                                  VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR));
        build.info.dstAccelerationStructure = structure.handle.get();
        all += scratchOf(build);
        largest = std::max(largest, scratchOf(build));
        blases.structures_.push_back(std::move(structure));
        blases.builds_.push_back(std::move(build));
    }
    blases.scratchBytes_ = std::max(largest, std::min(all, kScratchBytes));
    GLINT_TRY(blases.scratch_, createScratch(context, pool, blases.scratchBytes_));
    return blases;
}

void RefittedBlases::record(VkCommandBuffer commands, std::span<const BuildAction> actions) const {
    std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
    std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
    VkDeviceSize used = 0;
    bool isFirst = true;
    const auto flush = [&] {
        if (infos.empty()) {
            return;
        }
        if (!isFirst) {
            recordDependency(*context_, commands, kBuildToRefit);
        }
        context_->vk.CmdBuildAccelerationStructuresKHR(commands, static_cast<std::uint32_t>(infos.size()),
                                                       infos.data(), ranges.data());
        infos.clear();
        ranges.clear();
        used = 0;
        isFirst = false;
    };
    for (std::size_t i = 0; i < builds_.size(); ++i) {
        if (actions[i] == BuildAction::Keep) {
            continue;
        }
        const BlasBuild& build = builds_[i];
        if (used + scratchOf(build) > scratchBytes_) {
            flush();
        }
        VkAccelerationStructureBuildGeometryInfoKHR info = build.info;
        info.scratchData.deviceAddress = scratch_.address + used;
        if (actions[i] == BuildAction::Refit) {
            info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
            info.srcAccelerationStructure = info.dstAccelerationStructure;
        }
        infos.push_back(info);
        ranges.push_back(build.ranges.data());
        used += scratchOf(build);
    }
    flush();
}

VkDeviceSize RefittedBlases::bytes() const {
    VkDeviceSize bytes = 0;
    for (const BlasBuild& build : builds_) {
        bytes += build.structureBytes;
    }
    return bytes;
}

void RefittedBlases::addMemory(std::vector<MemoryItem>& items) const {
    for (const AccelerationStructure& structure : structures_) {
        addTo(items, "refitted bottom levels", structure.buffer);
    }
    addTo(items, "scratch of structures", scratch_.buffer);
}

}  // namespace glint
