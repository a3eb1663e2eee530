#include "context/commands.h"
#include "renderer/renderer.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <span>
#include <string>

namespace glint {
namespace {

constexpr MemoryDependency kWriteToCopy{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_SHADER_WRITE_BIT,
                                        VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};

// Reads bytes that copy(commands, target) copies into a buffer.
template <typename Copy>
Status readBytes(const Renderer::State& state, CommandRunner& runner, std::span<std::uint8_t> bytes,
                 const Copy& copy) {
    MemoryPool pool(state.context, "read-back");
    GLINT_TRY(auto target, createBuffer(state.context, pool, bytes.size(), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                        MemoryUse::Readback));
    GLINT_TRY(auto commands, runner.begin());
    recordDependency(state.context, commands, kWriteToCopy);
    copy(commands, target.handle.get());
    recordDependency(state.context, commands, kCopyToHost);
    GLINT_TRY_DO(runner.submitAndWait());
    std::memcpy(bytes.data(), target.mapped, bytes.size());
    return okStatus();
}

Renderer::PixelPath pathOf(std::uint32_t path, std::uint32_t outcome) {
    if (path == gpu::kPathScreen) {
        return Renderer::PixelPath::Screen;
    }
    if (path == gpu::kPathHit) {
        return Renderer::PixelPath::Hit;
    }
    if (path == gpu::kPathMiss) {
        return Renderer::PixelPath::Miss;
    }
    return outcome == gpu::kRayNoSurface ? Renderer::PixelPath::NoSurface : Renderer::PixelPath::NoRay;
}

template <typename Pixel>
Result<std::vector<Pixel>> readImage(const Renderer::State& state, CommandRunner& runner,
                                     const DeviceImage& image, std::size_t count) {
    std::vector<Pixel> pixels(count);
    const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                   .imageExtent = {state.size.width, state.size.height, 1}};
    GLINT_TRY_DO(readBytes(state, runner,
                           {reinterpret_cast<std::uint8_t*>(pixels.data()), count * sizeof(Pixel)},
                           [&](VkCommandBuffer commands, VkBuffer target) {
                               state.context.vk.CmdCopyImageToBuffer(
                                   commands, image.handle.get(), VK_IMAGE_LAYOUT_GENERAL, target, 1, &region);
                           }));
    return pixels;
}

// Widens the values of a layer to 32 bits.
LayerValues toValues(std::span<const std::uint8_t> bytes, const package::LayerInfo::FormatInfo& format,
                     LayerValues values) {
    const auto valuesOf = [&]<typename Stored>(Stored /*type*/, const auto& widen) {
        std::vector<Stored> stored(bytes.size() / sizeof(Stored));
        std::memcpy(stored.data(), bytes.data(), stored.size() * sizeof(Stored));
        values.reals.resize(stored.size());
        std::ranges::transform(stored, values.reals.begin(), widen);
    };
    switch (format.format) {
        case package::LayerInfo::Format::Float1:
        case package::LayerInfo::Format::Float4:
            valuesOf(float{}, [](float value) { return value; });
            break;
        case package::LayerInfo::Format::Half4:
            valuesOf(std::uint16_t{}, [](std::uint16_t value) { return glm::unpackHalf1x16(value); });
            break;
        case package::LayerInfo::Format::Snorm4:
            valuesOf(std::int16_t{}, [](std::int16_t value) {
                return std::max(static_cast<float>(value) / 32767.0F, -1.0F);
            });
            break;
        case package::LayerInfo::Format::Integer:
            values.integers.resize(bytes.size() / sizeof(std::uint32_t));
            std::memcpy(values.integers.data(), bytes.data(), bytes.size());
            break;
    }
    return values;
}

// Turns places that are relative to a scene's origin into places in the world. A pixel without a surface has
// 0 and keeps it.
void moveToWorld(const std::array<double, 3>& origin, LayerValues& values) {
    for (std::size_t at = 0; at + 2 < values.reals.size(); at += values.components) {
        const std::span<float, 3> place(values.reals.data() + at, 3);
        if (std::ranges::all_of(place, [](float value) { return value == 0.0F; })) {
            continue;
        }
        std::ranges::transform(place, origin, place.begin(),
                               [](float value, double from) { return static_cast<float>(from + value); });
    }
}

// The geometry of a pixel's surface, gpu::kNoSurface where there is none, and its triangle.
using SurfaceIdentity = std::array<std::uint32_t, 2>;

Result<std::vector<SurfaceIdentity>> readIdentities(const Renderer::State& state) {
    GLINT_TRY(auto runner, CommandRunner::create(state.context));
    return readImage<SurfaceIdentity>(state, runner, imageOf(state.frame, gpu::kBindingSurface),
                                      std::size_t{state.size.width} * state.size.height);
}

}  // namespace

