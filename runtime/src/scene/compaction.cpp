// Compaction: copies of the BLASes, and the TLAS over them.
#include "context/commands.h"
#include "context/parallel.h"
#include "context/vulkan_table.h"
#include "scene/scene_store.h"

#include <unordered_map>
#include <utility>

namespace glint {
namespace {

// A structure of the scene with its copy. The copy has the place of the structure when this is recorded.
struct Replacement {
    AccelerationStructure* structure = nullptr;
    AccelerationStructure copy;
};

// Returns no value if the device has not written the sizes yet.
Result<std::optional<std::vector<VkDeviceSize>>> readSizes(const GpuScene::State& state) {
    const Compaction& compaction = *state.compaction;
    std::vector<VkDeviceSize> sizes(compaction.parts.size());
    const VkResult result = state.context.vk.GetQueryPoolResults(
        state.context.handles.device, compaction.sizes.get(), 0, static_cast<std::uint32_t>(sizes.size()),
        sizes.size() * sizeof(VkDeviceSize), sizes.data(), sizeof(VkDeviceSize), VK_QUERY_RESULT_64_BIT);
    if (result == VK_NOT_READY) {
        return std::optional<std::vector<VkDeviceSize>>();
    }
    GLINT_TRY_DO(statusOf("vkGetQueryPoolResults", result));
    return std::optional(std::move(sizes));
}

Result<std::vector<Replacement>> makeCopies(GpuScene::State& state, std::span<const VkDeviceSize> sizes) {
    std::vector<Replacement> replacements;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        AccelerationStructure* const structure = structureAt(*state.store, state.compaction->parts[i]);
        if (structure == nullptr) {
            continue;  // edits have removed it
        }
        GLINT_TRY(auto copy, createStructure(state.context, state.pool, sizes[i],
                                             VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR));
        replacements.push_back({structure, std::move(copy)});
    }
    return replacements;
}

using Pair = std::pair<VkAccelerationStructureKHR, VkAccelerationStructureKHR>;

void recordCompactCopies(const Context::State& context, VkCommandBuffer commands,
                         std::span<const Pair> pairs) {
    for (const auto& [from, to] : pairs) {
        VkCopyAccelerationStructureInfoKHR copy{
            .sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR,
            .src = from,
            .dst = to,
            .mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR};
        context.vk.CmdCopyAccelerationStructureKHR(commands, &copy);
    }
}

// Queues the copies, puts them into their places, and lets the next recording build the TLAS over them.
void exchange(GpuScene::State& state, std::vector<Replacement>& replacements) {
    SceneStore& store = *state.store;
    std::vector<Pair> pairs;
    std::unordered_map<VkDeviceAddress, VkDeviceAddress> moved;
    std::uint64_t& bytes = state.statistics.blasBytes;
    for (Replacement& replacement : replacements) {
        pairs.emplace_back(replacement.structure->handle.get(), replacement.copy.handle.get());
        moved.emplace(replacement.structure->address, replacement.copy.address);
        bytes = bytes + replacement.copy.buffer.bytes - replacement.structure->buffer.bytes;
        state.compaction->replaced.push_back(
            std::exchange(*replacement.structure, std::move(replacement.copy)));
    }
    store.uploader->add([&context = state.context, pairs = std::move(pairs)](VkCommandBuffer commands) {
        recordCompactCopies(context, commands, pairs);
    });
    store.topLevel.moveBlases(moved);
    state.compaction->queued = true;
}

}  // namespace

Result<bool> GpuScene::recordCompaction(VkCommandBuffer commands, std::uint64_t frame) try {
    State& state = *state_;
    if (!state.compaction || state.upload || state.compaction->frame) {
        return false;
    }
    if (!state.compaction->queued) {
        GLINT_TRY(const auto sizes, readSizes(state));
        if (!sizes) {
            return false;
        }
        GLINT_TRY(auto replacements, makeCopies(state, *sizes));
        exchange(state, replacements);
    }
    GLINT_TRY_DO(recordChanges(*state.store, commands, frame));
    state.compaction->frame = frame;
    return true;
}
GLINT_CATCH

void completeCompaction(GpuScene::State& state, std::uint64_t frame) {
    if (state.compaction && state.compaction->frame && *state.compaction->frame <= frame) {
        state.compaction.reset();
    }
}

}  // namespace glint
