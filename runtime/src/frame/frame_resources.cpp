#include "frame/frame_resources.h"

#include "context/commands.h"
#include "context/device_objects.h"
#include "context/vulkan_table.h"
#include "frame/bounce_levels.h"

#include <algorithm>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glint {

VkDeviceSize listRays(const FrameSize& size) {
    return size.pixelsOfBand() * size.batchCount;
}

VkDeviceSize orderedSlots(const FrameSize& size, VkDeviceSize hits) {
    return hits + VkDeviceSize{size.bucketCount} * (size.bucketAlignment - 1);
}

VkDeviceSize listSlots(const FrameSize& size) {
    return orderedSlots(size, std::max(listRays(size), size.firstHits()));
}

// Lists are dispatched in one dimension. A dispatch over an image is no wider, and its height is within the
// limits of images, which are below those of dispatches.
std::uint64_t maxRayDispatch(const DeviceLimits& limits) {
    const std::uint64_t width =
        std::uint64_t{limits.core.maxComputeWorkGroupCount[0]} * limits.core.maxComputeWorkGroupSize[0];
    return std::min<std::uint64_t>(width, limits.rayPipeline.maxRayDispatchInvocationCount);
}

VkDeviceSize counterBytes(const FrameSize& size) {
    const VkDeviceSize ofEffects =
        VkDeviceSize{gpu::kCounterCopies} * gpu::kCountsOfEffect * package::countedEffects(size.effects);
    return sizeof(std::uint32_t) * (gpu::kCounterEffects + ofEffects + size.textureLevels);
}

VkDeviceSize bucketBytes(const FrameSize& size) {
    return sizeof(std::uint32_t) * size.bucketCount;
}

VkDeviceSize readbackFirst(const FrameSize& size, std::uint32_t band) {
    return counterBytes(size) + (size.hostRays ? 0 : band * bucketBytes(size));
}

VkDeviceSize readbackRound(const FrameSize& size, std::uint32_t round) {
    const VkDeviceSize buckets = size.ordered ? bucketBytes(size) : 0;
    return readbackFirst(size, size.hostRays ? 0 : size.bandCount()) + round * (kRoundCounterBytes + buckets);
}

VkDeviceSize readbackDepth(const FrameSize& size, std::uint32_t slot) {
    return readbackRound(size, size.roundCount()) + slot * sizeof(std::uint32_t);
}

Status checkFrameSize(const Context::State& context, const FrameSize& size) {
    const VkPhysicalDeviceLimits& limits = context.limits.core;
    const std::uint32_t maxWidth = std::min(limits.maxImageDimension2D, limits.maxFramebufferWidth);
    const std::uint32_t maxHeight = std::min(limits.maxImageDimension2D, limits.maxFramebufferHeight);
    const std::size_t images = gpu::kFrameImageCount + size.layers.size();
    if (images > std::min(limits.maxPerStageDescriptorStorageImages, limits.maxDescriptorSetStorageImages)) {
        return makeError("device-layers", "",
                         phrase("the package has ", size.layers.size(),
                                " layers, and shaders of the device can write no more than ",
                                limits.maxPerStageDescriptorStorageImages, " images"),
                         "compile the package with fewer --layers");
    }
    const std::string asked = phrase(size.width, " x ", size.height);
    if (size.width == 0 || size.height == 0 || size.width > maxWidth || size.height > maxHeight) {
        return makeError("render-size", "", "an image of " + asked + " pixels cannot be rendered",
                         phrase("use 1 x 1 to ", maxWidth, " x ", maxHeight));
    }
    const std::uint64_t samples = std::uint64_t{size.width} * size.height * std::max(size.sampleCount, 1U);
    // There is a sample for every pixel and effect, and 32 bits number the samples.
    if (samples > std::numeric_limits<std::uint32_t>::max() ||
        size.pixelsOfBand() * size.sampleCount * sizeof(gpu::SampleStart) > context.limits.maxBufferBytes) {
        return makeError("render-size", "",
                         "the rays of " + asked + " pixels do not fit a buffer of the device",
                         "render a smaller image");
    }
    if (size.rayPipeline && listSlots(size) > maxRayDispatch(context.limits)) {
        return makeError(
            "render-size", "",
            phrase("the rays of ", asked, " pixels are more than one dispatch of the device's ray ",
                   "tracing pipelines holds, which is ", maxRayDispatch(context.limits)),
            "render a smaller image, or use the tracer ray-query");
    }
    return okStatus();
}

