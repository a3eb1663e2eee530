// The passes of a frame in order.
#include "frame/frame_constants.h"
#include "renderer/hit_passes.h"
#include "renderer/renderer.h"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace glint {
namespace {

using package::ModuleRole;

// Returns the rounds of at most FrameSize::firstShadowRays that hold all shadow rays of a pixel
// (light/direct.glsl), or 0 if they are traced inline.
std::uint32_t shadowRounds(const FrameSize& size, const gpu::FrameConstants& constants) {
    if (size.firstShadowBytes == 0) {
        return 0;
    }
    const std::uint32_t all = constants.lightCount + (size.emissiveLights ? constants.emitterCount : 0);
    const std::uint32_t chosen =
        size.lightSamples == 0
            ? all
            : constants.lightsApart + (constants.lightTreeNodes > 0 ? size.lightSamples : 0);
    const auto effects = static_cast<std::uint32_t>(std::popcount(size.effects.rays));
    const std::uint32_t most =
        chosen * constants.shadowSamples + (size.sizedLights ? effects * all : 0) + (size.skyLight ? 1 : 0);
    return (most + size.firstShadowRays - 1) / size.firstShadowRays;
}

class FrameRecorder {
public:
    FrameRecorder(Renderer::State& state, VkCommandBuffer commands, Timing timing)
        : state_(state), commands_(commands), passes_(state, commands, timing) {
        setBand(state.size, 0, band_);
    }

    void record(const FrameOptions& frame, const gpu::FrameConstants& constants) {
        state_.timed.clear();
        state_.timer.recordReset(commands_);
        passes_.barrier(kAllToAll);
        const std::uint32_t whole = passes_.beginStretch({"frame", Pass::Frame});
        clear(constants);
        passes_.setConstants(constants);
        passes_.barrier(dependencies().clearToPasses);
        const VkDescriptorSet sets[] = {state_.scene.set, state_.frame.set.set};
        passes_.drawScene(state_.scene.batches, sets);
        passes_.barrier(dependencies().rasterToPasses);
        passes_.bindSets(sets);
        bounces_ = bouncesToRecord(frame);
        state_.rounds.clear();
        state_.orderedBands = 0;
        state_.shadowRounds = state_.pipelines.draft ? 0 : shadowRounds(state_.size, constants);
        for (std::uint32_t band = 0; band < state_.size.bandCount(); ++band) {
            if (band > 0) {
                startBand(band);
            }
            recordBand(band, frame);
        }
        passes_.endStretch(whole);
        // Layers of motion describe a picture's first sample, so only that sample needs the state of the
        // previous frame.
        if (state_.history != nullptr && constants.averaged == 0) {
            state_.history->record(commands_, state_.recordings + 1);
        }
        passes_.barrier(dependencies().passesToCopy);
        passes_.readBack(state_.frame.counters, state_.frame.counters.bytes, 0);
        keepDepth();
        passes_.barrier(kCopyToHost);
    }

private:
    RecordedBounces bouncesToRecord(const FrameOptions& frame) const {
        const std::uint32_t bounces = bouncesOf(state_.size, frame);
        if (frame.recordAllBounces) {
            return {bounces, bounces};
        }
        return drawBounces(state_.bounceLevels.certainBounces(bounces), bounces,
                           bounceBits(frame.sampleIndex, frame.seed));
    }

    // Copies the depth of the paths for BounceLevels.
    void keepDepth() {
        if (!state_.size.paths) {
            return;
        }
        const std::uint64_t recording = state_.recordings + 1;
        if (state_.pipelines.draft) {
            state_.bounceLevels.skipped(recording);
            return;
        }
        passes_.readBack(state_.frame.counters, sizeof(std::uint32_t),
                         readbackDepth(state_.size, BounceLevels::slotOf(recording)),
                         gpu::kCounterDeepest * sizeof(std::uint32_t));
        state_.bounceLevels.recorded(recording, bounces_.count);
    }

    const PassDependencies& dependencies() const {
        return passes_.dependencies();
    }

    const PassPipeline& pass(ModuleRole role) const {
        return state_.pipelines.passes.at(role);
    }

    // Shades the rows of a band.
    void recordBand(std::uint32_t band, const FrameOptions& frame) {
        passes_.setRows(band_.endRow - band_.firstRow);
        if (state_.pipelines.draft) {
            passes_.dispatchPixels({"first draft", Pass::FirstShade}, pass(ModuleRole::FirstDraft));
            passes_.barrier(dependencies().passToPass);
        } else {
            recordFirst(band);
            recordEffects(frame.effects & state_.size.effects.rays);
        }
        passes_.dispatchPixels({"compose", Pass::Compose}, pass(ModuleRole::Compose));
    }

