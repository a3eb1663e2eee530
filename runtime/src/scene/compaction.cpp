// Compaction: copies of the BLASes, and the TLAS over them.
#include "context/commands.h"
#include "context/vulkan_table.h"
#include "scene/gpu_scene_state.h"
#include "scene/scene_editor.h"
#include "scene/scene_motion.h"
#include "scene/scene_upload.h"

#include <map>
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
    std::vector<VkDeviceSize> sizes(compaction.count);
    const VkResult result = state.context.vk.GetQueryPoolResults(
        state.context.handles.device, compaction.sizes.get(), 0, compaction.count,
        sizes.size() * sizeof(VkDeviceSize), sizes.data(), sizeof(VkDeviceSize), VK_QUERY_RESULT_64_BIT);
    if (result == VK_NOT_READY) {
        return std::optional<std::vector<VkDeviceSize>>();
    }
    if (result != VK_SUCCESS) {
        return vulkanError("vkGetQueryPoolResults", result);
    }
    return std::optional(std::move(sizes));
}

// The structures by the numbers of their sizes. Those that edits have removed are null.
std::vector<AccelerationStructure*> structuresOf(GpuScene::State& state) {
    std::vector<AccelerationStructure*> structures;
    if (state.editor == nullptr) {
        for (AccelerationStructure& blas : state.blases) {
            structures.push_back(&blas);
        }
        return structures;
    }
    for (const PartOfMesh& place : state.compaction->parts) {
        EditedMesh* const mesh = state.editor->state().meshes.find(place.mesh);
        structures.push_back(mesh == nullptr ? nullptr
                                             : &mesh->primitives[place.primitive].parts[place.part].blas);
    }
    return structures;
}

void discardCopies(GpuScene::State& state, std::vector<Replacement>& replacements) {
    for (Replacement& replacement : replacements) {
        discard(state.pool, std::move(replacement.copy));
    }
}

Result<std::vector<Replacement>> makeCopies(GpuScene::State& state, std::span<const VkDeviceSize> sizes) {
    const std::vector<AccelerationStructure*> structures = structuresOf(state);
    std::vector<Replacement> replacements;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        if (structures[i] == nullptr) {
            continue;
        }
        Result<AccelerationStructure> copy = createStructure(state.context, state.pool, sizes[i],
                                                             VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR);
        if (!copy) {
            discardCopies(state, replacements);
            return copy.error();
        }
        replacements.push_back({structures[i], std::move(*copy)});
    }
    return replacements;
}

void recordCompactCopies(
    const Context::State& context, VkCommandBuffer commands,
    std::span<const std::pair<VkAccelerationStructureKHR, VkAccelerationStructureKHR>> pairs) {
    for (const auto& [from, to] : pairs) {
        VkCopyAccelerationStructureInfoKHR copy{};
        copy.sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR;
        copy.src = from;
        copy.dst = to;
        copy.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR;
        context.vk.CmdCopyAccelerationStructureKHR(commands, &copy);
    }
}

using Pairs = std::vector<std::pair<VkAccelerationStructureKHR, VkAccelerationStructureKHR>>;

Pairs pairsOf(std::span<const Replacement> replacements) {
    Pairs pairs;
    for (const Replacement& replacement : replacements) {
        pairs.emplace_back(replacement.structure->handle.get(), replacement.copy.handle.get());
    }
    return pairs;
}

// Puts the copies into their places. Returns the structures that they replace.
std::vector<AccelerationStructure> exchange(GpuScene::State& state, std::vector<Replacement>& replacements) {
    std::vector<AccelerationStructure> replaced;
    std::uint64_t& bytes = state.statistics.blasBytes;
    for (Replacement& replacement : replacements) {
        bytes = bytes + replacement.copy.buffer.bytes - replacement.structure->buffer.bytes;
        replaced.push_back(std::exchange(*replacement.structure, std::move(replacement.copy)));
    }
    return replaced;
}

// Records the copies, and a build of the TLAS over them in the memory of the present one.
Status recordStill(GpuScene::State& state, VkCommandBuffer commands, std::vector<Replacement> replacements) {
    Compaction& compaction = *state.compaction;
    std::map<VkDeviceAddress, VkDeviceAddress> moved;
    for (const Replacement& replacement : replacements) {
        moved[replacement.structure->address] = replacement.copy.address;
    }
    const auto follow = [&](VkDeviceAddress address) {
        const auto found = moved.find(address);
        return found == moved.end() ? address : found->second;
    };
    std::vector<VkAccelerationStructureInstanceKHR> placed =
        state.motion ? state.motion->placed : compaction.placed;
    for (VkAccelerationStructureInstanceKHR& instance : placed) {
        instance.accelerationStructureReference = follow(instance.accelerationStructureReference);
    }
    const Result<PreparedTlas> tlas =
        prepareTlas(state.context, compaction.pool, placed, state.motion != nullptr, compaction.kept);
    if (!tlas) {
        discardCopies(state, replacements);
        return tlas.error();
    }
    recordDependency(state.context, commands, kAllToAll);
    recordCompactCopies(state.context, commands, pairsOf(replacements));
    recordDependency(state.context, commands, kAllToAll);
    recordTlasBuild(state.context, commands, *tlas, state.tlas.handle.get());
    recordDependency(state.context, commands, kAllToAll);
    compaction.replaced = exchange(state, replacements);
    for (VkDeviceAddress& address : state.partBlases) {
        address = follow(address);
    }
    if (state.motion) {
        state.motion->placed = std::move(placed);
    }
    return okStatus();
}

// Gives the copies to the editor, whose next recording makes them and builds the TLAS.
void queueInEditor(GpuScene::State& state, std::vector<Replacement> replacements) {
    SceneEditor::State& editor = state.editor->state();
    editor.uploader->add([&context = state.context, pairs = pairsOf(replacements)](VkCommandBuffer commands) {
        recordCompactCopies(context, commands, pairs);
    });
    for (AccelerationStructure& structure : exchange(state, replacements)) {
        editor.retired.add(std::move(structure));
    }
    editor.tlasDirty = true;
    state.compaction->queued = true;
}

}  // namespace

Result<bool> recordCompaction(GpuScene::State& state, VkCommandBuffer commands, std::uint64_t frame) {
    if (!state.compaction || state.upload || state.compaction->frame) {
        return false;
    }
    if (!state.compaction->queued) {
        GLINT_TRY(const auto sizes, readSizes(state));
        if (!sizes) {
            return false;
        }
        GLINT_TRY(auto replacements, makeCopies(state, *sizes));
        if (state.editor != nullptr) {
            queueInEditor(state, std::move(replacements));
        } else if (Status status = recordStill(state, commands, std::move(replacements)); !status) {
            return status.error();
        }
    }
    if (state.editor != nullptr) {
        GLINT_TRY_DO(state.editor->record(commands, frame));
    }
    state.compaction->frame = frame;
    return true;
}

void completeCompaction(GpuScene::State& state, std::uint64_t frame) {
    if (state.compaction && state.compaction->frame && *state.compaction->frame <= frame) {
        state.compaction.reset();
    }
}

}  // namespace glint
