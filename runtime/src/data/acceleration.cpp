// Acceleration structures, their scratch memory, and the TLAS.
#include "data/acceleration.h"

#include "context/commands.h"
#include "context/vulkan_table.h"

#include <algorithm>
#include <utility>

namespace glint {

Result<AccelerationStructure> createStructure(Context::State& context, MemoryPool& pool, VkDeviceSize bytes,
                                              VkAccelerationStructureTypeKHR type) {
    AccelerationStructure structure;
    GLINT_TRY(structure.buffer,
              createBuffer(context, pool, bytes, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR));
    const VkAccelerationStructureCreateInfoKHR info{
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR,
        .buffer = structure.buffer.handle.get(),
        .size = bytes,
        .type = type};
    GLINT_TRY(structure.handle,
              createHandle<UniqueAccelerationStructure>(context, context.vk.CreateAccelerationStructureKHR,
                                                        "vkCreateAccelerationStructureKHR", info));
    VkAccelerationStructureDeviceAddressInfoKHR address{
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR,
        .accelerationStructure = structure.handle.get()};
    structure.address = context.vk.GetAccelerationStructureDeviceAddressKHR(context.handles.device, &address);
    return structure;
}

Result<AlignedBuffer> createScratch(Context::State& context, MemoryPool& pool, VkDeviceSize bytes) {
    return createAligned(context, pool, bytes,
                         context.limits.accelerationStructure.minAccelerationStructureScratchOffsetAlignment,
                         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
}

namespace {

VkAccelerationStructureGeometryKHR describeInstances(VkDeviceAddress instances) {
    VkAccelerationStructureGeometryKHR geometry{
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR};
    geometry.geometry.instances = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
        .data = {.deviceAddress = instances}};
    return geometry;
}

}  // namespace

Result<TlasBuild> describeTlas(const Context::State& context, std::size_t count, bool updatable) {
    const std::uint64_t limit = context.limits.accelerationStructure.maxInstanceCount;
    if (count > limit) {
        return makeError("tlas-limit", "",
                         phrase("the scene has ", count, " instances, the device takes ", limit),
                         "use a smaller scene");
    }
    const VkAccelerationStructureGeometryKHR geometry = describeInstances(0);
    const VkBuildAccelerationStructureFlagsKHR updates =
        updatable ? VkBuildAccelerationStructureFlagsKHR{VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR}
                  : 0U;
    TlasBuild build{.info = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR,
                             .type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR,
                             .flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR | updates,
                             .mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR,
                             .geometryCount = 1,
                             .pGeometries = &geometry},
                    .sizes = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR}};
    const auto primitives = static_cast<std::uint32_t>(count);
    context.vk.GetAccelerationStructureBuildSizesKHR(context.handles.device,
                                                     VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
                                                     &build.info, &primitives, &build.sizes);
    build.info.pGeometries = nullptr;
    return build;
}

void recordTlasBuild(const Context::State& context, VkCommandBuffer commands, const TlasBuild& build,
                     const TlasInput& input, VkAccelerationStructureKHR target, bool refit) {
    const VkAccelerationStructureGeometryKHR geometry = describeInstances(input.instances);
    VkAccelerationStructureBuildGeometryInfoKHR info = build.info;
    info.pGeometries = &geometry;
    info.dstAccelerationStructure = target;
    info.scratchData.deviceAddress = input.scratch;
    if (refit) {
        info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
        info.srcAccelerationStructure = target;
    }
    const VkAccelerationStructureBuildRangeInfoKHR range{.primitiveCount = input.count};
    const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
    context.vk.CmdBuildAccelerationStructuresKHR(commands, 1, &info, &ranges);
}