    // Shades what the camera sees, by the same cases as hits of rays.
    void recordFirst(std::uint32_t band) {
        HitPasses hits(state_, passes_);
        hits.orderFirst();
        passes_.barrier(dependencies().passesToCopy);
        passes_.readBack(state_.frame.bucketCounts, bucketBytes(state_.size),
                         readbackFirst(state_.size, band));
        state_.orderedBands = band + 1;
        hits.shadeFirst(state_.shadowRounds);
    }

    // Leads the passes to the rows of another band. The band before used the same memory.
    void startBand(std::uint32_t band) {
        setBand(state_.size, band, band_);
        passes_.barrier(dependencies().passToClear);
        passes_.setConstants(band_.firstRow, offsetof(gpu::FrameConstants, firstRow));
        passes_.setConstants(band_.endRow, offsetof(gpu::FrameConstants, endRow));
        passes_.setConstants(band_.bandFirst, offsetof(gpu::FrameConstants, bandFirst));
        clearOfPixels();
        startRound();
        passes_.barrier(dependencies().passToPass);
    }

    // Drafts have no walk, walks of packs need not store their results, and only lit surfaces send shadow
    // rays.
    void clearOfPixels() {
        passes_.fill(state_.frame.walkedLight, 0);
        passes_.fill(state_.frame.firstShadowCounts, 0);
    }

    void clear(const gpu::FrameConstants& constants) {
        // This counter belongs to the accumulated picture, so it is reset with the picture only.
        constexpr VkDeviceSize kKept = gpu::kCounterNonFinite * sizeof(std::uint32_t);
        if (constants.averaged == 0 || !state_.recorded) {
            passes_.fill(state_.frame.counters, 0);
        } else {
            passes_.fill(state_.frame.counters, 0, kKept);
            passes_.fill(state_.frame.counters, 0, VK_WHOLE_SIZE, kKept + sizeof(std::uint32_t));
        }
        passes_.clearLists();
        clearOfPixels();
    }

    // Records the rays of all effects that are on, either together or effect by effect.
    void recordEffects(std::uint32_t withRays) {
        std::uint32_t listed = 0;  // effects whose rays are in the list
        for (const EffectName& info : state_.effects) {
            if ((withRays & info.effect) == 0) {
                continue;
            }
            if (listed == 0) {
                startRound();
            }
            recordRays(info);
            listed |= info.effect;
            if (state_.choice.batchEffects && listed != withRays) {
                continue;
            }
            if (state_.size.paths) {
                setBounce(1);
            } else {
                passes_.barrier(dependencies().passToPass);
            }
            recordHits(listed, 1);
            for (std::uint32_t bounce = 2; bounce <= bounces_.count; ++bounce) {
                HitPasses(state_, passes_).listPathRays(bounce, weightBehind(bounce, bounces_.certain));
                recordHits(listed, bounce);
            }
            listed = 0;
        }
    }

    // Traces and shades the rays of the list.
    void recordHits(std::uint32_t effects, std::uint32_t bounce) {
        const std::uint32_t stretch = passes_.beginStretch({"hits", Pass::Hits});
        HitPasses hits(state_, passes_);
        hits.dispatchOfList();
        hits.trace();
        hits.order();
        hits.shade();
        passes_.endStretch(stretch);
        hits.readBackRound(static_cast<std::uint32_t>(state_.rounds.size()));
        state_.rounds.push_back({effects, bounce});
    }

    // Sets a bounce of the paths that are recorded.
    void setBounce(std::uint32_t bounce) {
        HitPasses(state_, passes_).setBounce(bounce, weightBehind(bounce, bounces_.certain));
    }

    void startRound() {
        if (state_.size.paths) {
            setBounce(0);
        }
        HitPasses(state_, passes_).clearRound();
    }

    void recordRays(const EffectName& info) {
        const std::uint32_t number = package::effectNumber(info.effect);
        const auto& passes = state_.pipelines.effectPasses;
        if ((state_.size.effects.walks & info.effect) != 0) {
            if (state_.size.sizedLights) {
                // The marches of other effects read the image into which the walk adds such lights.
                passes_.barrier(dependencies().passToPass);
            }
            passes_.dispatchPixels({info.name + " walk", Pass::EffectWalk},
                                   passes.at({ModuleRole::EffectWalk, number}));
            passes_.barrier(dependencies().passToPass);
        }
        // Effects append to the same list in any order, so they need no barrier among themselves.
        passes_.dispatchPixels({info.name + " rays", Pass::EffectRays},
                               passes.at({ModuleRole::EffectRays, number}));
    }

    Renderer::State& state_;
    VkCommandBuffer commands_;
    PassRecorder passes_;
    RecordedBounces bounces_;
    gpu::FrameConstants band_{};  // of these, the rows of the band that is being recorded
};

}  // namespace

void recordFrame(Renderer::State& state, VkCommandBuffer commands, const FrameOptions& frame,
                 const gpu::FrameConstants& constants) {
    FrameRecorder(state, commands, frame.timing).record(frame, constants);
}

}  // namespace glint
