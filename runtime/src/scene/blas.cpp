// Bottom levels: their sizes, their batches and their compaction.
#include "context/commands.h"
#include "context/timer.h"
#include "context/vulkan_error.h"
#include "scene/acceleration.h"
#include "scene/blas_build.h"

#include <algorithm>

namespace glint {
namespace {

// The memory that one batch may use in addition to the structures that stay: scratch, and structures before
// compaction.
constexpr VkDeviceSize kBatchScratchBytes = VkDeviceSize{64} << 20;
constexpr VkDeviceSize kBatchStructureBytes = VkDeviceSize{256} << 20;

constexpr MemoryDependency kBuildToBuild{VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                                         VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR,
                                         VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                                         VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR};
constexpr MemoryDependency kBuildToAll{VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                                       VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR,
                                       VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                       VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR};

// Builds one batch in transient memory, then makes its compacted copies.
class BatchBuilder {
public:
    BatchBuilder(Context::State& context, MemoryPool& pool, std::span<BlasBuild> builds)
        : context_(context), pool_(pool), builds_(builds), transient_(context) {}

    Status run(std::vector<AccelerationStructure>& compacted, BlasStatistics& statistics) {
        Result<CommandRunner> runner = CommandRunner::create(context_);
        if (!runner) {
            return runner.error();
        }
        if (Status status = prepare(); !status) {
            return status;
        }
        if (Status status = build(*runner, statistics); !status) {
            return status;
        }
        return compact(*runner, compacted, statistics);
    }

private:
    std::uint32_t count() const {
        return static_cast<std::uint32_t>(builds_.size());
    }

    Status prepare() {
        VkDeviceSize scratchBytes = 0;
        for (const BlasBuild& build : builds_) {
            scratchBytes += build.scratchBytes;
        }
        Result<Scratch> scratch = createScratch(context_, transient_, scratchBytes);
        if (!scratch) {
            return scratch.error();
        }
        scratch_ = std::move(*scratch);
        VkDeviceAddress address = scratch_.address;
        for (BlasBuild& build : builds_) {
            Result<AccelerationStructure> structure = createStructure(
                context_, transient_, build.structureBytes, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR);
            if (!structure) {
                return structure.error();
            }
            build.info.dstAccelerationStructure = structure->handle.get();
            build.info.scratchData.deviceAddress = address;
            address += build.scratchBytes;
            handles_.push_back(structure->handle.get());
            structures_.push_back(std::move(*structure));
        }
        VkQueryPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        info.queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
        info.queryCount = count();
        VkQueryPool queries = VK_NULL_HANDLE;
        const VkResult result =
            context_.vk.CreateQueryPool(context_.handles.device, &info, nullptr, &queries);
        if (result != VK_SUCCESS) {
            return vulkanError("vkCreateQueryPool", result);
        }
        queries_ = UniqueQueryPool(context_, queries);
        context_.vk.ResetQueryPool(context_.handles.device, queries, 0, count());
        return okStatus();
    }

    Status build(CommandRunner& runner, BlasStatistics& statistics) {
        Result<Timer> timer = Timer::create(context_, 1);
        if (!timer) {
            return timer.error();
        }
        Result<VkCommandBuffer> commands = runner.begin();
        if (!commands) {
            return commands.error();
        }
        std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
        std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
        for (const BlasBuild& build : builds_) {
            infos.push_back(build.info);
            ranges.push_back(build.ranges.data());
            statistics.uncompactedBytes += build.structureBytes;
        }
        timer->recordBegin(*commands, 0);
        context_.vk.CmdBuildAccelerationStructuresKHR(*commands, count(), infos.data(), ranges.data());
        timer->recordEnd(*commands, 0);
        recordDependency(context_, *commands, kBuildToBuild);
        context_.vk.CmdWriteAccelerationStructuresPropertiesKHR(
            *commands, count(), handles_.data(), VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR,
            queries_.get(), 0);
        if (Status status = runner.submitAndWait(); !status) {
            return status;
        }
        if (timer->available()) {
            Result<std::vector<double>> milliseconds = timer->read(1);
            if (!milliseconds) {
                return milliseconds.error();
            }
            statistics.buildMs += milliseconds->front();
        }
        return okStatus();
    }