namespace {

// Returns whether the shaders of the frame's package use an image.
bool bindsImage(const FrameSize& size, std::uint32_t binding) {
    return binding != gpu::kBindingPosition || size.effects.screenStarts != 0;
}

// Returns whether an image has memory of its own. The other images are never written, or are written before
// the picture is.
bool hasImage(const FrameSize& size, std::uint32_t binding) {
    switch (binding) {
        case gpu::kBindingRadiance:
        case gpu::kBindingResidual:
            return size.accumulates;
        case gpu::kBindingPosition:
            return size.effects.screenStarts != 0 && size.marchesScreen;
        default:
            return true;
    }
}

Status createImages(Context::State& context, const FrameSize& size, FrameResources& frame) {
    constexpr VkImageUsageFlags kStored =
        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    ImageInfo info{.extent = {size.width, size.height}};
    for (std::uint32_t binding = 0; binding < gpu::kFrameImageCount; ++binding) {
        if (!hasImage(size, binding)) {
            continue;
        }
        const bool surface = binding == gpu::kBindingSurface;
        info.format = surface ? kSurfaceFormat : size.halfPicture ? kHalfLightFormat : kLightFormat;
        info.usage = kStored | (surface ? VkImageUsageFlags{VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT} : 0U);
        if (binding == gpu::kBindingAccumulated) {
            info.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;  // the caller can draw it
        }
        GLINT_TRY(frame.images[binding], createImage(context, frame.pool, info));
    }
    for (const package::PackageLayer& layer : size.layers) {
        info.format = vulkanFormat(layer.info->format);
        info.usage = kStored | VK_IMAGE_USAGE_SAMPLED_BIT;
        GLINT_TRY(auto image, createImage(context, frame.pool, info));
        frame.layers.push_back(std::move(image));
    }
    info.format = kDepthFormat;
    info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    info.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
    GLINT_TRY(frame.depth, createImage(context, frame.pool, info, Tiling::Shared));
    return okStatus();
}

struct WantedBuffer {
    const char* name;  // for reports
    Buffer FrameResources::*member;
    VkDeviceSize bytes;  // 0: the frame needs none
    VkBufferUsageFlags usage;
    MemoryUse use = MemoryUse::Device;
    // Nothing reads what the buffer holds while shadow rays of first hits wait, so it may lie in their
    // memory.
    bool followsShadows = false;

