#include "denoiser.h"

#include "denoise_antialias.h"
#include "denoise_guide.h"
#include "denoise_modulate.h"
#include "denoise_temporal.h"
#include "denoise_variance.h"
#include "denoise_wavelet.h"
#include "vulkan.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <span>
#include <utility>

namespace denoise {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr std::uint32_t kTile = 8;
constexpr std::uint32_t kSets = 64;
// Bits of Push::virtualSignals.
constexpr std::size_t kMostSignals = 32;

// The albedo that a source's light was divided by: that of the lobes that bring it (docs/layers.md).
std::string albedoOf(const std::string& source) {
    static const std::map<std::string, std::string> kAlbedos{{"reflection", "albedo-specular"},
                                                             {"refraction", "albedo-transmission"},
                                                             {"indirect-diffuse", "albedo-diffuse"}};
    const auto found = kAlbedos.find(source);
    return found == kAlbedos.end() ? "albedo" : found->second;
}

glint::Diagnostic callError(const char* call, VkResult result) {
    return {glint::Severity::Error, "vulkan-call", "",
            std::string(call) + " failed with " + std::to_string(result),
            "use smaller pictures, or another device"};
}

#define DENOISE_CHECK(call)                                              \
    if (const VkResult checked = state.vk.call; checked != VK_SUCCESS) { \
        return callError("vk" #call, checked);                           \
    }

}  // namespace

// The layout of the shaders' push constants: svgf.glsl.
struct Push {
    std::int32_t width = 0;
    std::int32_t height = 0;
    std::int32_t stride = 1;
    std::int32_t signal = 0;
    std::uint32_t virtualSignals = 0;
    std::uint32_t isFirst = 0;
    std::uint32_t samples = 1;
    float alpha = 0.0F;
};

struct Image {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
};

// A compute shader with its bindings: sampled images, then storage images.
struct Program {
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
    std::uint32_t sampled = 0;
};

// The images of the light of one source that are read.
struct Signal {
    VkImageView light = VK_NULL_HANDLE;
    VkImageView variance = VK_NULL_HANDLE;
    VkImageView virtualMotion = VK_NULL_HANDLE;
    VkImageView albedo = VK_NULL_HANDLE;
};

std::vector<std::string> imageLayers() {
    return {"virtual-motion"};
}

std::vector<std::string> wantedLayers() {
    return {"depth", "normal", "roughness", "motion", "emission", "demodulated", "variance"};
}

struct Denoiser::State {
    glint::DeviceHandles device;
    Functions vk;
    Push push;
    FilterSettings settings;
    std::map<std::string, VkImageView, std::less<>> layers;
    std::vector<Signal> signals;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    Program guide, temporal, variance, wavelet, modulate, antialias;
    // Frames write the two images of each by turns, and read what the frame before has written.
    std::array<Image, 2> guides, moments, resolved;
    Image surfaces, mean, history, picture;
    std::array<Image, 2> filtered;  // what passes of the wavelet read and write, in turn
    std::vector<Image*> images;
    std::map<std::pair<const Program*, std::vector<VkImageView>>, VkDescriptorSet> sets;
    bool isStarted = false;  // the images are in their layout
    bool isFirst = true;     // no frame is known
    std::size_t turn = 0;    // which images are this frame's
    VkDeviceSize bytes = 0;
    // For filter().
    VkCommandPool commandPool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkQueryPool queries = VK_NULL_HANDLE;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory bufferMemory = VK_NULL_HANDLE;
    const float* pixels = nullptr;
    double milliseconds = 0.0;

    ~State() {
        for (const Image* const image : images) {
            vk.DestroyImageView(device.device, image->view, nullptr);
            vk.DestroyImage(device.device, image->image, nullptr);
            vk.FreeMemory(device.device, image->memory, nullptr);
        }
        for (const Program* const program : {&guide, &temporal, &variance, &wavelet, &modulate, &antialias}) {
            if (program->setLayout != VK_NULL_HANDLE) {
                vk.DestroyPipeline(device.device, program->pipeline, nullptr);
                vk.DestroyPipelineLayout(device.device, program->layout, nullptr);
                vk.DestroyDescriptorSetLayout(device.device, program->setLayout, nullptr);
            }
        }
        if (pool != VK_NULL_HANDLE) {
            vk.DestroyDescriptorPool(device.device, pool, nullptr);
        }
        if (commandPool != VK_NULL_HANDLE) {
            vk.DestroyCommandPool(device.device, commandPool, nullptr);
            vk.DestroyQueryPool(device.device, queries, nullptr);
            vk.DestroyBuffer(device.device, buffer, nullptr);
            vk.FreeMemory(device.device, bufferMemory, nullptr);
        }
    }

