#include "data/deformer.h"

#include "context/device_objects.h"
#include "context/shader_modules.h"
#include "context/vulkan_table.h"

#include <glint/internal/package_modules.h>

#include <algorithm>

namespace glint {
namespace {

constexpr VkDeviceSize kAlignment = 16;

// Packs arrays one after the other, each of them aligned.
class Packing {
public:
    // Returns the offset of the added array. An empty array adds nothing.
    template <typename T>
    VkDeviceSize add(const std::vector<T>& values) {
        const VkDeviceSize offset = bytes_.size();
        const std::span<const std::uint8_t> bytes = bytesOf(std::span<const T>(values));
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        bytes_.resize(alignUp(bytes_.size(), kAlignment));
        return offset;
    }
    const std::vector<std::uint8_t>& bytes() const {
        return bytes_;
    }

private:
    std::vector<std::uint8_t> bytes_;
};

using Difference = std::array<float, 3>;
using Member = std::span<const Difference> PrimitiveView::MorphTarget::*;

// Joins the differences target by target. Targets that lack the attribute get zeros. The result is empty if
// all of them lack it.
std::vector<Difference> joined(const PrimitiveView& view, Member member) {
    const bool any = std::ranges::any_of(
        view.targets, [&](const PrimitiveView::MorphTarget& target) { return !(target.*member).empty(); });
    std::vector<Difference> differences;
    for (std::size_t i = 0; any && i < view.targets.size(); ++i) {
        const std::span<const Difference> own = view.targets[i].*member;
        differences.insert(differences.end(), own.begin(), own.end());
        differences.resize((i + 1) * view.positions.size());
    }
    return differences;
}

}  // namespace

Result<DeformSource> uploadDeformSource(Context::State& context, MemoryPool& pool, Uploader& uploader,
                                        const PrimitiveView& view) {
    DeformSource source;
    if (view.indices.empty() || (view.joints.empty() && view.targets.empty())) {
        return source;
    }
    Packing packing;
    const std::vector<Difference> positions = joined(view, &PrimitiveView::MorphTarget::positions);
    const std::vector<Difference> normals = joined(view, &PrimitiveView::MorphTarget::normals);
    const std::vector<Difference> tangents = joined(view, &PrimitiveView::MorphTarget::tangents);
    const std::vector<std::uint32_t> joints(view.joints.begin(), view.joints.end());
    const std::vector<float> weights(view.jointWeights.begin(), view.jointWeights.end());
    const VkDeviceSize offsets[] = {packing.add(positions), packing.add(normals), packing.add(tangents),
                                    packing.add(joints), packing.add(weights)};
    GLINT_TRY(auto made,
              createAligned(context, pool, packing.bytes().size(), kAlignment,
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT));
    const VkDeviceAddress begin = made.address;
    const VkDeviceSize offset = made.offset();
    source.buffer = std::move(made.buffer);
    source.targetPositions = positions.empty() ? 0 : begin + offsets[0];
    source.targetNormals = normals.empty() ? 0 : begin + offsets[1];
    source.targetTangents = tangents.empty() ? 0 : begin + offsets[2];
    source.joints = begin + offsets[3];
    source.jointWeights = begin + offsets[4];
    source.influences = static_cast<std::uint32_t>(joints.size() / view.positions.size());
    source.targets = static_cast<std::uint32_t>(view.targets.size());
    source.jointCount = joints.empty() ? 0 : *std::ranges::max_element(joints) + 1;
    if (!packing.bytes().empty()) {
        GLINT_TRY_DO(uploader.copyToBuffer(packing.bytes(), source.buffer, offset));
    }
    return source;
}

Result<DeformedVertices> createDeformedVertices(Context::State& context, MemoryPool& pool,
                                                const GpuPrimitive& primitive) {
    const VkDeviceSize vectors = alignUp(VkDeviceSize{3 * sizeof(float)} * primitive.vertexCount, kAlignment);
    const VkDeviceSize tangents =
        alignUp(VkDeviceSize{4 * sizeof(float)} * primitive.vertexCount, kAlignment);
    GLINT_TRY(auto made,
              createAligned(context, pool, 2 * vectors + tangents, kAlignment,
                            VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
                                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT));
    return DeformedVertices{std::move(made.buffer), made.address,
                            primitive.normals == 0 ? 0 : made.address + vectors,
                            primitive.tangents == 0 ? 0 : made.address + 2 * vectors};
}

gpu::DeformRecord makeDeformRecord(const GpuPrimitive& primitive, const DeformSource& source,
                                   const DeformedVertices& vertices, VkDeviceAddress joints,
                                   VkDeviceAddress weights) {
    gpu::DeformRecord record{};
    record.vertexCount = primitive.vertexCount;
    record.targetCount = weights == 0 ? 0 : source.targets;
    record.influenceCount = joints == 0 ? 0 : source.influences;
    record.flags = (vertices.normals != 0 ? gpu::kDeformNormals : 0) |
                   (vertices.tangents != 0 ? gpu::kDeformTangents : 0) |
                   (source.targetPositions != 0 ? gpu::kDeformTargetPositions : 0) |
                   (source.targetNormals != 0 ? gpu::kDeformTargetNormals : 0) |
                   (source.targetTangents != 0 ? gpu::kDeformTargetTangents : 0);
    record.positions = primitive.positions;
    record.normals = primitive.normals;
    record.tangents = primitive.tangents;
    record.targetPositions = source.targetPositions;
    record.targetNormals = source.targetNormals;
    record.targetTangents = source.targetTangents;
    record.targetWeights = weights;
    record.joints = source.joints;
    record.jointWeights = source.jointWeights;
    record.jointRows = joints;
    record.deformedPositions = vertices.positions;
    record.deformedNormals = vertices.normals;
    record.deformedTangents = vertices.tangents;
    return record;
}

Result<UniquePipelineLayout> createDeformLayout(Context::State& context) {
    const VkPushConstantRange range{.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
                                    .size = sizeof(gpu::DeformConstants)};
    return createPipelineLayout(context, {}, range);
}

Result<DeformPass> DeformPass::create(Context::State& context, const Package& package) {
    if (!package.shape().deforms) {
        return makeError("scene-package", "",
                         "the scene has meshes that follow joints or morph targets, but the package has no "
                         "pass that moves them",
                         "compile the package from this scene");
    }
    DeformPass pass(context);
    GLINT_TRY(pass.layout_, createDeformLayout(context));
    GLINT_TRY(pass.pipeline_, createComputePipeline(context, package.spirv({package::ModuleRole::Deform}),
                                                    pass.layout_.get()));
    return pass;
}

void DeformPass::record(VkCommandBuffer commands, VkDeviceAddress records,
                        std::span<const std::pair<std::uint32_t, std::uint32_t>> deformed) const {
    const DeviceTable& vk = context_->vk;
    vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    for (const auto& [record, vertices] : deformed) {
        const gpu::DeformConstants constants{records, record, 0};
        vk.CmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants),
                            &constants);
        const std::uint32_t groups = (vertices + gpu::kDeformGroupSize - 1) / gpu::kDeformGroupSize;
        const std::uint32_t across = std::min(groups, gpu::kMaxDeformGroupsX);
        vk.CmdDispatch(commands, across, (groups + across - 1) / across, 1);
    }
}

}  // namespace glint