    // Returns true if nothing writes or reads the buffer until surfaces are known. It may then share the
    // memory of the depth image, which nothing needs afterwards. Other buffers are cleared at the start of a
    // frame, or are read by the raster pass.
    bool followsDepth() const {
        return use == MemoryUse::Device && (usage & VK_BUFFER_USAGE_TRANSFER_DST_BIT) == 0;
    }
};

// Returns all buffers of a frame.
std::vector<WantedBuffer> wantedBuffers(const FrameSize& size) {
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    constexpr VkBufferUsageFlags kCleared =
        kStorage | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    constexpr VkBufferUsageFlags kRead = kStorage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    constexpr VkBufferUsageFlags kIndirect = kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    // These numbers are 0 if no effect sends rays.
    const bool hasSamples = !size.hostRays || size.paths;
    const VkDeviceSize samples = hasSamples ? size.pixelsOfBand() * size.sampleCount : 0;
    const VkDeviceSize rays = listRays(size);
    const VkDeviceSize ownRays = hasSamples ? rays : 0;
    const VkDeviceSize hits = size.ordered ? rays : 0;
    // The lists of first hits and of the hits of rays follow each other in the same memory.
    const VkDeviceSize ordered = std::max(hits, size.firstHits());
    const VkDeviceSize slots = ordered > 0 ? orderedSlots(size, ordered) : 0;
    // There is one bit for each hit, in whole words.
    const VkDeviceSize visitedWords = size.checksOrder ? (hits + 31) / 32 : 0;
    // The shadow rays of first hits are traced before there are any others.
    const VkDeviceSize firstShadows = size.firstShadowBytes > 0 ? size.pixelsOfBand() : 0;
    const VkDeviceSize shadows = size.deferredShadows ? rays : 0;
    const VkDeviceSize shadowBytes = std::max(shadows * sizeof(gpu::ShadowRecord),
                                              firstShadows * size.firstShadowRays * size.firstShadowBytes);
    // The keys end at the end of the last tile that may be read, or block that may be written.
    const VkDeviceSize keys =
        ordered > 0 ? ordered + VkDeviceSize{gpu::kLargeTileThreads} * gpu::kTileHitsOfThread : 0;
    static_assert(gpu::kFirstGroupSize * gpu::kFirstPixelsOfThread <=
                  gpu::kLargeTileThreads * gpu::kTileHitsOfThread);
    const VkDeviceSize buckets = ordered > 0 ? bucketBytes(size) : 0;
    // A host chooses its own rays, so only those that follow are of lobes.
    const VkDeviceSize lobeRays = size.emissiveLights && (size.paths || !size.hostRays) ? samples : 0;
    const VkDeviceSize lists = rays > 0 ? 1 : 0;
    const VkDeviceSize orderings = ordered > 0 ? size.bucketCount + 1 : 0;
    const VkDeviceSize shadowLists = shadows > 0 ? 1 : 0;
    // Rays are listed and traced after those, and first hits are in order before they are shaded. Shadow rays
    // of hits need the memory beside hits.
    const bool follows = firstShadows > 0 && !size.deferredShadows;
    constexpr MemoryUse kOnDevice = MemoryUse::Device;
    using Frame = FrameResources;
    return {
        {"constants", &Frame::constants, sizeof(gpu::FrameConstants), kCleared},
        {"shadow rays", &Frame::shadows, shadowBytes, kStorage},
        {"starts of samples", &Frame::sampleStarts, samples * sizeof(gpu::SampleStart), kRead},
        {"directions of samples", &Frame::sampleAims,
         samples * (size.packedSamples ? sizeof(gpu::uvec2) : sizeof(gpu::SampleAim)), kRead},
        {"weights of samples", &Frame::sampleWeights,
         size.packedSamples ? 0 : samples * sizeof(gpu::SampleWeight), kRead},
        {"rays", &Frame::listed, ownRays * sizeof(std::uint32_t), kRead, kOnDevice, follows},
        {"radiance of paths", &Frame::radiance,
         size.paths && !size.hostRays ? samples * sizeof(gpu::vec4) : 0, kRead, kOnDevice, follows},
        {"next rays", &Frame::nextListed, size.paths ? ownRays * sizeof(std::uint32_t) : 0, kStorage,
         kOnDevice, follows},
        {"paths", &Frame::paths, size.paths ? samples * sizeof(gpu::PathState) : 0, kStorage},
        {"rays of lobes", &Frame::lobeRays, lobeRays * sizeof(gpu::LobeRay), kStorage},
        {"shares of the sky", &Frame::skyShares, size.skyLight ? samples * sizeof(float) : 0, kStorage},
        {"hits of layers", &Frame::rayHits, size.layerRays ? samples * sizeof(gpu::RayHit) : 0, kStorage},
        {"light of bounces", &Frame::bounceLight, samples * size.layerBounces * sizeof(gpu::BounceLight),
         kStorage},
        {"light of walks", &Frame::walkedLight, size.layerWalks ? samples * sizeof(gpu::BounceLight) : 0,
         kCleared},
        {"shadow dispatch", &Frame::shadowDispatch, shadowLists * sizeof(gpu::DispatchArguments), kIndirect},
        {"first shadow counts", &Frame::firstShadowCounts, firstShadows * sizeof(std::uint32_t), kCleared},
        {"hits", &Frame::hits, hits * size.hitBytes, kRead, kOnDevice, follows},
        {"ordered hits", &Frame::orderedHits, slots * sizeof(std::uint32_t), kStorage},
        {"visited hits", &Frame::visitedHits, visitedWords * sizeof(std::uint32_t), kCleared},
        {"bucket keys", &Frame::bucketKeys, keys * size.keyBytes, kStorage, kOnDevice, follows},
        {"bucket counts", &Frame::bucketCounts, buckets, kCleared},
        {"bucket begins", &Frame::bucketBegins, buckets, kStorage},
        {"bucket cursors", &Frame::bucketCursors, buckets, kCleared},
        {"ray dispatch", &Frame::rayDispatch, lists * sizeof(gpu::DispatchArguments), kIndirect},
        {"bucket dispatch", &Frame::bucketDispatch, orderings * sizeof(gpu::DispatchArguments), kIndirect},
        {"counters", &Frame::counters, counterBytes(size), kCleared},
        {"read-back", &Frame::readback, readbackDepth(size, size.paths ? BounceLevels::kSlots : 0),
         VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Readback},
    };
}

// Returns the memory of a resource, for others.
template <typename Resource>
SharedMemory memoryOf(const Resource& resource) {
    const VkDeviceSize begin = resource.memory == nullptr ? 0 : resource.memory->offset;
    return {resource.memory, begin, begin + resource.bytes};
}

Status createBuffers(Context::State& context, const FrameSize& size, FrameResources& frame) {
    SharedMemory ofDepth = memoryOf(frame.depth);
    SharedMemory ofShadows;
    for (const WantedBuffer& entry : wantedBuffers(size)) {
        if (entry.bytes == 0) {
            continue;
        }
        SharedMemory* const shared = entry.followsShadows && ofShadows.holds(entry.bytes) ? &ofShadows
                                     : entry.followsDepth()                               ? &ofDepth
                                                                                          : nullptr;
        GLINT_TRY(frame.*entry.member,
                  createBuffer(context, frame.pool, entry.bytes, entry.usage, entry.use, shared));
        if (entry.member == &FrameResources::shadows) {
            ofShadows = memoryOf(frame.shadows);
        }
    }
    return okStatus();
}

std::vector<VkDescriptorSetLayoutBinding> setBindings(const Context::State& context, const FrameSize& size) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (std::uint32_t binding = 0; binding < gpu::kFrameImageCount; ++binding) {
        if (bindsImage(size, binding)) {
            bindings.push_back({binding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, passStages(context), nullptr});
        }
    }
    for (std::uint32_t i = 0; i < size.layers.size(); ++i) {
        bindings.push_back(
            {gpu::kBindingLayers + i, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, passStages(context), nullptr});
    }
    if (size.environmentMap) {
        bindings.push_back({gpu::kBindingEnvironment, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                            passStages(context), nullptr});
    }
    return bindings;
}

}  // namespace

