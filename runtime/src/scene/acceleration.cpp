// Acceleration structures, their scratch memory, and the top level.
#include "scene/acceleration.h"

#include "context/commands.h"
#include "context/timer.h"
#include "context/upload.h"
#include "context/vulkan_error.h"

namespace glint {

Result<AccelerationStructure> createStructure(Context::State& context, MemoryPool& pool, VkDeviceSize bytes,
                                              VkAccelerationStructureTypeKHR type) {
    AccelerationStructure structure;
    Result<Buffer> buffer =
        createBuffer(context, pool, bytes, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
    if (!buffer) {
        return buffer.error();
    }
    structure.buffer = std::move(*buffer);
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
    Result<Buffer> buffer =
        createBuffer(context, pool, bytes + alignment, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    if (!buffer) {
        return buffer.error();
    }
    Scratch scratch;
    scratch.buffer = std::move(*buffer);
    scratch.address = (scratch.buffer.address + alignment - 1) / alignment * alignment;
    return scratch;
}

namespace {

// Uploads instances into a device buffer. The device's rules for buffers of this usage align it to 16 bytes.
Result<Buffer> uploadInstances(Context::State& context, MemoryPool& pool,
                               std::span<const VkAccelerationStructureInstanceKHR> instances) {
    Result<Buffer> buffer = createBuffer(
        context, pool,
        std::max<VkDeviceSize>(instances.size_bytes(), sizeof(VkAccelerationStructureInstanceKHR)),
        VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
            VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    if (!buffer) {
        return buffer.error();
    }
    Result<std::unique_ptr<Uploader>> uploader = Uploader::create(context);
    if (!uploader) {
        return uploader.error();
    }
    if (Status status = (*uploader)->copyToBuffer(bytesOf(instances), *buffer); !status) {
        return status.error();
    }
    if (Status status = (*uploader)->finish(); !status) {
        return status.error();
    }
    return buffer;
}

Status submitTlasBuild(Context::State& context, const VkAccelerationStructureBuildGeometryInfoKHR& info,
                       std::uint32_t instanceCount, double& buildMs) {
    Result<CommandRunner> runner = CommandRunner::create(context);
    if (!runner) {
        return runner.error();
    }
    Result<Timer> timer = Timer::create(context, 1);
    if (!timer) {
        return timer.error();
    }
    Result<VkCommandBuffer> commands = runner->begin();
    if (!commands) {
        return commands.error();
    }
    VkAccelerationStructureBuildRangeInfoKHR range{};
    range.primitiveCount = instanceCount;
    const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
    timer->recordBegin(*commands, 0);
    context.vk.CmdBuildAccelerationStructuresKHR(*commands, 1, &info, &ranges);
    timer->recordEnd(*commands, 0);
    recordDependency(context, *commands,
                     {VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                      VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                      VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR});
    if (Status status = runner->submitAndWait(); !status) {
        return status;
    }
    if (timer->available()) {
        Result<std::vector<double>> milliseconds = timer->read(1);
        if (!milliseconds) {
            return milliseconds.error();
        }
        buildMs = milliseconds->front();
    }
    return okStatus();
}

}  // namespace

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

Result<AccelerationStructure> buildTlas(Context::State& context, MemoryPool& pool,
                                        std::span<const VkAccelerationStructureInstanceKHR> instances,
                                        double& buildMs) {
    MemoryPool transient(context);
    Result<Buffer> buffer = uploadInstances(context, transient, instances);
    if (!buffer) {
        return buffer.error();
    }
    TlasBuild build;
    if (Status status = describeTlas(context, buffer->address, instances.size(), false, build); !status) {
        return status.error();
    }
    Result<AccelerationStructure> structure = createStructure(
        context, pool, build.sizes.accelerationStructureSize, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR);
    if (!structure) {
        return structure.error();
    }
    Result<Scratch> scratch = createScratch(context, transient, build.sizes.buildScratchSize);
    if (!scratch) {
        return scratch.error();
    }
    build.info.dstAccelerationStructure = structure->handle.get();
    build.info.scratchData.deviceAddress = scratch->address;
    const auto count = static_cast<std::uint32_t>(instances.size());
    if (Status status = submitTlasBuild(context, build.info, count, buildMs); !status) {
        return status.error();
    }
    return structure;
}

}  // namespace glint
