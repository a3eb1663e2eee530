#include "renderer/hit_passes.h"

#include "renderer/tile_sort.h"

namespace glint {

using package::ModuleRole;

void HitPasses::dispatchRays(const PassLabel& label, ModuleRole role) {
    passes_.dispatchList(label, pass(role), state_.frame.rayDispatch, 0);
    passes_.barrier(dependencies().passToPass);
}

void HitPasses::dispatchOfList() {
    passes_.dispatchGroups({"ray dispatch", Pass::RayDispatch}, pass(ModuleRole::RayDispatch), 1);
    passes_.barrier(dependencies().passToDispatch);
}

void HitPasses::trace() {
    if (ordersHits()) {
        dispatchRays({"trace", Pass::Trace}, ModuleRole::Trace);
    }
}

void HitPasses::order() {
    if (!ordersHits()) {
        return;
    }
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

void HitPasses::shadeBuckets() {
    // Buckets write different samples, so they need no barrier among themselves.
    const Buffer& arguments = state_.frame.bucketDispatch;
    passes_.setBucket(0);
    passes_.dispatchList({"shade miss", Pass::ShadeMiss}, pass(ModuleRole::ShadeMiss), arguments, 0);
    if (state_.pipelines.shadesUnknown) {
        passes_.dispatchList({"shade fallback", Pass::ShadeFallback}, pass(ModuleRole::ShadeFallback),
                             arguments, 0);
    }
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

void HitPasses::shade() {
    switch (state_.choice.strategy) {
        case package::kStrategyUber:
            dispatchRays({"uber", Pass::Uber}, ModuleRole::UberShade);
            break;
        case package::kStrategySortedUber:
            passes_.dispatchList({"sorted uber", Pass::SortedUber}, pass(ModuleRole::SortedShade),
                                 state_.frame.bucketDispatch, state_.size.bucketCount);
            passes_.barrier(dependencies().passToPass);
            break;
        case package::kStrategyHitShaders:
            dispatchRays({"hit shaders", Pass::HitShaders}, ModuleRole::HitTrace);
            break;
        default:
            shadeBuckets();
    }
    if (state_.pipelines.passes.contains(ModuleRole::ShadowTrace)) {
        passes_.dispatchGroups({"shadow dispatch", Pass::ShadowDispatch}, pass(ModuleRole::ShadowDispatch),
                               1);
        passes_.barrier(dependencies().passToDispatch);
        passes_.dispatchList({"shadow", Pass::Shadow}, pass(ModuleRole::ShadowTrace),
                             state_.frame.shadowDispatch, 0);
        passes_.barrier(dependencies().passToPass);
    }
}

}  // namespace glint
