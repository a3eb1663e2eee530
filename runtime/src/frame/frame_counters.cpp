// Reads the counters of a frame.
#include "context/readback.h"
#include "renderer/renderer_state.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace glint {

namespace {

// hit/count.glsl says where the counters are.
EffectCounters countersOf(const std::vector<std::uint32_t>& values, const package::EffectSet& all,
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
    EffectCounters counters;
    counters.effect = effect.effect;
    counters.kind = effect.kind;
    counters.name = effect.name;
    counters.rays = count(gpu::kRaySent) + count(gpu::kRayEnded);
    counters.hits = count(gpu::kCountHits);
    counters.misses = count(gpu::kCountMisses);
    counters.segments = count(gpu::kCountSegments);
    counters.screenHits = count(gpu::kCountScreenHits);
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

// Returns the counts of the buckets of a round that was read back at `bytes`.
std::vector<std::uint32_t> bucketsOf(const std::uint8_t* bytes, const FrameSize& size) {
    std::vector<std::uint32_t> counts(size.bucketCount);
    std::memcpy(counts.data(), bytes + kRoundCounterBytes, counts.size() * sizeof(counts[0]));
    return counts;
}

void addTo(std::vector<std::uint32_t>& sums, const std::vector<std::uint32_t>& counts) {
    sums.resize(counts.size());
    std::ranges::transform(counts, sums, sums.begin(), std::plus<>{});
}

// Adds the counters of a round that was read back at `bytes`.
void addRound(const std::uint8_t* bytes, const FrameSize& size, const Renderer::State::Round& round,
              FrameCounters& counters) {
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
    const std::vector<std::uint32_t> counts = bucketsOf(bytes, size);
    addTo(counters.bucketCounts, counts);
    for (EffectCounters& effect : counters.effects) {
        if (effect.effect == round.effects) {
            addTo(effect.bucketCounts, counts);
        }
    }
}

}  // namespace

Diagnostic frameNotRecorded() {
    return makeError("frame-not-recorded", "", "no frame has been recorded",
                     "record a frame, submit it and wait for it first");
}

EffectCounters FrameCounters::of(package::Effect effect) const {
    const auto found = std::ranges::find(effects, effect, &EffectCounters::effect);
    EffectCounters none;
    none.effect = effect;
    return found == effects.end() ? none : *found;
}

std::vector<std::uint32_t> bucketCountsOf(const Renderer::State& state) {
    std::vector<std::uint32_t> sums(state.size.bucketCount);
    for (std::uint32_t round = 0; round < state.rounds.size(); ++round) {
        addTo(sums, bucketsOf(state.frame.readback.mapped + readbackRound(state.size, round), state.size));
    }
    return sums;
}

Result<FrameCounters> Renderer::counters() {
    if (!state_->recorded) {
        return frameNotRecorded();
    }
    const std::uint8_t* const bytes = state_->frame.readback.mapped;
    std::vector<std::uint32_t> values(counterBytes(state_->size) / sizeof(std::uint32_t));
    std::memcpy(values.data(), bytes, values.size() * sizeof(values[0]));
    FrameCounters counters;
    counters.draft = state_->drafted;
    for (const EffectName& effect : state_->effects) {
        counters.effects.push_back(countersOf(values, state_->size.effects, effect));
    }
    counters.orderErrors = values[gpu::kCounterOrderErrors];
    counters.unknownShader = values[gpu::kCounterUnknownShader];
    // These follow all others.
    for (std::size_t i = values.size() - state_->size.textureLevels; i < values.size(); ++i) {
        counters.textureLevels.push_back(values[i] == 0 ? FrameCounters::kLevelNotRead
                                                        : gpu::kFinestTextureLevel - values[i]);
    }
    counters.nonFinite = values[gpu::kCounterNonFinite];
    counters.alphaTests = values[gpu::kCounterAlphaTests];
    for (std::uint32_t round = 0; round < state_->rounds.size(); ++round) {
        addRound(bytes + readbackRound(state_->size, round), state_->size, state_->rounds[round], counters);
    }
    if (state_->size.ordered) {
        counters.bucketCounts.resize(state_->size.bucketCount);
    }
    return counters;
}

}  // namespace glint