Result<LinearImage> readPicture(const Renderer::State& state, CommandRunner& runner) {
    const DeviceImage& image = imageOf(state.frame, gpu::kBindingAccumulated);
    LinearImage picture{state.size.width, state.size.height, {}};
    const std::size_t count = std::size_t{state.size.width} * state.size.height;
    if (image.format != kHalfLightFormat) {
        GLINT_TRY(picture.pixels, readImage<std::array<float, 4>>(state, runner, image, count));
        return picture;
    }
    using HalfPixel = std::array<std::uint16_t, 4>;
    GLINT_TRY(const auto pixels, readImage<HalfPixel>(state, runner, image, count));
    for (const HalfPixel& pixel : pixels) {
        std::ranges::transform(pixel, picture.pixels.emplace_back().begin(),
                               [](std::uint16_t value) { return glm::unpackHalf1x16(value); });
    }
    return picture;
}

Result<std::vector<std::uint8_t>> readFrameBuffer(const Renderer::State& state, CommandRunner& runner,
                                                  const Buffer& buffer) {
    std::vector<std::uint8_t> bytes(buffer.bytes);
    const VkBufferCopy region{0, 0, buffer.bytes};
    GLINT_TRY_DO(readBytes(state, runner, bytes, [&](VkCommandBuffer commands, VkBuffer target) {
        state.context.vk.CmdCopyBuffer(commands, buffer.handle.get(), target, 1, &region);
    }));
    return bytes;
}

std::vector<Renderer::LayerImage> Renderer::layers() const {
    std::vector<LayerImage> images;
    for (std::size_t i = 0; i < state_->size.layers.size(); ++i) {
        const package::PackageLayer& layer = state_->size.layers[i];
        const DeviceImage& image = state_->frame.layers[i];
        images.push_back({layer.name, layer.info, layer.effect, layer.bounce, image.handle.get(),
                          image.view.get(), image.format});
    }
    return images;
}

Result<LayerValues> Renderer::readLayer(std::string_view name) try {
    const auto found = std::ranges::find(state_->size.layers, name, &package::PackageLayer::name);
    if (found == state_->size.layers.end()) {
        return makeError("layer-missing", "", "the package has no layer " + std::string(name),
                         "compile the package with --layers");
    }
    GLINT_TRY_DO(checkRecorded(*state_));
    GLINT_TRY(auto runner, CommandRunner::create(state_->context));
    const DeviceImage& image =
        state_->frame.layers[static_cast<std::size_t>(found - state_->size.layers.begin())];
    const package::LayerInfo::FormatInfo& format = package::infoOf(found->info->format);
    const std::size_t count = std::size_t{state_->size.width} * state_->size.height;
    GLINT_TRY(auto bytes, readImage<std::uint8_t>(*state_, runner, image, count * format.bytes));
    LayerValues values =
        toValues(bytes, format, {state_->size.width, state_->size.height, format.components, {}, {}});
    if (found->info->isPlace) {
        moveToWorld(state_->scene.origin, values);
    }
    return values;
}
GLINT_CATCH

Result<std::vector<std::uint8_t>> Renderer::readSurfaces() try {
    GLINT_TRY_DO(checkRecorded(*state_));
    GLINT_TRY(const auto identities, readIdentities(*state_));
    std::vector<std::uint8_t> surfaces(identities.size());
    std::ranges::transform(identities, surfaces.begin(), [](const SurfaceIdentity& pixel) {
        return static_cast<std::uint8_t>(pixel[0] != gpu::kNoSurface ? 1 : 0);
    });
    return surfaces;
}
GLINT_CATCH

Result<std::optional<Renderer::SurfacePlace>> Renderer::readPlace(std::uint32_t x, std::uint32_t y) try {
    GLINT_TRY_DO(checkRecorded(*state_));
    if (x >= state_->size.width || y >= state_->size.height) {
        return makeError("render-size", "", "the picture has no such pixel",
                         "name one within its width and height");
    }
    GLINT_TRY(const auto identities, readIdentities(*state_));
    const std::uint32_t geometry = identities[std::size_t{y} * state_->size.width + x][0];
    if (geometry == gpu::kNoSurface) {
        return std::optional<SurfacePlace>();
    }
    const std::optional<GeometryPlace> place = placeOf(state_->scene, geometry);
    if (!place) {
        return std::optional<SurfacePlace>();  // an edit has removed it since the frame
    }
    return std::optional(
        SurfacePlace{place->instance.index, place->mesh, place->primitive, place->shaderId, place->instance});
}
GLINT_CATCH