VkFormat vulkanFormat(package::LayerInfo::Format format) {
    switch (format) {
        case package::LayerInfo::Format::Float1:
            return VK_FORMAT_R32_SFLOAT;
        case package::LayerInfo::Format::Float4:
            return VK_FORMAT_R32G32B32A32_SFLOAT;
        case package::LayerInfo::Format::Half4:
            return VK_FORMAT_R16G16B16A16_SFLOAT;
        case package::LayerInfo::Format::Snorm4:
            return VK_FORMAT_R16G16B16A16_SNORM;
        case package::LayerInfo::Format::Integer:
            return VK_FORMAT_R32_UINT;
    }
    return VK_FORMAT_UNDEFINED;
}

const DeviceImage& imageOf(const FrameResources& frame, std::uint32_t binding) {
    const DeviceImage& own = frame.images[binding];
    return own.handle.get() != VK_NULL_HANDLE ? own : frame.images[gpu::kBindingAccumulated];
}

Result<UniqueSetLayout> createFrameSetLayout(Context::State& context, const FrameSize& size) {
    return createSetLayout(context, setBindings(context, size));
}

Status createFrameResources(Context::State& context, const FrameSize& size, FrameResources& frame) {
    if (size.hostRays) {
        return createBuffers(context, size, frame);
    }
    GLINT_TRY_DO(createImages(context, size, frame));
    GLINT_TRY_DO(createBuffers(context, size, frame));
    GLINT_TRY(frame.setLayout, createFrameSetLayout(context, size));
    GLINT_TRY(frame.set, createFrameSet(context, size, frame, nullptr));
    return okStatus();
}