    glint::Result<VkDeviceMemory> allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
        State& state = *this;
        VkPhysicalDeviceMemoryProperties properties{};
        vk.GetPhysicalDeviceMemoryProperties(device.physicalDevice, &properties);
        VkMemoryAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        info.allocationSize = needs.size;
        while (info.memoryTypeIndex < properties.memoryTypeCount &&
               ((needs.memoryTypeBits >> info.memoryTypeIndex & 1U) == 0 ||
                (properties.memoryTypes[info.memoryTypeIndex].propertyFlags & wanted) != wanted)) {
            ++info.memoryTypeIndex;
        }
        if (info.memoryTypeIndex == properties.memoryTypeCount) {
            return callError("vkAllocateMemory", VK_ERROR_OUT_OF_DEVICE_MEMORY);
        }
        VkDeviceMemory memory = VK_NULL_HANDLE;
        DENOISE_CHECK(AllocateMemory(device.device, &info, nullptr, &memory))
        return memory;
    }

    // An image of one layer, or an array of `count`.
    glint::Status make(Image& image, VkImageViewType type, std::uint32_t count = 1) {
        State& state = *this;
        VkImageCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = kFormat;
        info.extent = {static_cast<std::uint32_t>(push.width), static_cast<std::uint32_t>(push.height), 1};
        info.mipLevels = 1;
        info.arrayLayers = count;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage =
            VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        images.push_back(&image);
        DENOISE_CHECK(CreateImage(device.device, &info, nullptr, &image.image))
        VkMemoryRequirements needs{};
        vk.GetImageMemoryRequirements(device.device, image.image, &needs);
        GLINT_TRY(image.memory, allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT));
        DENOISE_CHECK(BindImageMemory(device.device, image.image, image.memory, 0))
        VkImageViewCreateInfo view{};
        view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
        view.image = image.image;
        view.viewType = type;
        view.format = kFormat;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, count};
        DENOISE_CHECK(CreateImageView(device.device, &view, nullptr, &image.view))
        bytes += needs.size;
        return glint::okStatus();
    }

    glint::Status make(Program& program, std::span<const std::uint32_t> code, std::uint32_t sampled,
                       std::uint32_t stored) {
        State& state = *this;
        program.sampled = sampled;
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
        DENOISE_CHECK(CreateDescriptorSetLayout(device.device, &set, nullptr, &program.setLayout))
        const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Push)};
        VkPipelineLayoutCreateInfo layout{};
        layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
        layout.setLayoutCount = 1;
        layout.pSetLayouts = &program.setLayout;
        layout.pushConstantRangeCount = 1;
        layout.pPushConstantRanges = &range;
        DENOISE_CHECK(CreatePipelineLayout(device.device, &layout, nullptr, &program.layout))
        VkShaderModuleCreateInfo module{};
        module.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        module.codeSize = code.size_bytes();
        module.pCode = code.data();
        VkShaderModule made = VK_NULL_HANDLE;
        DENOISE_CHECK(CreateShaderModule(device.device, &module, nullptr, &made))
        const auto count = static_cast<std::int32_t>(signals.size());
        const VkSpecializationMapEntry entry{0, 0, sizeof(count)};
        const VkSpecializationInfo constants{1, &entry, sizeof(count), &count};
        VkComputePipelineCreateInfo pipeline{};
        pipeline.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
        pipeline.layout = program.layout;
        pipeline.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        pipeline.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        pipeline.stage.module = made;
        pipeline.stage.pName = "main";
        pipeline.stage.pSpecializationInfo = &constants;
        const VkResult result = vk.CreateComputePipelines(device.device, VK_NULL_HANDLE, 1, &pipeline,
                                                          nullptr, &program.pipeline);
        vk.DestroyShaderModule(device.device, made, nullptr);
        return result == VK_SUCCESS ? glint::okStatus()
                                    : glint::Status(callError("vkCreateComputePipelines", result));
    }

    glint::Status makePool() {
        State& state = *this;
        const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 10 * kSets},
                                              {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 2 * kSets}};
        VkDescriptorPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
        info.maxSets = kSets + 4 * static_cast<std::uint32_t>(signals.size());
        info.poolSizeCount = 2;
        info.pPoolSizes = sizes;
        DENOISE_CHECK(CreateDescriptorPool(device.device, &info, nullptr, &pool))
        return glint::okStatus();
    }

    // The resources of filter(): commands, a buffer that the host reads, and two times.
    glint::Status makeReading() {
        State& state = *this;
        VkCommandPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
        info.queueFamilyIndex = device.queueFamily;
        DENOISE_CHECK(CreateCommandPool(device.device, &info, nullptr, &commandPool))
        VkCommandBufferAllocateInfo allocated{};
        allocated.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        allocated.commandPool = commandPool;
        allocated.commandBufferCount = 1;
        DENOISE_CHECK(AllocateCommandBuffers(device.device, &allocated, &commands))
        VkQueryPoolCreateInfo times{};
        times.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        times.queryType = VK_QUERY_TYPE_TIMESTAMP;
        times.queryCount = 2;
        DENOISE_CHECK(CreateQueryPool(device.device, &times, nullptr, &queries))
        VkBufferCreateInfo size{};
        size.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        size.size = VkDeviceSize{16} * static_cast<std::uint32_t>(push.width) *
                    static_cast<std::uint32_t>(push.height);
        size.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        DENOISE_CHECK(CreateBuffer(device.device, &size, nullptr, &buffer))
        VkMemoryRequirements needs{};
        vk.GetBufferMemoryRequirements(device.device, buffer, &needs);
        GLINT_TRY(bufferMemory, allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                    VK_MEMORY_PROPERTY_HOST_COHERENT_BIT));
        void* mapped = nullptr;
        DENOISE_CHECK(BindBufferMemory(device.device, buffer, bufferMemory, 0))
        DENOISE_CHECK(MapMemory(device.device, bufferMemory, 0, VK_WHOLE_SIZE, 0, &mapped))
        pixels = static_cast<const float*>(mapped);
        return glint::okStatus();
    }

    // Finds the layers of each source of light.
    glint::Status findSignals(const glint::Renderer& renderer) {
        for (const glint::Renderer::LayerImage& layer : renderer.layers()) {
            layers.emplace(layer.name, layer.view);
        }
        const auto view = [this](const std::string& name) {
            const auto found = layers.find(name);
            return found == layers.end() ? VkImageView{VK_NULL_HANDLE} : found->second;
        };
        std::vector<std::string> needed{"depth", "normal", "roughness", "motion", "emission"};
        for (const glint::Renderer::LayerImage& layer : renderer.layers()) {
            if (layer.info->name != "demodulated" || signals.size() == kMostSignals) {
                continue;
            }
            const std::string source(layer.name.substr(0, layer.name.find('.')));
            const VkImageView virtualMotion = view(source + ".virtual-motion");
            if (virtualMotion != VK_NULL_HANDLE) {
                push.virtualSignals |= 1U << signals.size();
            }
            needed.insert(needed.end(), {source + ".variance", albedoOf(source)});
            signals.push_back({layer.view, view(source + ".variance"),
                               virtualMotion != VK_NULL_HANDLE ? virtualMotion : view("motion"),
                               view(albedoOf(source))});
        }
        needed.resize(needed.size() + (signals.empty() ? 1 : 0), "direct.demodulated");
        for (const std::string& name : needed) {
            if (!layers.contains(name)) {
                return glint::Diagnostic{glint::Severity::Error, "layer-missing", "",
                                         "the package has no layer " + name + ", which the denoiser reads",
                                         "compile it with the layers that the denoiser wants"};
            }
        }
        return glint::okStatus();
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
        vk.AllocateDescriptorSets(device.device, &info, &set);
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
            vk.UpdateDescriptorSets(device.device, 1, &write, 0, nullptr);
        }
        return set;
    }

    // Earlier writes are visible to later commands.
    void barrier(VkCommandBuffer into) const {
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
        vk.CmdPipelineBarrier2(into, &info);
    }

    void start(VkCommandBuffer into) {
        for (const Image* const image : images) {
            VkImageMemoryBarrier2 change{};
            change.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
            change.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
            change.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
            change.newLayout = VK_IMAGE_LAYOUT_GENERAL;
            change.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
            change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
            change.image = image->image;
            change.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS};
            VkDependencyInfo info{};
            info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
            info.imageMemoryBarrierCount = 1;
            info.pImageMemoryBarriers = &change;
            vk.CmdPipelineBarrier2(into, &info);
        }
        isStarted = true;
    }

    // Runs a shader for each pixel. What follows it needs a barrier.
    void run(VkCommandBuffer into, const Program& program, const std::vector<VkImageView>& views,
             const Push& constants) {
        const VkDescriptorSet set = setOf(program, views);
        vk.CmdBindPipeline(into, VK_PIPELINE_BIND_POINT_COMPUTE, program.pipeline);
        vk.CmdBindDescriptorSets(into, VK_PIPELINE_BIND_POINT_COMPUTE, program.layout, 0, 1, &set, 0,
                                 nullptr);
        vk.CmdPushConstants(into, program.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants),
                            &constants);
        vk.CmdDispatch(into, (static_cast<std::uint32_t>(push.width) + kTile - 1) / kTile,
                       (static_cast<std::uint32_t>(push.height) + kTile - 1) / kTile, 1);
    }

    void accumulate(VkCommandBuffer into) {
        Push constants = push;
        constants.isFirst = isFirst ? 1 : 0;
        run(into, guide,
            {layers.at("depth"), layers.at("normal"), layers.at("roughness"), guides[turn].view,
             surfaces.view},
            constants);
        barrier(into);
        for (const Signal& signal : signals) {
            run(into, temporal,
                {signal.light, layers.at("motion"), signal.virtualMotion, signal.variance, signal.albedo,
                 guides[turn].view, surfaces.view, guides[1 - turn].view, history.view,
                 moments[1 - turn].view, mean.view, moments[turn].view},
                constants);
            ++constants.signal;
        }
        barrier(into);
    }

    // Returns the image that holds the filtered light.
    VkImageView smooth(VkCommandBuffer into) {
        Push constants = push;
        const Image* source = settings.wavelets == 0 ? &history : filtered.data();
        run(into, variance, {mean.view, moments[turn].view, guides[turn].view, surfaces.view, source->view},
            constants);
        barrier(into);
        const std::uint32_t historyAfter =
            std::clamp(settings.historyAfter, 1U, std::max(settings.wavelets, 1U));
        for (std::uint32_t i = 0; i < settings.wavelets; ++i) {
            const Image* const target = i + 1 == historyAfter       ? &history
                                        : source == filtered.data() ? &filtered[1]
                                                                    : filtered.data();
            constants.stride = 1 << i;
            run(into, wavelet, {source->view, guides[turn].view, surfaces.view, target->view}, constants);
            barrier(into);
            source = target;
        }
        return source->view;
    }
};

