// Descriptor set 0: acceleration structures, textures, samplers.
#include "context/vulkan_error.h"
#include "interop/frame.h"
#include "scene/gpu_scene_state.h"

#include <array>

namespace glint {
namespace {

constexpr std::size_t kBindings = 3;

std::array<VkDescriptorSetLayoutBinding, kBindings> makeBindings(const GpuScene::State& state) {
    const auto textures = static_cast<std::uint32_t>(state.textures.size());
    const auto samplers = static_cast<std::uint32_t>(state.samplers.size());
    const VkShaderStageFlags stages = VK_SHADER_STAGE_FRAGMENT_BIT | passStages(state.context);
    return {
        {{gpu::kBindingTlas, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, kTlasCapacity, stages, nullptr},
         {gpu::kBindingTextures, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, textures, stages, nullptr},
         {gpu::kBindingSamplers, VK_DESCRIPTOR_TYPE_SAMPLER, samplers, stages, nullptr}}};
}

Status createLayout(GpuScene::State& state) {
    const auto bindings = makeBindings(state);
    // Update-after-bind gives higher limits: devices that otherwise see 16 textures then see 500,000.
    constexpr VkDescriptorBindingFlags kFlags[kBindings] = {VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT,
                                                            VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT,
                                                            VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT};
    VkDescriptorSetLayoutBindingFlagsCreateInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO;
    flags.bindingCount = kBindings;
    flags.pBindingFlags = kFlags;
    VkDescriptorSetLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    info.pNext = &flags;
    info.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT;
    info.bindingCount = kBindings;
    info.pBindings = bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    const VkResult result =
        state.context.vk.CreateDescriptorSetLayout(state.context.handles.device, &info, nullptr, &layout);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreateDescriptorSetLayout", result);
    }
    state.setLayout = UniqueSetLayout(state.context, layout);
    return okStatus();
}

Status allocateSet(GpuScene::State& state) {
    std::array<VkDescriptorPoolSize, kBindings> sizes{};
    const auto bindings = makeBindings(state);
    for (std::size_t i = 0; i < kBindings; ++i) {
        sizes[i] = {bindings[i].descriptorType, bindings[i].descriptorCount};
    }
    VkDescriptorPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    poolInfo.flags = VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT;
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = kBindings;
    poolInfo.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    const VkDevice device = state.context.handles.device;
    VkResult result = state.context.vk.CreateDescriptorPool(device, &poolInfo, nullptr, &pool);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreateDescriptorPool", result);
    }
    state.descriptorPool = UniqueDescriptorPool(state.context, pool);
    const VkDescriptorSetLayout layout = state.setLayout.get();
    VkDescriptorSetAllocateInfo setInfo{};
    setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    setInfo.descriptorPool = pool;
    setInfo.descriptorSetCount = 1;
    setInfo.pSetLayouts = &layout;
    result = state.context.vk.AllocateDescriptorSets(device, &setInfo, &state.set);
    if (result != VK_SUCCESS) {
        return vulkanError("vkAllocateDescriptorSets", result);
    }
    return okStatus();
}

VkWriteDescriptorSet writeOf(const GpuScene::State& state, std::uint32_t binding, VkDescriptorType type,
                             std::size_t count) {
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = state.set;
    write.dstBinding = binding;
    write.descriptorCount = static_cast<std::uint32_t>(count);
    write.descriptorType = type;
    return write;
}

void fillSet(const GpuScene::State& state) {
    const VkAccelerationStructureKHR tlas = state.tlas.handle.get();
    VkWriteDescriptorSetAccelerationStructureKHR structures{};
    structures.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR;
    structures.accelerationStructureCount = 1;
    structures.pAccelerationStructures = &tlas;
    std::vector<VkDescriptorImageInfo> textures;
    for (const DeviceImage& texture : state.textures) {
        textures.push_back({VK_NULL_HANDLE, texture.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    }
    std::vector<VkDescriptorImageInfo> samplers;
    for (const UniqueSampler& sampler : state.samplers) {
        samplers.push_back({sampler.get(), VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED});
    }
    std::array writes{
        writeOf(state, gpu::kBindingTlas, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1),
        writeOf(state, gpu::kBindingTextures, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, textures.size()),
        writeOf(state, gpu::kBindingSamplers, VK_DESCRIPTOR_TYPE_SAMPLER, samplers.size())};
    writes[0].pNext = &structures;
    writes[1].pImageInfo = textures.data();
    writes[2].pImageInfo = samplers.data();
    state.context.vk.UpdateDescriptorSets(state.context.handles.device, writes.size(), writes.data(), 0,
                                          nullptr);
}

}  // namespace

Status createSceneSet(GpuScene::State& state) {
    if (Status status = createLayout(state); !status) {
        return status;
    }
    if (Status status = allocateSet(state); !status) {
        return status;
    }
    fillSet(state);
    return okStatus();
}

}  // namespace glint