void prepareImages(Context::State& context, VkCommandBuffer commands, FrameResources& frame) {
    if (frame.prepared) {
        return;
    }
    frame.prepared = true;
    constexpr VkAccessFlags2 kAnyAccess = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    const auto clear = [&](const DeviceImage& image) {
        if (image.handle.get() == VK_NULL_HANDLE) {
            return;
        }
        recordTransition(
            context, commands,
            {image.handle.get(),
             VK_IMAGE_LAYOUT_UNDEFINED,
             VK_IMAGE_LAYOUT_GENERAL,
             {VK_PIPELINE_STAGE_2_NONE, 0, VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT}});
        const VkClearColorValue black{};
        const VkImageSubresourceRange range = wholeImage();
        context.vk.CmdClearColorImage(commands, image.handle.get(), VK_IMAGE_LAYOUT_GENERAL, &black, 1,
                                      &range);
    };
    std::ranges::for_each(frame.images, clear);
    std::ranges::for_each(frame.layers, clear);
    recordDependency(context, commands,
                     {VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, kAnyAccess});
}

VkDeviceSize imageBytes(const FrameSize& size) {
    VkDeviceSize ofPixel = 0;
    for (std::uint32_t binding = 0; !size.hostRays && binding < gpu::kFrameImageCount; ++binding) {
        if (hasImage(size, binding)) {
            ofPixel += binding == gpu::kBindingSurface || size.halfPicture ? 8 : sizeof(gpu::vec4);
        }
    }
    ofPixel += package::bytesOf(size.layers);
    return ofPixel * size.width * size.height;
}

VkDeviceSize frameBytes(const FrameSize& size) {
    VkDeviceSize bytes = imageBytes(size);
    // Memory that buffers may still share.
    VkDeviceSize depth = size.hostRays ? 0 : VkDeviceSize{size.width} * size.height * sizeof(float);
    VkDeviceSize shadows = 0;
    bytes += depth;
    for (const WantedBuffer& buffer : wantedBuffers(size)) {
        VkDeviceSize* const shared = buffer.followsShadows && buffer.bytes <= shadows ? &shadows
                                     : buffer.followsDepth() && buffer.bytes <= depth ? &depth
                                                                                      : nullptr;
        if (shared != nullptr) {
            *shared -= buffer.bytes;
        } else {
            bytes += buffer.bytes;
        }
        shadows = buffer.member == &FrameResources::shadows ? buffer.bytes : shadows;
    }
    return bytes;
}

bool haveSameImages(const FrameSize& first, const FrameSize& second) {
    const auto sameImage = [&](std::uint32_t binding) {
        return bindsImage(first, binding) == bindsImage(second, binding) &&
               hasImage(first, binding) == hasImage(second, binding);
    };
    bool same = first.width == second.width && first.height == second.height &&
                first.halfPicture == second.halfPicture && first.environmentMap == second.environmentMap &&
                std::ranges::equal(first.layers, second.layers, {}, &package::PackageLayer::name,
                                   &package::PackageLayer::name);
    for (std::uint32_t binding = 0; binding < gpu::kFrameImageCount; ++binding) {
        same = same && sameImage(binding);
    }
    return same;
}