Denoiser::Denoiser(std::unique_ptr<State> state) : state_(std::move(state)) {}
Denoiser::~Denoiser() = default;

glint::Result<std::unique_ptr<Denoiser>> Denoiser::create(const glint::Context& context,
                                                          const glint::Renderer& renderer,
                                                          std::uint32_t width, std::uint32_t height,
                                                          const FilterSettings& settings) {
    auto made = std::make_unique<State>();
    State& state = *made;
    GLINT_TRY(state.vk, loadFunctions(context.handles()));
    state.device = context.handles();
    state.settings = settings;
    state.push.width = static_cast<std::int32_t>(width);
    state.push.height = static_cast<std::int32_t>(height);
    state.push.alpha = settings.alpha;
    state.push.samples = settings.samples;
    GLINT_TRY_DO(state.findSignals(renderer));
    const struct {
        Program* program;
        std::span<const std::uint32_t> code;
        std::uint32_t sampled;
        std::uint32_t stored;
    } programs[] = {{&state.guide, kGuideShader, 3, 2},       {&state.temporal, kTemporalShader, 10, 2},
                    {&state.variance, kVarianceShader, 4, 1}, {&state.wavelet, kWaveletShader, 3, 1},
                    {&state.modulate, kModulateShader, 3, 1}, {&state.antialias, kAntialiasShader, 4, 1}};
    for (const auto& program : programs) {
        GLINT_TRY_DO(state.make(*program.program, program.code, program.sampled, program.stored));
    }
    const auto count = static_cast<std::uint32_t>(state.signals.size());
    for (Image* const image : {state.guides.data(), &state.guides[1], state.resolved.data(),
                               &state.resolved[1], &state.surfaces, &state.picture}) {
        GLINT_TRY_DO(state.make(*image, VK_IMAGE_VIEW_TYPE_2D));
    }
    for (Image* const image : {state.moments.data(), &state.moments[1], state.filtered.data(),
                               &state.filtered[1], &state.mean, &state.history}) {
        GLINT_TRY_DO(state.make(*image, VK_IMAGE_VIEW_TYPE_2D_ARRAY, count));
    }
    GLINT_TRY_DO(state.makePool());
    GLINT_TRY_DO(state.makeReading());
    return std::unique_ptr<Denoiser>(new Denoiser(std::move(made)));
}

