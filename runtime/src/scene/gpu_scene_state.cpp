// Descriptor set 0: the acceleration structure, textures, samplers.
#include "scene/gpu_scene_state.h"

#include "context/device_objects.h"
#include "context/vulkan_table.h"
#include "interop/frame.h"

#include <algorithm>
#include <array>
#include <utility>

namespace glint {
namespace {

constexpr std::size_t kBindings = 3;

SceneSetSize sizeOf(const GpuScene::State& state) {
    return {std::max(state.textureRoom, static_cast<std::uint32_t>(state.textures.size())),
            std::max(state.samplerRoom, static_cast<std::uint32_t>(state.samplers.size())),
            state.textureRoom > 0};
}

std::array<VkDescriptorSetLayoutBinding, kBindings> makeBindings(const Context::State& context,
                                                                 const SceneSetSize& size) {
    const VkShaderStageFlags stages = VK_SHADER_STAGE_FRAGMENT_BIT | passStages(context);
    return {{{gpu::kBindingTlas, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1, stages, nullptr},
             {gpu::kBindingTextures, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, size.textures, stages, nullptr},
             {gpu::kBindingSamplers, VK_DESCRIPTOR_TYPE_SAMPLER, size.samplers, stages, nullptr}}};
}

}  // namespace

Result<UniqueSetLayout> createSceneSetLayout(Context::State& context, const SceneSetSize& size) {
    const auto bindings = makeBindings(context, size);
    // Update-after-bind gives higher limits: devices that otherwise see 16 textures then see 500,000. A scene
    // with room has places without a texture or sampler.
    VkDescriptorBindingFlags room = 0;
    if (size.hasRoom) {
        room = VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT;
    }
    const VkDescriptorBindingFlags arrays = VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT | room;
    const VkDescriptorBindingFlags bindingFlags[kBindings] = {0, arrays, arrays};
    return createSetLayout(context, bindings, bindingFlags);
}

Status createSetLayout(GpuScene::State& state) {
    GLINT_TRY(state.setLayout, createSceneSetLayout(state.context, sizeOf(state)));
    return okStatus();
}

namespace {

Result<DescriptorSet> allocateSet(const GpuScene::State& state) {
    return createSet(state.context, state.setLayout.get(), makeBindings(state.context, sizeOf(state)), true);
}

VkWriteDescriptorSet writeOf(VkDescriptorSet set, std::uint32_t binding, VkDescriptorType type,
                             std::size_t count) {
    VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                               .dstSet = set,
                               .dstBinding = binding,
                               .descriptorCount = static_cast<std::uint32_t>(count),
                               .descriptorType = type};
    return write;
}

void fillSet(const GpuScene::State& state, VkDescriptorSet set, VkAccelerationStructureKHR tlas,
             VkImageView absent) {
    VkWriteDescriptorSetAccelerationStructureKHR structures{
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR,
        .accelerationStructureCount = 1,
        .pAccelerationStructures = &tlas};
    std::vector<VkDescriptorImageInfo> textures;
    for (const DeviceImage& texture : state.textures) {
        const VkImageView view = texture.view.get() == VK_NULL_HANDLE ? absent : texture.view.get();
        textures.push_back({VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    }
    if (textures.empty()) {
        textures.push_back({VK_NULL_HANDLE, absent, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    }
    std::vector<VkDescriptorImageInfo> samplers;
    for (const UniqueSampler& sampler : state.samplers) {
        samplers.push_back({sampler.get(), VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED});
    }
    std::array writes{writeOf(set, gpu::kBindingTlas, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1),
                      writeOf(set, gpu::kBindingTextures, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, textures.size()),
                      writeOf(set, gpu::kBindingSamplers, VK_DESCRIPTOR_TYPE_SAMPLER, samplers.size())};
    writes[0].pNext = &structures;
    writes[1].pImageInfo = textures.data();
    writes[2].pImageInfo = samplers.data();
    state.context.vk.UpdateDescriptorSets(state.context.handles.device, writes.size(), writes.data(), 0,
                                          nullptr);
}

}  // namespace

Result<DescriptorSet> makeSceneSet(const GpuScene::State& state, VkAccelerationStructureKHR tlas,
                                   VkImageView absent) {
    Result<DescriptorSet> set = allocateSet(state);
    if (set) {
        fillSet(state, set->set, tlas, absent);
    }
    return set;
}

}  // namespace glint