    Status compact(CommandRunner& runner, std::vector<AccelerationStructure>& compacted,
                   BlasStatistics& statistics) {
        std::vector<VkDeviceSize> sizes(builds_.size());
        const VkResult result = context_.vk.GetQueryPoolResults(
            context_.handles.device, queries_.get(), 0, count(), sizes.size() * sizeof(VkDeviceSize),
            sizes.data(), sizeof(VkDeviceSize), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        if (result != VK_SUCCESS) {
            return vulkanError("vkGetQueryPoolResults", result);
        }
        Result<VkCommandBuffer> commands = runner.begin();
        if (!commands) {
            return commands.error();
        }
        recordDependency(context_, *commands, kBuildToBuild);
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            Result<AccelerationStructure> structure =
                createStructure(context_, pool_, sizes[i], VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR);
            if (!structure) {
                return structure.error();
            }
            VkCopyAccelerationStructureInfoKHR copy{};
            copy.sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR;
            copy.src = handles_[i];
            copy.dst = structure->handle.get();
            copy.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR;
            context_.vk.CmdCopyAccelerationStructureKHR(*commands, &copy);
            statistics.bytes += sizes[i];
            compacted.push_back(std::move(*structure));
        }
        recordDependency(context_, *commands, kBuildToAll);
        return runner.submitAndWait();
    }

    Context::State& context_;
    MemoryPool& pool_;
    std::span<BlasBuild> builds_;
    MemoryPool transient_;
    Scratch scratch_;
    std::vector<AccelerationStructure> structures_;
    std::vector<VkAccelerationStructureKHR> handles_;
    UniqueQueryPool queries_;
};

// Returns the end of the batch that starts at `first`. A batch has at least one build.
std::size_t batchEnd(const Context::State& context, std::span<const BlasBuild> builds, std::size_t first) {
    // Some drivers bind scratch as a storage buffer, so it must respect the limit of those.
    const VkDeviceSize scratchLimit =
        std::min<VkDeviceSize>(kBatchScratchBytes, context.limits.core.maxStorageBufferRange);
    VkDeviceSize scratch = builds[first].scratchBytes;
    VkDeviceSize structures = builds[first].structureBytes;
    std::size_t end = first + 1;
    while (end < builds.size() && scratch + builds[end].scratchBytes <= scratchLimit &&
           structures + builds[end].structureBytes <= kBatchStructureBytes) {
        scratch += builds[end].scratchBytes;
        structures += builds[end].structureBytes;
        ++end;
    }
    return end;
}

}  // namespace

BlasCapacity blasCapacity(const Context::State& context) {
    // No mesh needs more in one piece, and it is few enough that no driver's 32-bit sum of bytes overflows.
    constexpr std::uint64_t kMostTriangles = std::uint64_t{1} << 24;
    const VkPhysicalDeviceAccelerationStructurePropertiesKHR& limits = context.limits.accelerationStructure;
    const VkDeviceSize range = context.limits.core.maxStorageBufferRange;
    BlasCapacity capacity{std::clamp<std::uint64_t>(limits.maxPrimitiveCount, 1, kMostTriangles),
                          std::max<std::uint64_t>(limits.maxGeometryCount, 1)};
    while (capacity.triangles > 1) {
        const auto triangles = static_cast<std::uint32_t>(capacity.triangles);
        const BlasInput probe{{{0, 0, 3 * triangles, triangles, true}}};
        const BlasBuild build = describeBuild(context, probe);
        if (std::max(build.structureBytes, build.scratchBytes) <= range) {
            break;
        }
        capacity.triangles /= 2;
    }
    return capacity;
}

Result<std::vector<AccelerationStructure>> buildBlases(Context::State& context, MemoryPool& pool,
                                                       std::span<const BlasInput> inputs,
                                                       BlasStatistics& statistics) {
    std::vector<BlasBuild> builds;
    builds.reserve(inputs.size());
    for (const BlasInput& input : inputs) {
        builds.push_back(describeBuild(context, input));
    }
    std::vector<AccelerationStructure> structures;
    structures.reserve(inputs.size());
    std::size_t first = 0;
    while (first < builds.size()) {
        const std::size_t end = batchEnd(context, builds, first);
        BatchBuilder batch(context, pool, std::span(builds).subspan(first, end - first));
        if (Status status = batch.run(structures, statistics); !status) {
            return status.error();
        }
        first = end;
    }
    return structures;
}

}  // namespace glint
