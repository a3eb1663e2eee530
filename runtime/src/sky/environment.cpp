// Environment: the map and its levels of roughness on the device.
#include "sky/environment.h"

#include "context/upload.h"
#include "context/vulkan_table.h"
#include "sky/map_filter.h"
#include "sky/radiance_map.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace glint {
namespace {

using Texels = std::vector<std::uint8_t>;

// Returns the texels of a level in RGBA, each channel converted by `convert`.
template <typename Channel, typename Convert>
Texels toTexels(const RadianceMap& level, Channel alpha, const Convert& convert) {
    std::vector<std::array<Channel, 4>> texels;
    texels.reserve(level.texels.size());
    for (const Radiance& radiance : level.texels) {
        texels.push_back({convert(radiance[0]), convert(radiance[1]), convert(radiance[2]), alpha});
    }
    const std::span<const std::uint8_t> bytes = bytesOf(std::span(std::as_const(texels)));
    return {bytes.begin(), bytes.end()};
}

// Returns a power of two, so that scaling loses no digits. It is 1 unless the map is brighter than the
// largest half float.
float halfScale(const RadianceMap& map) {
    float largest = 0.0F;
    for (const Radiance& radiance : map.texels) {
        largest = std::max({largest, radiance[0], radiance[1], radiance[2]});
    }
    float scale = 1.0F;
    while (largest / scale > kMaxHalf) {
        scale *= 2.0F;
    }
    return scale;
}

Status createSampler(Environment::State& state) {
    const VkSamplerCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .magFilter = VK_FILTER_LINEAR,
        .minFilter = VK_FILTER_LINEAR,
        .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
        // The map wraps around the horizon without a seam, and the poles are edges.
        .addressModeU = VK_SAMPLER_ADDRESS_MODE_REPEAT,
        .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .maxLod = VK_LOD_CLAMP_NONE};
    GLINT_TRY(state.sampler, createHandle<UniqueSampler>(state.context, state.context.vk.CreateSampler,
                                                         "vkCreateSampler", info));
    return okStatus();
}

Status uploadLevels(Environment::State& state, Uploader& uploader, const std::vector<RadianceMap>& levels) {
    const bool half = state.statistics.halfFloat;
    state.scale = half ? halfScale(levels.front()) : 1.0F;
    ImageInfo info;
    info.format = half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
    info.extent = {levels.front().width, levels.front().height};
    info.mips = static_cast<std::uint32_t>(levels.size());
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    GLINT_TRY(state.map, createImage(state.context, state.pool, info));
    std::vector<Texels> mips;
    mips.reserve(levels.size());
    for (const RadianceMap& level : levels) {
        mips.push_back(
            half ? toTexels(level, toHalf(1.0F), [&](float value) { return toHalf(value / state.scale); })
                 : toTexels(level, 1.0F, [](float value) { return value; }));
    }
    const std::vector<std::span<const std::uint8_t>> views(mips.begin(), mips.end());
    return uploader.copyToImage(views, {1, 1, half ? 8U : 16U}, state.map);
}

Status uploadCounts(Environment::State& state, Uploader& uploader, const SkyCounts& distribution) {
    state.countColumns = distribution.columns;
    state.countRows = distribution.rows;
    const std::span<const std::uint8_t> bytes = bytesOf(std::span(distribution.counts));
    GLINT_TRY(state.counts,
              createBuffer(state.context, state.pool, bytes.size(),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT));
    return uploader.copyToBuffer(bytes, state.counts);
}

// Makes an environment, and queues its copies.
Result<std::shared_ptr<Environment::State>> makeState(Context& context, const LinearImage& image,
                                                      const Environment::Options& options,
                                                      Uploader& uploader) {
    GLINT_TRY(auto checked, checkMap(image));
    auto state = std::make_shared<Environment::State>(context.state());
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    RadianceMap map = fitToDevice(std::move(checked.map));
    state->harmonics = skyHarmonics(map);
    const SkyCounts distribution = options.sampled ? skyCounts(map) : SkyCounts{};
    const std::vector<RadianceMap> levels = filterByRoughness(std::move(map));
    Environment::Statistics& statistics = state->statistics;
    statistics.filterMs = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    statistics.width = levels.front().width;
    statistics.height = levels.front().height;
    statistics.levels = static_cast<std::uint32_t>(levels.size());
    statistics.negativePixels = checked.negativePixels;
    statistics.sampled = options.sampled;
    statistics.halfFloat = !context.state().limits.filteredFloats;
    GLINT_TRY_DO(uploadLevels(*state, uploader, levels));
    if (options.sampled) {
        GLINT_TRY_DO(uploadCounts(*state, uploader, distribution));
    }
    GLINT_TRY_DO(createSampler(*state));
    return state;
}

}  // namespace

struct Environment::Upload : StagedCopies {
    using StagedCopies::StagedCopies;
};

Result<std::unique_ptr<Environment>> Environment::record(Context& context, const LinearImage& image,
                                                         const Environment::Options& options,
                                                         VkCommandBuffer commands, std::uint64_t frame) try {
    auto upload = std::make_unique<Upload>(context.state());
    GLINT_TRY(auto state, makeState(context, image, options, *upload->uploader));
    upload->record(commands, frame);
    std::unique_ptr<Environment> environment(new Environment(std::move(state)));
    environment->upload_ = std::move(upload);
    return environment;
}
GLINT_CATCH

Result<std::unique_ptr<Environment>> Environment::create(Context& context, const LinearImage& image,
                                                         const Environment::Options& options) try {
    return makeOnce(context.state(),
                    [&](VkCommandBuffer commands) { return record(context, image, options, commands, 0); });
}
GLINT_CATCH

void Environment::complete(std::uint64_t frame) {
    if (upload_ && upload_->frame <= frame) {
        upload_.reset();
    }
}

Environment::Environment(std::shared_ptr<const State> state) : state_(std::move(state)) {}
Environment::~Environment() = default;

VkDescriptorImageInfo Environment::image() const {
    return state_->image();
}

const Environment::Statistics& Environment::statistics() const {
    return state_->statistics;
}

}  // namespace glint