namespace {

// This is VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_DATA_ACCESS_KHR, which Vulkan headers before 1.3.249 lack.
constexpr VkBuildAccelerationStructureFlagsKHR kAllowDataAccess = 0x800;

// Flags of structures that are built once and traced often: the build optimises tracing, and compaction
// follows.
constexpr VkBuildAccelerationStructureFlagsKHR kStatic =
    VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR |
    VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;
// Flags of structures that are built or refitted each frame. Their size may not change.
constexpr VkBuildAccelerationStructureFlagsKHR kUpdatable =
    VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR |
    VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;

// Describes how a geometry uses a micromap, for the chain of its triangles. Points into `micromap`.
VkAccelerationStructureTrianglesOpacityMicromapEXT describeMicromap(const DeviceMicromap& micromap) {
    VkAccelerationStructureTrianglesOpacityMicromapEXT described{
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_TRIANGLES_OPACITY_MICROMAP_EXT,
        .indexType = VK_INDEX_TYPE_UINT32};
    described.indexBuffer.deviceAddress = micromap.indices.address;
    described.indexStride = sizeof(std::int32_t);
    described.usageCountsCount = static_cast<std::uint32_t>(micromap.usages.size());
    described.pUsageCounts = micromap.usages.data();
    described.micromap = micromap.handle.get();
    return described;
}

constexpr VkDeviceSize kSharedScratchBytes = VkDeviceSize{64} << 20;

VkAccelerationStructureGeometryKHR describeGeometry(const BlasGeometry& geometry) {
    VkAccelerationStructureGeometryKHR described{
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR};
    described.flags |= geometry.opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR : VkGeometryFlagBitsKHR{};
    described.flags |=
        geometry.once ? VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR : VkGeometryFlagBitsKHR{};
    VkAccelerationStructureGeometryTrianglesDataKHR& triangles = described.geometry.triangles;
    triangles.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    triangles.vertexData.deviceAddress = geometry.positions;
    triangles.vertexStride = 3 * sizeof(float);
    triangles.maxVertex = geometry.vertexCount - 1;
    triangles.indexType = geometry.shortIndices ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32;
    triangles.indexData.deviceAddress = geometry.indices;
    return described;
}

}  // namespace

BlasBuild describeBuild(const Context::State& context, const BlasInput& input) {
    BlasBuild build;
    std::vector<std::uint32_t> counts;
    build.micromaps.reserve(input.geometries.size());
    for (const BlasGeometry& geometry : input.geometries) {
        build.geometries.push_back(describeGeometry(geometry));
        if (geometry.micromap != nullptr) {
            build.micromaps.push_back(describeMicromap(*geometry.micromap));
            build.geometries.back().geometry.triangles.pNext = &build.micromaps.back();
        }
        const VkAccelerationStructureBuildRangeInfoKHR range{.primitiveCount = geometry.triangleCount};
        build.ranges.push_back(range);
        counts.push_back(geometry.triangleCount);
    }
    build.info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
    build.info.type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
    build.info.flags = (input.updatable ? kUpdatable : kStatic) | (input.dataAccess ? kAllowDataAccess : 0U);
    build.info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    build.info.geometryCount = static_cast<std::uint32_t>(build.geometries.size());
    build.info.pGeometries = build.geometries.data();
    VkAccelerationStructureBuildSizesInfoKHR sizes{
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    context.vk.GetAccelerationStructureBuildSizesKHR(context.handles.device,
                                                     VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
                                                     &build.info, counts.data(), &sizes);
    const VkDeviceSize alignment =
        context.limits.accelerationStructure.minAccelerationStructureScratchOffsetAlignment;
    build.structureBytes = sizes.accelerationStructureSize;
    build.scratchBytes = alignUp(
        input.updatable ? std::max(sizes.buildScratchSize, sizes.updateScratchSize) : sizes.buildScratchSize,
        alignment);
    return build;
}

VkDeviceSize scratchBytesOf(const Context::State& context, std::span<const BlasWork> works) {
    VkDeviceSize most = 0;
    VkDeviceSize sum = 0;
    for (const BlasWork& work : works) {
        sum += work.build->scratchBytes;
        most = std::max(most, work.build->scratchBytes);
    }
    // Some drivers bind scratch as a storage buffer, so it must respect the limit of those.
    const VkDeviceSize limit =
        std::min<VkDeviceSize>(kSharedScratchBytes, context.limits.core.maxStorageBufferRange);
    return std::max(most, std::min(sum, limit));
}

void recordBuilds(const Context::State& context, VkCommandBuffer commands, std::span<const BlasWork> works,
                  const ScratchRange& scratch) {
    std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
    std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
    VkDeviceSize used = 0;
    const auto flush = [&] {
        if (!infos.empty()) {
            context.vk.CmdBuildAccelerationStructuresKHR(commands, static_cast<std::uint32_t>(infos.size()),
                                                         infos.data(), ranges.data());
        }
        infos.clear();
        ranges.clear();
        used = 0;
    };
    for (const auto [build, refit] : works) {
        if (used + build->scratchBytes > scratch.bytes) {
            flush();
            recordDependency(context, commands, kBuildsInOrder);
        }
        VkAccelerationStructureBuildGeometryInfoKHR info = build->info;
        info.scratchData.deviceAddress = scratch.address + used;
        if (refit) {
            info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
            info.srcAccelerationStructure = info.dstAccelerationStructure;
        }
        used += build->scratchBytes;
        infos.push_back(info);
        ranges.push_back(build->ranges.data());
    }
    flush();
}

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

}  // namespace glint