Result<LinearImage> Renderer::readOutput() try {
    GLINT_TRY_DO(checkRecorded(*state_));
    GLINT_TRY(auto runner, CommandRunner::create(state_->context));
    return readPicture(*state_, runner);
}
GLINT_CATCH

Result<std::vector<Renderer::PixelPath>> Renderer::readCoverage(package::Effect effect) try {
    GLINT_TRY_DO(checkRecorded(*state_));
    if (!std::has_single_bit(effect) || (state_->size.effects.rays & effect) == 0) {
        return makeError("effect-missing", "", "the package has no such effect with rays",
                         "compile the package with that effect");
    }
    GLINT_TRY(auto runner, CommandRunner::create(state_->context));
    if (state_->size.bandRows > 0) {
        return makeError(
            "frame-options", "",
            "the frame was lit in bands, which share the memory that says how pixels found light",
            "make the renderer with RendererOptions::bands at 1");
    }
    GLINT_TRY(const auto starts, readFrameBuffer(*state_, runner, state_->frame.sampleStarts));
    std::vector<std::uint8_t> radiance;
    if (state_->size.paths) {
        GLINT_TRY(radiance, readFrameBuffer(*state_, runner, state_->frame.radiance));
    }
    std::vector<PixelPath> paths(std::size_t{state_->size.width} * state_->size.height);
    const std::size_t first = paths.size() * package::effectSlot(state_->size.effects, effect);
    for (std::size_t i = 0; i < paths.size(); ++i) {
        gpu::SampleStart start{};
        std::memcpy(&start, starts.data() + (first + i) * sizeof(start), sizeof(start));
        const bool packed = state_->size.packedSamples;
        const std::uint32_t outcome = start.state & (packed ? gpu::kPackedOutcomeMask : gpu::kOutcomeMask);
        std::uint32_t path = packed ? start.state >> gpu::kPackedPathShift & gpu::kPackedPathMask
                                    : start.state >> gpu::kPathShift;
        if (state_->size.paths && (outcome == gpu::kRaySent || outcome == gpu::kRayEnded)) {
            gpu::vec4 found{};
            std::memcpy(&found, radiance.data() + (first + i) * sizeof(found), sizeof(found));
            path = static_cast<std::uint32_t>(found.w);
        }
        paths[i] = pathOf(path, outcome);
    }
    return paths;
}
GLINT_CATCH

namespace {

// hit/count.glsl says where the counters are.
Renderer::EffectCounters countersOf(const std::vector<std::uint32_t>& values, const package::EffectSet& all,
                                    const EffectName& effect) {
    const auto count = [&](std::uint32_t kind) {
        const std::uint32_t countersOfCopy = package::countedEffects(all) * gpu::kCountsOfEffect;
        std::uint32_t place =
            gpu::kCounterEffects + gpu::kCountsOfEffect * package::effectNumber(effect.effect) + kind;
        std::uint32_t sum = 0;
        for (std::uint32_t copy = 0; copy < gpu::kCounterCopies; ++copy, place += countersOfCopy) {
            sum += values[place];
        }
        return sum;
    };
    Renderer::EffectCounters counters;
    counters.effect = effect.effect;
    counters.kind = effect.kind;
    counters.name = effect.name;
    counters.rays = count(gpu::kRaySent) + count(gpu::kRayEnded);
    counters.hits = count(gpu::kCountHits);
    counters.misses = count(gpu::kCountMisses);
    counters.segments = count(gpu::kCountSegments);
    counters.screenHits = count(gpu::kCountScreenHits);
    counters.waited = count(gpu::kCountWaited);
    counters.skippedSky = count(gpu::kRayNoSurface);
    counters.skippedUnlit = count(gpu::kRayUnlit);
    counters.skippedRough = count(gpu::kRayRough);
    counters.skippedBlack = count(gpu::kRayBlack);
    counters.skippedAbsent = count(gpu::kRayAbsent);
    counters.skippedFaint = count(gpu::kRayFaint);
    counters.skippedFacing = count(gpu::kRayFacing);
    counters.skippedRange = count(gpu::kRayRange);
    counters.skippedCone = count(gpu::kRayCone);
    return counters;
}

// Returns the counts of buckets that were read back at `bytes`.
std::vector<std::uint32_t> bucketsOf(const std::uint8_t* bytes, const FrameSize& size) {
    std::vector<std::uint32_t> counts(size.bucketCount);
    std::memcpy(counts.data(), bytes, counts.size() * sizeof(counts[0]));
    return counts;
}

void addTo(std::vector<std::uint32_t>& sums, const std::vector<std::uint32_t>& counts) {
    sums.resize(counts.size());
    std::ranges::transform(counts, sums, sums.begin(), std::plus<>{});
}

// Adds the counters of a round that was read back at `bytes`.
void addRound(const std::uint8_t* bytes, const FrameSize& size, const Renderer::State::Round& round,
              Renderer::Counters& counters) {
    std::array<std::uint32_t, 2> lists{};
    static_assert(sizeof(lists) == kRoundCounterBytes);
    std::memcpy(lists.data(), bytes, sizeof(lists));
    counters.rays += lists[gpu::kCounterRays];
    counters.raysOfBounces.resize(std::max<std::size_t>(counters.raysOfBounces.size(), round.bounce));
    counters.raysOfBounces[round.bounce - 1] += lists[gpu::kCounterRays];
    counters.shadowRays += lists[gpu::kCounterShadowRays];
    if (!size.ordered) {
        return;
    }
    const std::vector<std::uint32_t> counts = bucketsOf(bytes + kRoundCounterBytes, size);
    addTo(counters.bucketCounts, counts);
    for (Renderer::EffectCounters& effect : counters.effects) {
        if (effect.effect == round.effects) {
            addTo(effect.bucketCounts, counts);
        }
    }
}

}  // namespace

