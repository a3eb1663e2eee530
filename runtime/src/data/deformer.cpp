#include "data/deformer.h"

#include "context/device_objects.h"
#include "context/resources.h"
#include "context/shader_modules.h"
#include "context/vulkan_table.h"
#include "interop/deform.h"

#include <algorithm>
#include <cstring>

namespace glint {
namespace {

constexpr VkDeviceSize kAlignment = 16;

VkDeviceSize aligned(VkDeviceSize bytes) {
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

// Packs arrays one after the other, each of them aligned.
class Packing {
public:
    // Returns the offset of the added array. An empty array adds nothing.
    template <typename T>
    VkDeviceSize add(const std::vector<T>& values) {
        const VkDeviceSize offset = bytes_.size();
        const std::span<const std::uint8_t> bytes = bytesOf(std::span<const T>(values));
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        bytes_.resize(aligned(bytes_.size()));
        return offset;
    }
    const std::vector<std::uint8_t>& bytes() const {
        return bytes_;
    }

private:
    std::vector<std::uint8_t> bytes_;
};

using Difference = std::array<float, 3>;
using Member = std::span<const Difference> MorphTargetView::*;

// Joins the differences target by target. Targets that lack the attribute get zeros. The result is empty if
// all of them lack it.
std::vector<Difference> joined(const PrimitiveView& view, Member member) {
    const bool any = std::ranges::any_of(
        view.targets, [&](const MorphTargetView& target) { return !(target.*member).empty(); });
    std::vector<Difference> differences;
    for (std::size_t i = 0; any && i < view.targets.size(); ++i) {
        const std::span<const Difference> own = view.targets[i].*member;
        differences.insert(differences.end(), own.begin(), own.end());
        differences.resize((i + 1) * view.positions.size());
    }
    return differences;
}

// Returns whether this primitive of a deformed instance moves.
bool moves(const PrimitiveView& view, const InstanceView& instance) {
    const bool follows = !view.joints.empty() && !instance.joints.empty();
    const bool morphs = !view.targets.empty() && !instance.morphWeights.empty();
    return !view.indices.empty() && (follows || morphs);
}

// Returns the addresses of deformed attributes in a buffer that has room for all attributes of the primitive.
gpu::DeformRecord placeTargets(const GpuPrimitive& primitive, VkDeviceAddress address) {
    gpu::DeformRecord record{};
    record.vertexCount = primitive.vertexCount;
    record.positions = primitive.positions;
    record.normals = primitive.normals;
    record.tangents = primitive.tangents;
    record.deformedPositions = aligned(address);
    const VkDeviceSize vectors = aligned(VkDeviceSize{3 * sizeof(float)} * primitive.vertexCount);
    if (primitive.normals != 0) {
        record.flags |= gpu::kDeformNormals;
        record.deformedNormals = record.deformedPositions + vectors;
    }
    if (primitive.tangents != 0) {
        record.flags |= gpu::kDeformTangents;
        record.deformedTangents = record.deformedPositions + 2 * vectors;
    }
    return record;
}

VkDeviceSize targetBytes(const GpuPrimitive& primitive) {
    const VkDeviceSize vectors = aligned(VkDeviceSize{3 * sizeof(float)} * primitive.vertexCount);
    const VkDeviceSize tangents = aligned(VkDeviceSize{4 * sizeof(float)} * primitive.vertexCount);
    return 2 * vectors + tangents + kAlignment;
}

}  // namespace

bool isDeformed(const InstanceView& instance) {
    return !instance.joints.empty() || !instance.morphWeights.empty();
}

bool hasDeformedInstance(const SceneView& scene) {
    return std::ranges::any_of(scene.instances, isDeformed);
}

Result<std::unique_ptr<Deformer>> Deformer::create(Context::State& context, const Package& package,
                                                   const SceneView& scene,
                                                   std::span<const GpuPrimitive> primitives,
                                                   Uploader& uploader, MemoryPool& targetPool,
                                                   DeformedBuffers& target) {
    if (!package.shape().deforms) {
        return makeError("scene-package", "",
                         "the scene has meshes that follow joints or morph targets, but the package has no "
                         "pass that moves them",
                         "compile the package from this scene");
    }
    std::unique_ptr<Deformer> deformer(new Deformer(context));
    GLINT_TRY_DO(deformer->createPipeline(package));
    GLINT_TRY_DO(deformer->createPoseBuffers(scene));
    GLINT_TRY_DO(deformer->createRecords(scene, primitives, uploader, targetPool, target));
    return deformer;
}

Result<UniquePipelineLayout> createDeformLayout(Context::State& context) {
    VkPushConstantRange range{};
    range.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    range.size = sizeof(gpu::DeformConstants);
    return createPipelineLayout(context, {}, range);
}

Status Deformer::createPipeline(const Package& package) {
    GLINT_TRY(layout_, createDeformLayout(*context_));
    GLINT_TRY(pipeline_,
              createComputePipeline(*context_, package.spirv({package::ModuleRole::Deform}), layout_.get()));
    return okStatus();
}

Status Deformer::createPoseBuffers(const SceneView& scene) {
    VkDeviceSize bytes = 0;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const InstanceView& instance = scene.instances[i];
        if (!isDeformed(instance)) {
            continue;
        }
        Slot slot{i, bytes, 0, instance.morphWeights.size()};
        const PrimitiveRange own = primitivesOf(scene.primitives, instance.mesh);
        for (std::uint32_t primitive = own.first; primitive < own.end; ++primitive) {
            slot.weightCount = std::max(slot.weightCount, scene.primitives[primitive].targets.size());
        }
        bytes += instance.joints.size_bytes();
        slot.weights = bytes;
        bytes = aligned(bytes + slot.weightCount * sizeof(float));
        slots_.push_back(slot);
    }
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    GLINT_TRY(pose_, createBuffer(*context_, pool_, bytes + kAlignment, usage));
    GLINT_TRY(staging_,
              createBuffer(*context_, pool_, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload));
    std::memset(staging_.mapped, 0, bytes);
    setPose(scene.instances);
    return okStatus();
}

Result<Deformer::Source> Deformer::uploadSource(const PrimitiveView& view, Uploader& uploader) {
    Packing packing;
    const std::vector<Difference> positions = joined(view, &MorphTargetView::positions);
    const std::vector<Difference> normals = joined(view, &MorphTargetView::normals);
    const std::vector<Difference> tangents = joined(view, &MorphTargetView::tangents);
    const std::vector<std::uint32_t> joints(view.joints.begin(), view.joints.end());
    const std::vector<float> weights(view.jointWeights.begin(), view.jointWeights.end());
    const VkDeviceSize offsets[] = {packing.add(positions), packing.add(normals), packing.add(tangents),
                                    packing.add(joints), packing.add(weights)};
    GLINT_TRY(auto buffer,
              createBuffer(*context_, pool_, packing.bytes().size() + kAlignment,
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT));
    Source source;
    const VkDeviceAddress begin = aligned(buffer.address);
    source.targetPositions = positions.empty() ? 0 : begin + offsets[0];
    source.targetNormals = normals.empty() ? 0 : begin + offsets[1];
    source.targetTangents = tangents.empty() ? 0 : begin + offsets[2];
    source.joints = begin + offsets[3];
    source.jointWeights = begin + offsets[4];
    source.influences = static_cast<std::uint32_t>(joints.size() / view.positions.size());
    if (!packing.bytes().empty()) {
        GLINT_TRY_DO(uploader.copyToBuffer(packing.bytes(), buffer, begin - buffer.address));
    }
    source.buffer = std::move(buffer);
    return source;
}

Status Deformer::createRecords(const SceneView& scene, std::span<const GpuPrimitive> primitives,
                               Uploader& uploader, MemoryPool& targetPool, DeformedBuffers& target) {
    std::vector<gpu::DeformRecord> records;
    for (const Slot& slot : slots_) {
        const InstanceView& instance = scene.instances[slot.instance];
        const PrimitiveRange own = primitivesOf(scene.primitives, instance.mesh);
        for (std::uint32_t i = own.first; i < own.end; ++i) {
            const PrimitiveView& view = scene.primitives[i];
            if (!moves(view, instance)) {
                continue;
            }
            if (!sources_.contains(i)) {
                GLINT_TRY(auto source, uploadSource(view, uploader));
                sources_.emplace(i, std::move(source));
            }
            const Source& source = sources_.at(i);
            GLINT_TRY(
                auto buffer,
                createBuffer(*context_, targetPool, targetBytes(primitives[i]),
                             VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
                                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT));
            gpu::DeformRecord record = placeTargets(primitives[i], buffer.address);
            record.targetCount = static_cast<std::uint32_t>(view.targets.size());
            record.influenceCount = instance.joints.empty() ? 0 : source.influences;
            record.flags |= (source.targetPositions != 0 ? gpu::kDeformTargetPositions : 0) |
                            (source.targetNormals != 0 ? gpu::kDeformTargetNormals : 0) |
                            (source.targetTangents != 0 ? gpu::kDeformTargetTangents : 0);
            record.targetPositions = source.targetPositions;
            record.targetNormals = source.targetNormals;
            record.targetTangents = source.targetTangents;
            record.joints = source.joints;
            record.jointWeights = source.jointWeights;
            const VkDeviceAddress pose = aligned(pose_.address);
            record.jointRows = pose + slot.joints;
            record.targetWeights = pose + slot.weights;
            target.addresses[{slot.instance, i}] = {record.deformedPositions, record.deformedNormals,
                                                    record.deformedTangents};
            target.buffers.push_back(std::move(buffer));
            records.push_back(record);
            dispatches_.push_back({slot.instance, record.vertexCount});
        }
    }
    return uploadRecords(*context_, pool_, uploader, std::span<const gpu::DeformRecord>(records), records_);
}

std::vector<bool> Deformer::setPose(std::span<const InstanceView> instances) {
    std::vector<bool> moved(instances.size());
    for (const Slot& slot : slots_) {
        const InstanceView& instance = instances[slot.instance];
        const auto write = [&](VkDeviceSize offset, const void* values, std::size_t bytes) {
            if (bytes > 0 && std::memcmp(staging_.mapped + offset, values, bytes) != 0) {
                std::memcpy(staging_.mapped + offset, values, bytes);
                moved[slot.instance] = true;
            }
        };
        write(slot.joints, instance.joints.data(), instance.joints.size_bytes());
        write(slot.weights, instance.morphWeights.data(), instance.morphWeights.size_bytes());
    }
    return moved;
}

void Deformer::recordPose(VkCommandBuffer commands) const {
    const VkBufferCopy region{0, aligned(pose_.address) - pose_.address, staging_.bytes};
    context_->vk.CmdCopyBuffer(commands, staging_.handle.get(), pose_.handle.get(), 1, &region);
}

void Deformer::recordDeform(VkCommandBuffer commands, const std::vector<bool>& moved) const {
    const DeviceTable& vk = context_->vk;
    vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    for (std::uint32_t i = 0; i < dispatches_.size(); ++i) {
        if (!moved[dispatches_[i].instance]) {
            continue;
        }
        const gpu::DeformConstants constants{records_.address, i, 0};
        vk.CmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants),
                            &constants);
        const std::uint32_t groups =
            (dispatches_[i].vertexCount + gpu::kDeformGroupSize - 1) / gpu::kDeformGroupSize;
        const std::uint32_t across = std::min(groups, gpu::kMaxDeformGroupsX);
        vk.CmdDispatch(commands, across, (groups + across - 1) / across, 1);
    }
}

void Deformer::addMemory(std::vector<MemoryItem>& items) const {
    for (const auto& [primitive, source] : sources_) {
        addTo(items, "targets and influences", source.buffer);
    }
    addTo(items, "pose", pose_);
    addTo(items, "deform records", records_);
    addTo(items, "poses on their way", staging_);
}

}  // namespace glint
