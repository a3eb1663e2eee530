// The passes of a frame in order.
#include "renderer/hit_passes.h"
#include "renderer/renderer_state.h"

#include <cstdint>
#include <string>
#include <vector>

namespace glint {
namespace {

using package::ModuleRole;

class FrameRecorder {
public:
    FrameRecorder(Renderer::State& state, VkCommandBuffer commands, Timing timing)
        : state_(state), vk_(state.context.vk), commands_(commands), passes_(state, commands, timing) {}

    void record(const FrameOptions& frame, const gpu::FrameConstants& constants) {
        state_.timed.clear();
        state_.timer.recordReset(commands_);
        passes_.barrier(kAllToAll);
        const std::uint32_t whole = passes_.beginStretch({"frame", Pass::Frame});
        clear(frame);
        static_assert(sizeof(constants) <= 65536 && sizeof(constants) % 4 == 0, "limits of the command");
        vk_.CmdUpdateBuffer(commands_, state_.frame.constants.handle.get(), 0, sizeof(constants), &constants);
        passes_.barrier(dependencies().clearToPasses);
        const VkDescriptorSet sets[] = {state_.scene.set, state_.frame.set};
        passes_.drawScene(state_.scene.batches, sets);
        passes_.barrier(dependencies().rasterToPasses);
        passes_.bindSets(sets);
        passes_.dispatchPixels({"lighting", Pass::Lighting}, pass(ModuleRole::Lighting));
        passes_.barrier(dependencies().passToPass);
        recordEffects(frame.effects & state_.size.effects);
        passes_.dispatchPixels({"compose", Pass::Compose}, pass(ModuleRole::Compose));
        passes_.endStretch(whole);
        passes_.barrier(dependencies().passesToCopy);
        copy(state_.frame.counters, 0, state_.frame.counters.bytes, 0);
        passes_.barrier(kCopyToHost);
    }

private:
    const PassDependencies& dependencies() const {
        return passes_.dependencies();
    }

    const PassPipeline& pass(ModuleRole role) const {
        return state_.pipelines.passes.at(role);
    }

    void fill(const Buffer& buffer, VkDeviceSize bytes, std::uint32_t value) {
        if (buffer.bytes > 0) {
            vk_.CmdFillBuffer(commands_, buffer.handle.get(), 0, bytes, value);
        }
    }

    void copy(const Buffer& source, VkDeviceSize from, VkDeviceSize bytes, VkDeviceSize to) {
        const VkBufferCopy region{from, to, bytes};
        vk_.CmdCopyBuffer(commands_, source.handle.get(), state_.frame.readback.handle.get(), 1, &region);
    }

    void clear(const FrameOptions& frame) {
        // The last counter belongs to the accumulated picture, so it is reset with the picture only.
        static_assert(gpu::kCounterNonFinite + 1 == gpu::kCounterCount);
        const bool starts = frame.sampleIndex == 0 || !state_.recorded;
        fill(state_.frame.counters,
             starts ? VK_WHOLE_SIZE : VkDeviceSize{gpu::kCounterNonFinite} * sizeof(std::uint32_t), 0);
        clearLists();
    }

    // Clears the lists at the start of a round of rays.
    void clearLists() {
        fill(state_.frame.bucketCounts, VK_WHOLE_SIZE, 0);
        fill(state_.frame.bucketCursors, VK_WHOLE_SIZE, 0);
        fill(state_.frame.visitedHits, VK_WHOLE_SIZE, 0);
    }

    // Records the rays of all effects that are on, either together or effect by effect.
    void recordEffects(std::uint32_t effects) {
        const std::uint32_t withRays = package::rayEffects(effects);
        std::vector<std::uint32_t>& rounds = state_.rounds;
        rounds.clear();
        std::uint32_t listed = 0;  // effects whose rays are in the list
        for (const package::EffectInfo& info : package::kEffects) {
            if ((withRays & info.effect) == 0) {
                continue;
            }
            if (listed == 0 && !rounds.empty()) {
                startRound();
            }
            recordRays(info);
            listed |= info.effect;
            if (state_.choice.batchEffects && listed != withRays) {
                continue;
            }
            passes_.barrier(dependencies().passToPass);
            const std::uint32_t stretch = passes_.beginStretch({"hits", Pass::Hits});
            HitPasses hits(state_, passes_);
            hits.dispatchOfList();
            hits.trace();
            hits.order();
            hits.shade();
            passes_.endStretch(stretch);
            finishRound(static_cast<std::uint32_t>(rounds.size()));
            rounds.push_back(listed);
            listed = 0;
        }
    }

    void startRound() {
        // The round before read these lists. Their counts are the first counters.
        static_assert(gpu::kCounterRays == 0 && gpu::kCounterShadowRays == 1);
        passes_.barrier(dependencies().passToClear);
        fill(state_.frame.counters, kRoundCounterBytes, 0);
        clearLists();
        passes_.barrier(dependencies().clearToPasses);
    }

    // Copies the round's counters for counters(), before the next round clears them.
    void finishRound(std::uint32_t round) {
        passes_.barrier(dependencies().passesToCopy);
        // The list's own counts follow the other counters, round by round.
        const VkDeviceSize place = readbackRound(state_.size, round);
        copy(state_.frame.counters, 0, kRoundCounterBytes, place);
        if (state_.size.ordered) {
            copy(state_.frame.bucketCounts, 0, sizeof(std::uint32_t) * state_.size.bucketCount,
                 place + kRoundCounterBytes);
        }
    }

    void recordRays(const package::EffectInfo& info) {
        const std::string name(info.name);
        if (info.effect == package::kEffectRefraction) {
            passes_.dispatchPixels({name + " walk", Pass::RefractionWalk}, pass(ModuleRole::RefractionWalk));
            passes_.barrier(dependencies().passToPass);
        }
        // Effects append to the same list in any order, so they need no barrier among themselves.
        passes_.dispatchPixels({name + " rays", Pass::EffectRays},
                               state_.pipelines.effectRays[package::effectNumber(info.effect)]);
    }

    Renderer::State& state_;
    const DeviceTable& vk_;
    VkCommandBuffer commands_;
    PassRecorder passes_;
};

}  // namespace

void recordFrame(Renderer::State& state, VkCommandBuffer commands, const FrameOptions& frame,
                 const gpu::FrameConstants& constants) {
    FrameRecorder(state, commands, frame.timing).record(frame, constants);
}

}  // namespace glint