void Denoiser::record(VkCommandBuffer commands) {
    State& state = *state_;
    if (!state.isStarted) {
        state.start(commands);
    }
    state.barrier(commands);
    state.turn = 1 - state.turn;
    state.accumulate(commands);
    const VkImageView light = state.smooth(commands);
    Push constants = state.push;
    constants.isFirst = 1;
    for (const Signal& signal : state.signals) {
        state.run(commands, state.modulate,
                  {light, signal.albedo, state.layers.at("emission"), state.picture.view}, constants);
        state.barrier(commands);
        constants.isFirst = 0;
        ++constants.signal;
    }
    constants.isFirst = state.isFirst ? 1 : 0;
    state.run(commands, state.antialias,
              {state.picture.view, state.resolved[1 - state.turn].view, state.layers.at("motion"),
               state.guides[state.turn].view, state.resolved[state.turn].view},
              constants);
    state.barrier(commands);
    state.isFirst = false;
}

glint::Result<glint::LinearImage> Denoiser::filter() {
    State& state = *state_;
    const Functions& vk = state.vk;
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    DENOISE_CHECK(BeginCommandBuffer(state.commands, &begin))
    vk.CmdResetQueryPool(state.commands, state.queries, 0, 2);
    vk.CmdWriteTimestamp2(state.commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, state.queries, 0);
    record(state.commands);
    vk.CmdWriteTimestamp2(state.commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, state.queries, 1);
    const auto width = static_cast<std::uint32_t>(state.push.width);
    const auto height = static_cast<std::uint32_t>(state.push.height);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {width, height, 1};
    vk.CmdCopyImageToBuffer(state.commands, output(), VK_IMAGE_LAYOUT_GENERAL, state.buffer, 1, &region);
    state.barrier(state.commands);
    VkMemoryBarrier2 toHost{};
    toHost.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    toHost.srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
    toHost.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    toHost.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    toHost.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &toHost;
    vk.CmdPipelineBarrier2(state.commands, &dependency);
    DENOISE_CHECK(EndCommandBuffer(state.commands))
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &state.commands;
    DENOISE_CHECK(QueueSubmit(state.device.queue, 1, &submit, VK_NULL_HANDLE))
    DENOISE_CHECK(QueueWaitIdle(state.device.queue))
    std::array<std::uint64_t, 2> times{};
    DENOISE_CHECK(GetQueryPoolResults(state.device.device, state.queries, 0, 2, sizeof(times), times.data(),
                                      sizeof(times[0]), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT))
    VkPhysicalDeviceProperties properties{};
    vk.GetPhysicalDeviceProperties(state.device.physicalDevice, &properties);
    state.milliseconds = static_cast<double>(times[1] - times[0]) * properties.limits.timestampPeriod * 1e-6;
    glint::LinearImage image{width, height, {}};
    image.pixels.resize(std::size_t{width} * height);
    std::memcpy(image.pixels.data(), state.pixels, image.pixels.size() * sizeof(image.pixels[0]));
    for (std::array<float, 4>& pixel : image.pixels) {
        pixel[3] = 1.0F;
    }
    return image;
}

void Denoiser::restart() {
    state_->isFirst = true;
}

VkImage Denoiser::output() const {
    return state_->resolved[state_->turn].image;
}

double Denoiser::milliseconds() const {
    return state_->milliseconds;
}

std::uint64_t Denoiser::bytes() const {
    return state_->bytes;
}

}  // namespace denoise