Result<NextBuffers> createNextBuffers(Context::State& context, const FrameSize& now, const FrameSize& next) {
    NextBuffers buffers;
    MemoryPool pool(context, "frame");
    const auto before = wantedBuffers(now);
    const auto after = wantedBuffers(next);
    bool shadowsMove = false;
    SharedMemory ofShadows;
    for (std::size_t place = 0; place < after.size(); ++place) {
        const WantedBuffer& wanted = after[place];
        const bool leavesMemory =
            wanted.followsShadows != before[place].followsShadows || (shadowsMove && wanted.followsShadows);
        if (wanted.bytes == before[place].bytes && !leavesMemory) {
            buffers.kept += wanted.bytes > 0 ? 1 : 0;
            continue;
        }
        shadowsMove = shadowsMove || wanted.member == &FrameResources::shadows;
        Buffer made;
        if (wanted.bytes > 0) {
            SharedMemory* const shared = wanted.followsShadows ? &ofShadows : nullptr;
            GLINT_TRY(made, createBuffer(context, pool, wanted.bytes, wanted.usage, wanted.use, shared));
            ++buffers.made;
            if (wanted.member == &FrameResources::shadows) {
                ofShadows = memoryOf(made);
            }
        }
        buffers.exchanges.push_back({wanted.member, std::move(made)});
    }
    return buffers;
}

std::vector<Buffer> replaceBuffers(NextBuffers&& next, FrameResources& frame) {
    std::vector<Buffer> earlier;
    for (auto& [member, buffer] : next.exchanges) {
        earlier.push_back(std::exchange(frame.*member, std::move(buffer)));
    }
    return earlier;
}

std::vector<std::pair<const char*, const Buffer*>> buffersOf(const FrameResources& frame,
                                                             const FrameSize& size) {
    std::vector<std::pair<const char*, const Buffer*>> buffers;
    for (const WantedBuffer& wanted : wantedBuffers(size)) {
        buffers.emplace_back(wanted.name, &(frame.*wanted.member));
    }
    return buffers;
}

VkDeviceSize allocatedBytes(const FrameResources& frame, const FrameSize& size) {
    VkDeviceSize bytes = frame.pool.bytes();
    std::set<const MemoryBlocks*> others;
    for (const auto& [name, buffer] : buffersOf(frame, size)) {
        if (buffer->memory != nullptr && !frame.pool.has(*buffer->memory) &&
            others.insert(buffer->memory->pool).second) {
            bytes += buffer->memory->pool->bytes();
        }
    }
    return bytes;
}

Result<DescriptorSet> createFrameSet(Context::State& context, const FrameSize& size,
                                     const FrameResources& frame, const Environment::State* environment) {
    GLINT_TRY(auto made, createSet(context, frame.setLayout.get(), setBindings(context, size), false));
    const auto write = [&](std::uint32_t binding, VkDescriptorType type, const VkDescriptorImageInfo& image) {
        writeImages(context, made.set, binding, type, std::span(&image, 1));
    };
    const auto bind = [&](std::uint32_t binding, const DeviceImage& own) {
        write(binding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
              {VK_NULL_HANDLE, own.view.get(), VK_IMAGE_LAYOUT_GENERAL});
    };
    for (std::uint32_t binding = 0; binding < gpu::kFrameImageCount; ++binding) {
        if (bindsImage(size, binding)) {
            bind(binding, imageOf(frame, binding));
        }
    }
    for (std::uint32_t i = 0; i < frame.layers.size(); ++i) {
        bind(gpu::kBindingLayers + i, frame.layers[i]);
    }
    if (environment != nullptr) {
        write(gpu::kBindingEnvironment, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, environment->image());
    }
    return made;
}

}  // namespace glint
