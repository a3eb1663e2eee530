// BLASes: their sizes, and the builds of an upload.
#include "context/commands.h"
#include "context/vulkan_error.h"
#include "renderer/pass_dependencies.h"
#include "scene/acceleration.h"
#include "scene/blas_build.h"
#include "scene/scene_upload.h"

#include <algorithm>
#include <memory>

namespace glint {
namespace {

constexpr MemoryDependency kBuildToQuery{VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                                         VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR,
                                         VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                                         VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR};

// All data that the recorded builds refer to, besides memory.
struct Builds {
    std::vector<BlasBuild> all;
    std::vector<VkAccelerationStructureKHR> handles;
    ScratchRange scratch;
    VkQueryPool sizes = VK_NULL_HANDLE;

    std::vector<const BlasBuild*> pointers() const {
        std::vector<const BlasBuild*> pointers;
        for (const BlasBuild& build : all) {
            pointers.push_back(&build);
        }
        return pointers;
    }
};

Result<UniqueQueryPool> createSizes(Context::State& context, std::uint32_t count) {
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
    info.queryCount = count;
    VkQueryPool queries = VK_NULL_HANDLE;
    const VkResult result = context.vk.CreateQueryPool(context.handles.device, &info, nullptr, &queries);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreateQueryPool", result);
    }
    context.vk.ResetQueryPool(context.handles.device, queries, 0, count);
    return UniqueQueryPool(context, queries);
}

void record(const Context::State& context, const Builds& builds, VkCommandBuffer commands) {
    recordBuilds(context, commands, builds.pointers(), builds.scratch);
    recordDependency(context, commands, kBuildToQuery);
    context.vk.CmdWriteAccelerationStructuresPropertiesKHR(
        commands, static_cast<std::uint32_t>(builds.handles.size()), builds.handles.data(),
        VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR, builds.sizes, 0);
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

Result<std::vector<AccelerationStructure>> addBlases(SceneUpload& upload, std::span<const BlasInput> inputs,
                                                     BlasStatistics& statistics) {
    Context::State& context = upload.context;
    std::vector<AccelerationStructure> structures;
    structures.reserve(inputs.size());
    if (inputs.empty()) {
        return structures;
    }
    upload.compaction = std::make_unique<Compaction>(context);
    auto builds = std::make_shared<Builds>();
    builds->all.reserve(inputs.size());
    for (const BlasInput& input : inputs) {
        BlasBuild build = describeBuild(context, input);
        GLINT_TRY(auto structure, createStructure(context, upload.compaction->pool, build.structureBytes,
                                                  VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR));
        statistics.bytes += build.structureBytes;
        build.info.dstAccelerationStructure = structure.handle.get();
        builds->handles.push_back(structure.handle.get());
        builds->all.push_back(std::move(build));
        structures.push_back(std::move(structure));
    }
    builds->scratch.bytes = scratchBytesOf(context, builds->pointers());
    GLINT_TRY(auto scratch, createScratch(context, upload.pool, builds->scratch.bytes));
    builds->scratch.address = scratch.address;
    upload.keep(std::move(scratch.buffer));
    upload.compaction->count = static_cast<std::uint32_t>(inputs.size());
    GLINT_TRY(auto sizes, createSizes(context, upload.compaction->count));
    builds->sizes = sizes.get();
    upload.compaction->sizes = std::move(sizes);
    GLINT_TRY(upload.timer, Timer::create(context, 2));
    upload.stretches = 1;
    upload.uploader->add([&context, &upload, builds](VkCommandBuffer commands) {
        upload.timer->recordReset(commands);
        recordDependency(context, commands, kAllToAll);
        upload.timer->recordBegin(commands, SceneUpload::kBlasStretch);
        record(context, *builds, commands);
        upload.timer->recordEnd(commands, SceneUpload::kBlasStretch);
    });
    return structures;
}

}  // namespace glint
