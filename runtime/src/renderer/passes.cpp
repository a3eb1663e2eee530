// The passes of a frame in order.
#include "renderer/pass_recorder.h"
#include "renderer/tile_sort.h"

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
        passes_.drawScene();
        passes_.barrier(dependencies().rasterToPasses);
        passes_.bindSets();
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

    void dispatchRays(const PassLabel& label, ModuleRole role) {
        passes_.dispatchList(label, pass(role), state_.frame.rayDispatch, 0);
        passes_.barrier(dependencies().passToPass);
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
            recordHits();
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

    void recordOrder() {
        dispatchRays({"trace", Pass::Trace}, ModuleRole::Trace);
        if (state_.choice.ordering == package::Ordering::TileSort) {
            const TileSortGroups groups =
                tileSortGroups(state_.context.limits, state_.size.bucketCount, listRays(state_.size));
            passes_.dispatchGroups({"count", Pass::Count}, pass(ModuleRole::BucketCount), groups.count);
            passes_.barrier(dependencies().passToPass);
            passes_.dispatchGroups({"copy", Pass::Copy}, pass(ModuleRole::BucketCopy), groups.copy);
            passes_.barrier(dependencies().passToDispatch);
        } else {
            dispatchRays({"count", Pass::Count}, ModuleRole::BucketCount);
            passes_.dispatchGroups({"offset", Pass::Offset}, pass(ModuleRole::BucketOffset), 1);
            passes_.barrier(dependencies().passToDispatch);
            dispatchRays({"copy", Pass::Copy}, ModuleRole::BucketCopy);
        }
        if (state_.choice.checksOrder) {
            // This does not dispatch by the number of rays: if there are none, it must check that buckets are
            // empty.
            passes_.dispatchPixels({"check order", Pass::CheckOrder}, pass(ModuleRole::OrderCheck));
            passes_.barrier(dependencies().passToPass);
        }
    }

    void recordBuckets() {
        // Buckets write different samples, so they need no barrier among themselves.
        const Buffer& arguments = state_.frame.bucketDispatch;
        passes_.setBucket(0);
        passes_.dispatchList({"shade miss", Pass::ShadeMiss}, pass(ModuleRole::ShadeMiss), arguments, 0);
        for (std::uint32_t shaderId = 0; shaderId < state_.pipelines.cases.size(); ++shaderId) {
            if (state_.pipelines.cases[shaderId].pipeline == VK_NULL_HANDLE) {
                continue;  // the bucket of a retired shader ID stays empty
            }
            passes_.setBucket(1 + shaderId);
            passes_.dispatchList({"shade " + state_.caseNames[shaderId], Pass::ShadeCase, shaderId},
                                 state_.pipelines.cases[shaderId], arguments, 1 + shaderId);
        }
        passes_.barrier(dependencies().passToPass);
    }

    // Shades the hits of the rays in the list.
    void recordHits() {
        passes_.dispatchGroups({"ray dispatch", Pass::RayDispatch}, pass(ModuleRole::RayDispatch), 1);
        passes_.barrier(dependencies().passToDispatch);
        switch (state_.choice.strategy) {
            case package::kStrategyUber:
                dispatchRays({"uber", Pass::Uber}, ModuleRole::UberShade);
                break;
            case package::kStrategySortedUber:
                recordOrder();
                passes_.dispatchList({"sorted uber", Pass::SortedUber}, pass(ModuleRole::SortedShade),
                                     state_.frame.bucketDispatch, state_.size.bucketCount);
                passes_.barrier(dependencies().passToPass);
                break;
            case package::kStrategyHitShaders:
                dispatchRays({"hit shaders", Pass::HitShaders}, ModuleRole::HitTrace);
                break;
            default:
                recordOrder();
                recordBuckets();
        }
        if (state_.pipelines.passes.contains(ModuleRole::ShadowTrace)) {
            passes_.dispatchGroups({"shadow dispatch", Pass::ShadowDispatch},
                                   pass(ModuleRole::ShadowDispatch), 1);
            passes_.barrier(dependencies().passToDispatch);
            passes_.dispatchList({"shadow", Pass::Shadow}, pass(ModuleRole::ShadowTrace),
                                 state_.frame.shadowDispatch, 0);
            passes_.barrier(dependencies().passToPass);
        }
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
