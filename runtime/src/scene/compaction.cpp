// Compaction: a BLAS is built at its full size. The size of its compacted copy is known when the device has
// built it, and a later recording makes the copy.
#include "context/commands.h"
#include "context/parallel.h"
#include "context/vulkan_table.h"
#include "scene/scene_store.h"

#include <optional>
#include <utility>

namespace glint {
namespace {

// Returns no value if the device has not written the sizes yet.
Result<std::optional<std::vector<VkDeviceSize>>> readSizes(const Context::State& context,
                                                           const Compaction& compaction) {
    std::vector<VkDeviceSize> sizes(compaction.parts.size());
    const VkResult result = context.vk.GetQueryPoolResults(
        context.handles.device, compaction.sizes.get(), 0, static_cast<std::uint32_t>(sizes.size()),
        sizes.size() * sizeof(VkDeviceSize), sizes.data(), sizeof(VkDeviceSize), VK_QUERY_RESULT_64_BIT);
    if (result == VK_NOT_READY) {
        return std::optional<std::vector<VkDeviceSize>>();
    }
    GLINT_TRY_DO(statusOf("vkGetQueryPoolResults", result));
    return std::optional(std::move(sizes));
}

// A structure of the scene with its copy.
struct Replacement {
    PartPlace place;
    AccelerationStructure* structure = nullptr;
    AccelerationStructure copy;
};

Result<std::vector<Replacement>> makeCopies(SceneStore& store, const Compaction& compaction,
                                            std::span<const VkDeviceSize> sizes) {
    std::vector<Replacement> replacements;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const auto& [place, built] = compaction.parts[i];
        AccelerationStructure* const structure = structureAt(store, place);
        if (structure == nullptr || structure->handle.get() != built) {
            continue;  // edits have removed it
        }
        GLINT_TRY(auto copy, createStructure(store.scene.context, store.scene.pool, sizes[i],
                                             VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR));
        replacements.push_back({place, structure, std::move(copy)});
    }
    return replacements;
}

// Queues the copies, puts them into the places of the structures, and lets the TLAS have them.
void exchange(SceneStore& store, std::vector<Replacement>& replacements) {
    std::vector<VkCopyAccelerationStructureInfoKHR> copies;
    std::set<std::uint32_t> meshes;
    std::uint64_t& bytes = store.scene.statistics.blasBytes;
    for (auto& [place, structure, copy] : replacements) {
        copies.push_back({.sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR,
                          .src = structure->handle.get(),
                          .dst = copy.handle.get(),
                          .mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR});
        bytes = bytes + copy.buffer.bytes - structure->buffer.bytes;
        store.retired.add(std::exchange(*structure, std::move(copy)));
        if (store.meshes.find(place.mesh) != nullptr) {
            meshes.insert(place.mesh.index);
        } else {
            placeParts(store, *store.instanceSlots.find(place.instance));
        }
    }
    for (const std::uint32_t mesh : meshes) {
        for (const std::uint32_t instance : store.meshes.at(mesh).instances) {
            placeParts(store, store.instanceSlots.at(instance));
        }
    }
    store.uploader->add(
        [&context = store.scene.context, copies = std::move(copies)](VkCommandBuffer commands) {
            for (const VkCopyAccelerationStructureInfoKHR& copy : copies) {
                context.vk.CmdCopyAccelerationStructureKHR(commands, &copy);
            }
        });
}

bool isBuilt(const SceneStore& store, const Compaction& compaction) {
    return store.completed && compaction.frame <= *store.completed;
}

}  // namespace

Status compactBuilt(SceneStore& store) {
    while (!store.compactions.empty() && isBuilt(store, store.compactions.front())) {
        const Compaction& compaction = store.compactions.front();
        GLINT_TRY(const auto sizes, readSizes(store.scene.context, compaction));
        if (!sizes) {
            break;
        }
        GLINT_TRY(auto replacements, makeCopies(store, compaction, *sizes));
        if (!replacements.empty()) {
            exchange(store, replacements);
            store.compacts = true;
        }
        store.compactions.pop_front();
    }
    return okStatus();
}

void completeFrames(SceneStore& store, std::uint64_t frame) {
    store.retired.complete(frame);
    store.completed = std::max(store.completed.value_or(frame), frame);
}

Result<bool> GpuScene::recordCompaction(VkCommandBuffer commands, std::uint64_t frame) try {
    if (state_->upload) {
        return false;
    }
    GLINT_TRY_DO(compactBuilt(*state_->store));
    if (!state_->store->compacts) {
        return false;
    }
    GLINT_TRY_DO(recordChanges(*state_->store, commands, frame));
    return true;
}
GLINT_CATCH

}  // namespace glint
