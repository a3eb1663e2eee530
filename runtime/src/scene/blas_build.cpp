#include "scene/blas_build.h"

#include "opacity/micromap_build.h"

#include <algorithm>

namespace glint {
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

constexpr VkDeviceSize kSharedScratchBytes = VkDeviceSize{64} << 20;

VkAccelerationStructureGeometryKHR describeGeometry(const BlasGeometry& geometry) {
    VkAccelerationStructureGeometryKHR described{};
    described.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    described.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
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
        VkAccelerationStructureBuildRangeInfoKHR range{};
        range.primitiveCount = geometry.triangleCount;
        build.ranges.push_back(range);
        counts.push_back(geometry.triangleCount);
    }
    build.info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
    build.info.type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
    build.info.flags = (input.updatable ? kUpdatable : kStatic) | (input.dataAccess ? kAllowDataAccess : 0U);
    build.info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    build.info.geometryCount = static_cast<std::uint32_t>(build.geometries.size());
    build.info.pGeometries = build.geometries.data();
    VkAccelerationStructureBuildSizesInfoKHR sizes{};
    sizes.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
    context.vk.GetAccelerationStructureBuildSizesKHR(context.handles.device,
                                                     VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
                                                     &build.info, counts.data(), &sizes);
    const VkDeviceSize alignment =
        context.limits.accelerationStructure.minAccelerationStructureScratchOffsetAlignment;
    build.structureBytes = sizes.accelerationStructureSize;
    const auto rounded = [&](VkDeviceSize bytes) { return (bytes + alignment - 1) / alignment * alignment; };
    build.scratchBytes = rounded(sizes.buildScratchSize);
    build.updateScratchBytes = input.updatable ? rounded(sizes.updateScratchSize) : 0;
    return build;
}

VkDeviceSize scratchBytesOf(const Context::State& context, std::span<const BlasBuild* const> builds) {
    VkDeviceSize most = 0;
    VkDeviceSize sum = 0;
    for (const BlasBuild* const build : builds) {
        sum += build->scratchBytes;
        most = std::max(most, build->scratchBytes);
    }
    // Some drivers bind scratch as a storage buffer, so it must respect the limit of those.
    const VkDeviceSize limit =
        std::min<VkDeviceSize>(kSharedScratchBytes, context.limits.core.maxStorageBufferRange);
    return std::max(most, std::min(sum, limit));
}

void recordBuilds(const Context::State& context, VkCommandBuffer commands,
                  std::span<const BlasBuild* const> builds, const ScratchRange& scratch) {
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
    for (const BlasBuild* const build : builds) {
        if (used + build->scratchBytes > scratch.bytes) {
            flush();
            recordDependency(context, commands, kBuildsInOrder);
        }
        VkAccelerationStructureBuildGeometryInfoKHR info = build->info;
        info.scratchData.deviceAddress = scratch.address + used;
        used += build->scratchBytes;
        infos.push_back(info);
        ranges.push_back(build->ranges.data());
    }
    flush();
}

}  // namespace glint
