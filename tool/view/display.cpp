#include "view/display.h"

#include <algorithm>
#include <array>

namespace glint::view {

namespace {

#include "display_shader.h"

constexpr std::uint32_t kGroup = 8;  // pixels each way, as in the shader

}  // namespace

Result<std::unique_ptr<Display>> Display::create(Context& context) {
    std::unique_ptr<Display> made(new Display(context));
    GLINT_TRY_DO(made->createPipeline());
    return made;
}

Display::~Display() {
    VkDevice device = context_.handles().device;
    vkDestroyPipeline(device, pipeline_, nullptr);
    vkDestroyPipelineLayout(device, layout_, nullptr);
    vkDestroyDescriptorPool(device, pool_, nullptr);
    vkDestroyDescriptorSetLayout(device, setLayout_, nullptr);
}

Status Display::createPipeline() {
    VkDevice device = context_.handles().device;
    std::array<VkDescriptorSetLayoutBinding, 3> bindings{};
    for (std::uint32_t i = 0; i < bindings.size(); ++i) {
        bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    }
    VkDescriptorSetLayoutCreateInfo setInfo{};
    setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    setInfo.bindingCount = static_cast<std::uint32_t>(bindings.size());
    setInfo.pBindings = bindings.data();
    GLINT_TRY_DO(checkCall("vkCreateDescriptorSetLayout",
                           vkCreateDescriptorSetLayout(device, &setInfo, nullptr, &setLayout_)));
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                    kSets * static_cast<std::uint32_t>(bindings.size())};
    VkDescriptorPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    poolInfo.maxSets = kSets;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    GLINT_TRY_DO(
        checkCall("vkCreateDescriptorPool", vkCreateDescriptorPool(device, &poolInfo, nullptr, &pool_)));
    std::array<VkDescriptorSetLayout, kSets> layouts{};
    layouts.fill(setLayout_);
    VkDescriptorSetAllocateInfo sets{};
    sets.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    sets.descriptorPool = pool_;
    sets.descriptorSetCount = kSets;
    sets.pSetLayouts = layouts.data();
    GLINT_TRY_DO(checkCall("vkAllocateDescriptorSets", vkAllocateDescriptorSets(device, &sets, sets_)));
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(DisplayOptions)};
    VkPipelineLayoutCreateInfo layoutInfo{};
    layoutInfo.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = &setLayout_;
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &range;
    GLINT_TRY_DO(
        checkCall("vkCreatePipelineLayout", vkCreatePipelineLayout(device, &layoutInfo, nullptr, &layout_)));
    VkShaderModuleCreateInfo moduleInfo{};
    moduleInfo.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    moduleInfo.codeSize = sizeof(kDisplayShader);
    moduleInfo.pCode = kDisplayShader;
    VkShaderModule module = VK_NULL_HANDLE;
    GLINT_TRY_DO(
        checkCall("vkCreateShaderModule", vkCreateShaderModule(device, &moduleInfo, nullptr, &module)));
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = layout_;
    const VkResult result = vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
    vkDestroyShaderModule(device, module, nullptr);
    return checkCall("vkCreateComputePipelines", result);
}

Result<bool> Display::resize(std::uint32_t width, std::uint32_t height) {
    if (image_.width == width && image_.height == height) {
        return false;
    }
    GLINT_TRY(image_, DeviceImage::create(context_, width, height));
    fresh_ = true;
    return true;
}

// Makes the image wait for all commands so far, in its layout.
void Display::prepare(VkCommandBuffer commands) {
    recordBarrier(commands);
    if (fresh_) {
        recordLayout(commands, image_.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
        fresh_ = false;
    }
}

Status Display::keep(const image::DisplayImage& picture) {
    constexpr std::size_t kPixelBytes = 4;
    const std::size_t bytes = picture.pixels.size() * kPixelBytes;
    if (kept_.bytes < bytes) {
        GLINT_TRY(kept_, HostBuffer::create(context_, bytes));
    }
    std::uint8_t* to = kept_.data;
    for (const std::array<std::uint8_t, 3>& pixel : picture.pixels) {
        to = std::ranges::copy(pixel, to).out;
        *to++ = 0xFF;
    }
    keptWidth_ = picture.width;
    keptHeight_ = picture.height;
    return okStatus();
}

bool Display::recordCopy(VkCommandBuffer commands) {
    if (kept_.bytes == 0 || image_.width != keptWidth_ || image_.height != keptHeight_) {
        return false;
    }
    prepare(commands);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {keptWidth_, keptHeight_, 1};
    vkCmdCopyBufferToImage(commands, kept_.handle, image_.image, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
    recordBarrier(commands);
    return true;
}

void Display::record(VkCommandBuffer commands, VkImageView first, VkImageView second,
                     const DisplayOptions& options) {
    VkDescriptorSet set = sets_[next_];
    next_ = (next_ + 1) % kSets;
    const std::array views{first, second == VK_NULL_HANDLE ? first : second, image_.view};
    std::array<VkDescriptorImageInfo, 3> images{};
    std::array<VkWriteDescriptorSet, 3> writes{};
    for (std::uint32_t i = 0; i < writes.size(); ++i) {
        images[i] = {VK_NULL_HANDLE, views[i], VK_IMAGE_LAYOUT_GENERAL};
        writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        writes[i].dstSet = set;
        writes[i].dstBinding = i;
        writes[i].descriptorCount = 1;
        writes[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        writes[i].pImageInfo = &images[i];
    }
    vkUpdateDescriptorSets(context_.handles().device, static_cast<std::uint32_t>(writes.size()),
                           writes.data(), 0, nullptr);
    prepare(commands);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set, 0, nullptr);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(options), &options);
    vkCmdDispatch(commands, (image_.width + kGroup - 1) / kGroup, (image_.height + kGroup - 1) / kGroup, 1);
    recordBarrier(commands);
}

}  // namespace glint::view
