#include "denoiser.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <utility>

namespace denoise {
namespace {

void check(VkResult result, const char* what) {
    if (result != VK_SUCCESS) {
        fail(std::string(what) + " returned " + std::to_string(result));
    }
}

// The albedo that a source's light was divided by: that of the lobes that bring it (docs/layers.md).
std::string albedoOf(const std::string& source) {
    static const std::map<std::string, std::string> kAlbedos{{"reflection", "albedo-specular"},
                                                             {"refraction", "albedo-transmission"},
                                                             {"indirect-diffuse", "albedo-diffuse"}};
    const auto found = kAlbedos.find(source);
    return found == kAlbedos.end() ? "albedo" : found->second;
}

}  // namespace

struct Image {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize bytes = 0;
};

// The layout of the shaders' push constants.
struct Push {
    std::int32_t width = 0;
    std::int32_t height = 0;
    std::int32_t stride = 1;
    float alpha = 0.0F;
    std::uint32_t isFirst = 0;
    std::uint32_t isVirtual = 0;
    std::uint32_t samples = 1;
};

// A compute shader with its bindings: sampled images, then storage images.
struct Program {
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
    std::uint32_t sampled = 0;
    std::uint32_t stored = 0;
};

constexpr VkFormat kFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr std::uint32_t kTile = 8;

// The light of one source on its way through the filter.
struct Signal {
    VkImageView light = VK_NULL_HANDLE;
    VkImageView motion = VK_NULL_HANDLE;
    VkImageView albedo = VK_NULL_HANDLE;
    VkImageView variance = VK_NULL_HANDLE;
    bool isVirtual = false;
    Image mean;                     // over the frames
    std::array<Image, 2> moments;   // of this frame and of the one before, in turn
    Image history;                  // what the next frame continues with
    std::array<Image, 2> filtered;  // in turn
};

void fail(const std::string& message) {
    std::cerr << "denoise: " << message << "\n";
    std::exit(1);
}

std::vector<std::string> wantedLayers() {
    return {"depth", "normal", "motion", "emission", "demodulated", "variance", "virtual-motion"};
}

struct Denoiser::State {
    glint::DeviceHandles device;
    Push push;
    FilterSettings settings;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    Program temporal, variance, wavelet, modulate;
    std::map<std::string, glint::LayerImage, std::less<>> layers;
    std::vector<Signal> signals;
    Image lastDepth, lastNormal, picture;
    std::vector<Image*> images;
    std::map<std::pair<const Program*, std::vector<VkImageView>>, VkDescriptorSet> sets;
    bool started = false;  // the images are in their layout
    bool first = true;     // no frame is known
    std::size_t turn = 0;  // which of `moments` is this frame's
    VkDeviceSize bytes = 0;

    VkImageView layer(const std::string& name) const {
        const auto found = layers.find(name);
        if (found == layers.end()) {
            fail("the package has no layer " + name);
        }
        return found->second.view;
    }

    std::uint32_t memoryType(std::uint32_t allowed) const {
        VkPhysicalDeviceMemoryProperties properties{};
        vkGetPhysicalDeviceMemoryProperties(device.physicalDevice, &properties);
        for (std::uint32_t i = 0; i < properties.memoryTypeCount; ++i) {
            const bool isLocal =
                (properties.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) != 0;
            if (isLocal && (allowed >> i & 1U) != 0) {
                return i;
            }
        }
        fail("the device has no memory of its own for images");
    }

    void make(Image& image, VkFormat format) {
        VkImageCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format;
        info.extent = {static_cast<std::uint32_t>(push.width), static_cast<std::uint32_t>(push.height), 1};
        info.mipLevels = 1;
        info.arrayLayers = 1;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                     VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        check(vkCreateImage(device.device, &info, nullptr, &image.image), "vkCreateImage");
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(device.device, image.image, &needs);
        VkMemoryAllocateInfo memory{};
        memory.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        memory.allocationSize = needs.size;
        memory.memoryTypeIndex = memoryType(needs.memoryTypeBits);
        check(vkAllocateMemory(device.device, &memory, nullptr, &image.memory), "vkAllocateMemory");
        check(vkBindImageMemory(device.device, image.image, image.memory, 0), "vkBindImageMemory");
        VkImageViewCreateInfo view{};
        view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
        view.image = image.image;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = format;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        check(vkCreateImageView(device.device, &view, nullptr, &image.view), "vkCreateImageView");
        bytes += needs.size;
        images.push_back(&image);
    }