Renderer::EffectCounters Renderer::Counters::of(package::Effect effect) const {
    const auto found = std::ranges::find(effects, effect, &Renderer::EffectCounters::effect);
    Renderer::EffectCounters none;
    none.effect = effect;
    return found == effects.end() ? none : *found;
}

std::vector<std::uint32_t> Renderer::State::firstHits() const {
    std::vector<std::uint32_t> sums(size.bucketCount);
    for (std::uint32_t band = 0; band < orderedBands; ++band) {
        addTo(sums, bucketsOf(frame.readback.mapped + readbackFirst(size, band), size));
    }
    return sums;
}

// Those of the pixels and of all rounds.
std::vector<std::uint32_t> Renderer::State::hits() const {
    std::vector<std::uint32_t> sums = firstHits();
    for (std::uint32_t round = 0; size.ordered && round < rounds.size(); ++round) {
        addTo(sums, bucketsOf(frame.readback.mapped + readbackRound(size, round) + kRoundCounterBytes, size));
    }
    return sums;
}

Result<Renderer::Counters> Renderer::counters() try {
    GLINT_TRY_DO(checkRecorded(*state_));
    const std::uint8_t* const bytes = state_->frame.readback.mapped;
    std::vector<std::uint32_t> values(counterBytes(state_->size) / sizeof(std::uint32_t));
    std::memcpy(values.data(), bytes, values.size() * sizeof(values[0]));
    Renderer::Counters counters;
    counters.draft = state_->drafted;
    counters.shadowRounds = state_->shadowRounds;
    for (const EffectName& effect : state_->effects) {
        counters.effects.push_back(countersOf(values, state_->size.effects, effect));
    }
    counters.orderErrors = values[gpu::kCounterOrderErrors];
    counters.unknownShader = values[gpu::kCounterUnknownShader];
    // These follow all others.
    for (std::size_t i = values.size() - state_->size.textureLevels; i < values.size(); ++i) {
        counters.textureLevels.push_back(values[i] == 0 ? Renderer::Counters::kLevelNotRead
                                                        : gpu::kFinestTextureLevel - values[i]);
    }
    counters.nonFinite = values[gpu::kCounterNonFinite];
    counters.alphaTests = values[gpu::kCounterAlphaTests];
    if (state_->orderedBands > 0) {
        counters.pixelCounts = state_->firstHits();
        // Tiles that reach beyond the picture count as pixels without a surface.
        const std::uint32_t all =
            std::accumulate(counters.pixelCounts.begin(), counters.pixelCounts.end(), 0U);
        counters.pixelCounts.front() -= all - state_->size.width * state_->size.height;
    }
    for (std::uint32_t round = 0; round < state_->rounds.size(); ++round) {
        addRound(bytes + readbackRound(state_->size, round), state_->size, state_->rounds[round], counters);
    }
    if (state_->size.ordered) {
        counters.bucketCounts.resize(state_->size.bucketCount);
    }
    return counters;
}
GLINT_CATCH

}  // namespace glint
