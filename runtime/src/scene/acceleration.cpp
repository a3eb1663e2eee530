// Acceleration structures, their scratch memory, and the TLAS.
#include "scene/acceleration.h"

#include "context/commands.h"
#include "context/vulkan_error.h"
#include "renderer/pass_dependencies.h"
#include "scene/scene_upload.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace glint {

Result<AccelerationStructure> createStructure(Context::State& context, MemoryPool& pool, VkDeviceSize bytes,
                                              VkAccelerationStructureTypeKHR type) {
    AccelerationStructure structure;
    GLINT_TRY(structure.buffer,
              createBuffer(context, pool, bytes, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR));
    VkAccelerationStructureCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
    info.buffer = structure.buffer.handle.get();
    info.size = bytes;
    info.type = type;
    VkAccelerationStructureKHR handle = VK_NULL_HANDLE;
    const VkDevice device = context.handles.device;
    const VkResult result = context.vk.CreateAccelerationStructureKHR(device, &info, nullptr, &handle);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreateAccelerationStructureKHR", result);
    }
    structure.handle = UniqueAccelerationStructure(context, handle);
    VkAccelerationStructureDeviceAddressInfoKHR address{};
    address.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR;
    address.accelerationStructure = handle;
    structure.address = context.vk.GetAccelerationStructureDeviceAddressKHR(device, &address);
    return structure;
}

Result<Scratch> createScratch(Context::State& context, MemoryPool& pool, VkDeviceSize bytes) {
    const VkDeviceSize alignment =
        context.limits.accelerationStructure.minAccelerationStructureScratchOffsetAlignment;
    GLINT_TRY(auto buffer,
              createBuffer(context, pool, bytes + alignment, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    Scratch scratch;
    scratch.buffer = std::move(buffer);
    scratch.address = (scratch.buffer.address + alignment - 1) / alignment * alignment;
    return scratch;
}

Status describeTlas(const Context::State& context, VkDeviceAddress instances, std::size_t count,
                    bool updatable, TlasBuild& build) {
    const std::uint64_t limit = context.limits.accelerationStructure.maxInstanceCount;
    if (count > limit) {
        return makeError("tlas-limit", "",
                         "the scene has " + std::to_string(count) + " instances, the device takes " +
                             std::to_string(limit),
                         "use a smaller scene");
    }
    VkAccelerationStructureGeometryKHR& geometry = build.geometry;
    geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    geometry.geometry.instances.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    geometry.geometry.instances.data.deviceAddress = instances;
    build.info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
    build.info.type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
    build.info.flags =
        VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR |
        (updatable
             ? VkBuildAccelerationStructureFlagsKHR{VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR}
             : 0U);
    build.info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    build.info.geometryCount = 1;
    build.info.pGeometries = &geometry;
    build.sizes.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
    const auto primitives = static_cast<std::uint32_t>(count);
    context.vk.GetAccelerationStructureBuildSizesKHR(context.handles.device,
                                                     VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
                                                     &build.info, &primitives, &build.sizes);
    return okStatus();
}

Result<PreparedTlas> prepareTlas(Context::State& context, MemoryPool& pool,
                                 std::span<const VkAccelerationStructureInstanceKHR> instances,
                                 bool updatable, std::vector<Buffer>& kept) {
    // The device's rules for buffers of this usage align it to 16 bytes.
    GLINT_TRY(auto buffer,
              createBuffer(
                  context, pool,
                  std::max<VkDeviceSize>(instances.size_bytes(), sizeof(VkAccelerationStructureInstanceKHR)),
                  VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR, MemoryUse::Upload));
    if (!instances.empty()) {
        std::memcpy(buffer.mapped, instances.data(), instances.size_bytes());
    }
    PreparedTlas prepared;
    prepared.count = static_cast<std::uint32_t>(instances.size());
    GLINT_TRY_DO(describeTlas(context, buffer.address, instances.size(), updatable, prepared.build));
    GLINT_TRY(auto scratch, createScratch(context, pool, prepared.build.sizes.buildScratchSize));
    prepared.scratch = scratch.address;
    kept.push_back(std::move(buffer));
    kept.push_back(std::move(scratch.buffer));
    return prepared;
}

void recordTlasBuild(const Context::State& context, VkCommandBuffer commands, const PreparedTlas& prepared,
                     VkAccelerationStructureKHR target) {
    VkAccelerationStructureBuildGeometryInfoKHR info = prepared.build.info;
    info.pGeometries = &prepared.build.geometry;
    info.dstAccelerationStructure = target;
    info.scratchData.deviceAddress = prepared.scratch;
    VkAccelerationStructureBuildRangeInfoKHR range{};
    range.primitiveCount = prepared.count;
    const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
    context.vk.CmdBuildAccelerationStructuresKHR(commands, 1, &info, &ranges);
}

Result<AccelerationStructure> addTlas(SceneUpload& upload, MemoryPool& pool,
                                      std::span<const VkAccelerationStructureInstanceKHR> instances) {
    Context::State& context = upload.context;
    const Result<PreparedTlas> prepared = prepareTlas(context, upload.pool, instances, false, upload.kept);
    if (!prepared) {
        return prepared.error();
    }
    Result<AccelerationStructure> structure =
        createStructure(context, pool, prepared->build.sizes.accelerationStructureSize,
                        VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR);
    if (!structure) {
        return structure.error();
    }
    const bool timed = upload.timer.has_value();
    upload.stretches += timed ? 1 : 0;
    upload.uploader->add([&context, &upload, timed, prepared = *prepared,
                          target = structure->handle.get()](VkCommandBuffer commands) {
        recordDependency(context, commands, kAllToAll);
        if (timed) {
            upload.timer->recordBegin(commands, SceneUpload::kTlasStretch);
        }
        recordTlasBuild(context, commands, prepared, target);
        if (timed) {
            upload.timer->recordEnd(commands, SceneUpload::kTlasStretch);
        }
    });
    return structure;
}

}  // namespace glint