    void make(Program& program, const std::filesystem::path& file, std::uint32_t sampled,
              std::uint32_t stored) {
        program.sampled = sampled;
        program.stored = stored;
        std::vector<VkDescriptorSetLayoutBinding> bindings;
        for (std::uint32_t i = 0; i < sampled + stored; ++i) {
            bindings.push_back(
                {i, i < sampled ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1,
                 VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
        }
        VkDescriptorSetLayoutCreateInfo set{};
        set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        set.bindingCount = static_cast<std::uint32_t>(bindings.size());
        set.pBindings = bindings.data();
        check(vkCreateDescriptorSetLayout(device.device, &set, nullptr, &program.setLayout),
              "vkCreateDescriptorSetLayout");
        const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Push)};
        VkPipelineLayoutCreateInfo layout{};
        layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
        layout.setLayoutCount = 1;
        layout.pSetLayouts = &program.setLayout;
        layout.pushConstantRangeCount = 1;
        layout.pPushConstantRanges = &range;
        check(vkCreatePipelineLayout(device.device, &layout, nullptr, &program.layout),
              "vkCreatePipelineLayout");

        std::ifstream stream(file, std::ios::binary | std::ios::ate);
        if (!stream) {
            fail("there is no shader " + file.string());
        }
        std::vector<std::uint32_t> words(static_cast<std::size_t>(stream.tellg()) / sizeof(std::uint32_t));
        stream.seekg(0);
        stream.read(reinterpret_cast<char*>(words.data()),
                    static_cast<std::streamsize>(words.size() * sizeof(std::uint32_t)));
        VkShaderModuleCreateInfo module{};
        module.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        module.codeSize = words.size() * sizeof(std::uint32_t);
        module.pCode = words.data();
        VkComputePipelineCreateInfo pipeline{};
        pipeline.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
        pipeline.layout = program.layout;
        pipeline.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        pipeline.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        pipeline.stage.pName = "main";
        check(vkCreateShaderModule(device.device, &module, nullptr, &pipeline.stage.module),
              "vkCreateShaderModule");
        check(
            vkCreateComputePipelines(device.device, VK_NULL_HANDLE, 1, &pipeline, nullptr, &program.pipeline),
            "vkCreateComputePipelines");
        vkDestroyShaderModule(device.device, pipeline.stage.module, nullptr);
    }

    void makePool() {
        constexpr std::uint32_t kSets = 256;
        const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 8 * kSets},
                                              {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 2 * kSets}};
        VkDescriptorPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
        info.maxSets = kSets;
        info.poolSizeCount = 2;
        info.pPoolSizes = sizes;
        check(vkCreateDescriptorPool(device.device, &info, nullptr, &pool), "vkCreateDescriptorPool");
    }

    // Sets are made once for each combination of images; images never change.
    VkDescriptorSet setOf(const Program& program, const std::vector<VkImageView>& views) {
        VkDescriptorSet& set = sets[{&program, views}];
        if (set != VK_NULL_HANDLE) {
            return set;
        }
        VkDescriptorSetAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
        info.descriptorPool = pool;
        info.descriptorSetCount = 1;
        info.pSetLayouts = &program.setLayout;
        check(vkAllocateDescriptorSets(device.device, &info, &set), "vkAllocateDescriptorSets");
        for (std::uint32_t i = 0; i < views.size(); ++i) {
            const VkDescriptorImageInfo image{VK_NULL_HANDLE, views[i], VK_IMAGE_LAYOUT_GENERAL};
            VkWriteDescriptorSet write{};
            write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
            write.dstSet = set;
            write.dstBinding = i;
            write.descriptorCount = 1;
            write.descriptorType =
                i < program.sampled ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
            write.pImageInfo = &image;
            vkUpdateDescriptorSets(device.device, 1, &write, 0, nullptr);
        }
        return set;
    }

    // What came before is visible to what follows.
    static void barrier(VkCommandBuffer commands) {
        VkMemoryBarrier2 memory{};
        memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
        memory.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        memory.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
        memory.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        memory.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        VkDependencyInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
        info.memoryBarrierCount = 1;
        info.pMemoryBarriers = &memory;
        vkCmdPipelineBarrier2(commands, &info);
    }

    void start(VkCommandBuffer commands) {
        for (const Image* const image : images) {
            VkImageMemoryBarrier2 change{};
            change.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
            change.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
            change.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
            change.newLayout = VK_IMAGE_LAYOUT_GENERAL;
            change.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
            change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
            change.image = image->image;
            change.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
            VkDependencyInfo info{};
            info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
            info.imageMemoryBarrierCount = 1;
            info.pImageMemoryBarriers = &change;
            vkCmdPipelineBarrier2(commands, &info);
        }
        started = true;
    }

    void run(VkCommandBuffer commands, const Program& program, const std::vector<VkImageView>& views,
             const Push& constants) {
        const VkDescriptorSet set = setOf(program, views);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.pipeline);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.layout, 0, 1, &set, 0,
                                nullptr);
        vkCmdPushConstants(commands, program.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants),
                           &constants);
        vkCmdDispatch(commands, (static_cast<std::uint32_t>(push.width) + kTile - 1) / kTile,
                      (static_cast<std::uint32_t>(push.height) + kTile - 1) / kTile, 1);
        barrier(commands);
    }

    void copy(VkCommandBuffer commands, VkImage from, VkImage to) const {
        VkImageCopy region{};
        region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.dstSubresource = region.srcSubresource;
        region.extent = {static_cast<std::uint32_t>(push.width), static_cast<std::uint32_t>(push.height), 1};
        vkCmdCopyImage(commands, from, VK_IMAGE_LAYOUT_GENERAL, to, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
    }

    void filter(VkCommandBuffer commands, Signal& signal, bool isFirstSignal) {
        const VkImageView depth = layer("depth");
        const VkImageView normal = layer("normal");
        Push constants = push;
        constants.isFirst = first ? 1 : 0;
        constants.isVirtual = signal.isVirtual ? 1 : 0;
        const Image& moments = signal.moments[turn];
        run(commands, temporal,
            {signal.light, signal.motion, depth, normal, lastDepth.view, lastNormal.view, signal.history.view,
             signal.moments[1 - turn].view, signal.mean.view, moments.view},
            constants);
        run(commands, variance,
            {signal.mean.view, moments.view, depth, normal, signal.variance, signal.albedo,
             signal.filtered[0].view},
            constants);
        std::size_t source = 0;
        for (std::uint32_t i = 0; i < settings.wavelets; ++i) {
            if (i == settings.historyAfter) {
                copy(commands, signal.filtered[source].image, signal.history.image);
                barrier(commands);
            }
            constants.stride = 1 << i;
            run(commands, wavelet,
                {signal.filtered[source].view, depth, normal, signal.filtered[1 - source].view}, constants);
            source = 1 - source;
        }
        if (settings.historyAfter >= settings.wavelets) {
            copy(commands, signal.filtered[source].image, signal.history.image);
            barrier(commands);
        }
        constants.isFirst = isFirstSignal ? 1 : 0;
        run(commands, modulate,
            {signal.filtered[source].view, signal.albedo, layer("emission"), picture.view}, constants);
    }
};

