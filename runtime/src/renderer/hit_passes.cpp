#include "renderer/hit_passes.h"

#include "renderer/tile_sort.h"

#include <string>
#include <vector>

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

void HitPasses::shadeCases(const package::RoleInfo& info) {
    const std::vector<PassPipeline>& cases = state_.pipelines.cases;
    for (std::uint32_t shaderId = 0; shaderId < cases.size(); ++shaderId) {
        if (cases[shaderId].pipeline == VK_NULL_HANDLE) {
            continue;  // the bucket of a retired shader ID stays empty
        }
        passes_.setBucket(1 + shaderId);
        passes_.dispatchList(
            {std::string(info.declared->pass) + " " + state_.caseNames[shaderId], Pass::ShadeCase, shaderId},
            cases[shaderId], state_.frame.bucketDispatch, 1 + shaderId);
    }
}

void HitPasses::dispatch(const package::RoleInfo& info) {
    const bool ofFallback = info.purpose == package::Purpose::Fallback;
    const PassLabel label{std::string(info.declared->pass) + (ofFallback ? " fallback" : ""), Pass::Shade};
    switch (info.over) {
        case package::Over::Nothing:
            break;
        case package::Over::Rays:
            passes_.dispatchList(label, pass(info.role), state_.frame.rayDispatch, 0);
            break;
        case package::Over::OrderedHits:
            passes_.dispatchList(label, pass(info.role), state_.frame.bucketDispatch,
                                 state_.size.bucketCount);
            break;
        case package::Over::Misses:
            if (!ofFallback || state_.pipelines.shadesUnknown) {
                passes_.setBucket(0);
                passes_.dispatchList(label, pass(info.role), state_.frame.bucketDispatch, 0);
            }
            break;
        case package::Over::Buckets:
            shadeCases(info);
            break;
    }
}

void HitPasses::shade() {
    for (const package::RoleInfo& info : package::rolesOf(state_.choice.strategy)) {
        dispatch(info);
    }
    passes_.barrier(dependencies().passToPass);
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
