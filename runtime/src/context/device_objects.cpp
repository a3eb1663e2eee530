#include "context/device_objects.h"

#include <string>
#include <vector>

namespace glint {

void nameObject(const Context::State& context, VkObjectType type, std::uint64_t handle,
                std::string_view name) {
    if (context.vk.SetDebugUtilsObjectNameEXT == nullptr) {
        return;
    }
    const std::string text = context.services.namePrefix + std::string(name);
    const VkDebugUtilsObjectNameInfoEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                             .objectType = type,
                                             .objectHandle = handle,
                                             .pObjectName = text.c_str()};
    context.vk.SetDebugUtilsObjectNameEXT(context.handles.device, &info);
}

Result<UniqueSetLayout> createSetLayout(Context::State& context,
                                        std::span<const VkDescriptorSetLayoutBinding> bindings,
                                        std::span<const VkDescriptorBindingFlags> flags) {
    const VkDescriptorSetLayoutBindingFlagsCreateInfo bindingFlags{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO,
        .bindingCount = static_cast<std::uint32_t>(flags.size()),
        .pBindingFlags = flags.data()};
    VkDescriptorSetLayoutCreateFlags ofLayout = 0;
    for (const VkDescriptorBindingFlags flag : flags) {
        if ((flag & VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT) != 0) {
            ofLayout = VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT;
        }
    }
    const VkDescriptorSetLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                               .pNext = flags.empty() ? nullptr : &bindingFlags,
                                               .flags = ofLayout,
                                               .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                               .pBindings = bindings.data()};
    return createHandle<UniqueSetLayout>(context, context.vk.CreateDescriptorSetLayout,
                                         "vkCreateDescriptorSetLayout", info);
}

Result<DescriptorSet> createSet(Context::State& context, VkDescriptorSetLayout layout,
                                std::span<const VkDescriptorSetLayoutBinding> bindings, bool updates) {
    std::vector<VkDescriptorPoolSize> sizes;
    for (const VkDescriptorSetLayoutBinding& binding : bindings) {
        sizes.push_back({binding.descriptorType, binding.descriptorCount});
    }
    VkDescriptorPoolCreateFlags flags = 0;
    if (updates) {
        flags = VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT;
    }
    const VkDescriptorPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                              .flags = flags,
                                              .maxSets = 1,
                                              .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                              .pPoolSizes = sizes.data()};
    DescriptorSet made;
    GLINT_TRY(made.pool, createHandle<UniqueDescriptorPool>(context, context.vk.CreateDescriptorPool,
                                                            "vkCreateDescriptorPool", poolInfo));
    const VkDescriptorSetAllocateInfo setInfo{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = made.pool.get(),
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &layout};
    GLINT_TRY_DO(statusOf("vkAllocateDescriptorSets",
                          context.vk.AllocateDescriptorSets(context.handles.device, &setInfo, &made.set)));
    nameObject(context, VK_OBJECT_TYPE_DESCRIPTOR_SET, (std::uint64_t)made.set, "set");  // NOLINT: pointer
    return made;
}

void writeImages(const Context::State& context, VkDescriptorSet set, std::uint32_t binding,
                 VkDescriptorType type, std::span<const VkDescriptorImageInfo> images) {
    const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .dstSet = set,
                                     .dstBinding = binding,
                                     .descriptorCount = static_cast<std::uint32_t>(images.size()),
                                     .descriptorType = type,
                                     .pImageInfo = images.data()};
    context.vk.UpdateDescriptorSets(context.handles.device, 1, &write, 0, nullptr);
}

Result<UniquePipelineLayout> createPipelineLayout(Context::State& context,
                                                  std::span<const VkDescriptorSetLayout> sets,
                                                  const VkPushConstantRange& range) {
    const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                          .setLayoutCount = static_cast<std::uint32_t>(sets.size()),
                                          .pSetLayouts = sets.data(),
                                          .pushConstantRangeCount = 1,
                                          .pPushConstantRanges = &range};
    return createHandle<UniquePipelineLayout>(context, context.vk.CreatePipelineLayout,
                                              "vkCreatePipelineLayout", info);
}

}  // namespace glint