Denoiser::Denoiser(const glint::DeviceHandles& device, const glint::Renderer& renderer, std::uint32_t width,
                   std::uint32_t height, const std::filesystem::path& shaders, FilterSettings settings)
    : state_(std::make_unique<State>()) {
    State& state = *state_;
    state.device = device;
    state.settings = settings;
    state.push.width = static_cast<std::int32_t>(width);
    state.push.height = static_cast<std::int32_t>(height);
    state.push.alpha = settings.alpha;
    state.push.samples = settings.samples;
    for (const glint::LayerImage& layer : renderer.layers()) {
        state.layers.emplace(layer.name, layer);
    }
    state.make(state.temporal, shaders / "temporal.comp.spv", 8, 2);
    state.make(state.variance, shaders / "variance.comp.spv", 6, 1);
    state.make(state.wavelet, shaders / "wavelet.comp.spv", 3, 1);
    state.make(state.modulate, shaders / "modulate.comp.spv", 3, 1);
    state.makePool();
    // A signal for each source of light.
    for (const auto& [name, image] : state.layers) {
        if (image.info->name != "demodulated") {
            continue;
        }
        const std::string source = name.substr(0, name.find('.'));
        Signal signal;
        signal.light = image.view;
        signal.albedo = state.layer(albedoOf(source));
        signal.variance = state.layer(source + ".variance");
        signal.isVirtual = state.layers.contains(source + ".virtual-motion");
        signal.motion = state.layer(signal.isVirtual ? source + ".virtual-motion" : "motion");
        state.signals.push_back(std::move(signal));
    }
    for (Signal& signal : state.signals) {
        for (Image* const image : {&signal.mean, &signal.moments[0], &signal.moments[1], &signal.history,
                                   &signal.filtered[0], &signal.filtered[1]}) {
            state.make(*image, kFormat);
        }
    }
    state.make(state.lastDepth, state.layers.at("depth").format);
    state.make(state.lastNormal, state.layers.at("normal").format);
    state.make(state.picture, kFormat);
}

Denoiser::~Denoiser() {
    State& state = *state_;
    const VkDevice device = state.device.device;
    for (const Image* const image : state.images) {
        vkDestroyImageView(device, image->view, nullptr);
        vkDestroyImage(device, image->image, nullptr);
        vkFreeMemory(device, image->memory, nullptr);
    }
    for (const Program* const program : {&state.temporal, &state.variance, &state.wavelet, &state.modulate}) {
        vkDestroyPipeline(device, program->pipeline, nullptr);
        vkDestroyPipelineLayout(device, program->layout, nullptr);
        vkDestroyDescriptorSetLayout(device, program->setLayout, nullptr);
    }
    vkDestroyDescriptorPool(device, state.pool, nullptr);
}

void Denoiser::record(VkCommandBuffer commands) {
    State& state = *state_;
    if (!state.started) {
        state.start(commands);
    }
    State::barrier(commands);
    bool isFirst = true;
    for (Signal& signal : state.signals) {
        state.filter(commands, signal, std::exchange(isFirst, false));
    }
    state.copy(commands, state.layers.at("depth").image, state.lastDepth.image);
    state.copy(commands, state.layers.at("normal").image, state.lastNormal.image);
    State::barrier(commands);
    state.turn = 1 - state.turn;
    state.first = false;
}

void Denoiser::restart() {
    state_->first = true;
}

VkImage Denoiser::output() const {
    return state_->picture.image;
}

std::uint64_t Denoiser::bytes() const {
    return state_->bytes;
}

}  // namespace denoise
