#include "scene/draw_runs.h"

#include <iterator>
#include <utility>

namespace glint {
namespace {

bool isAlike(const Draw& a, const Draw& b) {
    return a.mesh == b.mesh && a.primitive == b.primitive && a.vertexCount == b.vertexCount &&
           a.doubleSided == b.doubleSided && a.mirrored == b.mirrored;
}

}  // namespace

void DrawRuns::set(std::uint32_t instance, std::vector<Draw> draws) {
    cut(instance);
    cut(instance + 1);
    runs_.erase(instance);
    if (!draws.empty()) {
        runs_[instance].draws = std::move(draws);
        join(instance + 1);
        join(instance);
    }
}

void DrawRuns::cut(std::uint32_t instance) {
    const auto next = runs_.lower_bound(instance);
    if (next == runs_.begin()) {
        return;
    }
    const auto& [first, run] = *std::prev(next);
    if (instance - first >= run.count) {
        return;
    }
    Run rest = run;
    rest.count -= instance - first;
    for (Draw& draw : rest.draws) {
        draw.geometry += (instance - first) * run.stride;
    }
    std::prev(next)->second.count = instance - first;
    runs_.emplace(instance, std::move(rest));
}

void DrawRuns::join(std::uint32_t instance) {
    const auto place = runs_.find(instance);
    if (place == runs_.end() || place == runs_.begin()) {
        return;
    }
    auto& [first, run] = *std::prev(place);
    const Run& next = place->second;
    if (instance - first != run.count || run.draws.size() != next.draws.size()) {
        return;
    }
    const std::uint32_t distance = next.draws.front().geometry - run.draws.front().geometry;
    const std::uint32_t stride = distance - (run.count - 1) * run.stride;
    bool joins = (run.count == 1 || run.stride == stride) && (next.count == 1 || next.stride == stride);
    for (std::size_t i = 0; i < run.draws.size() && joins; ++i) {
        joins = isAlike(run.draws[i], next.draws[i]) &&
                next.draws[i].geometry - run.draws[i].geometry == distance;
    }
    if (joins) {
        run.count += next.count;
        run.stride = stride;
        runs_.erase(place);
    }
}

std::vector<DrawBatch> DrawRuns::batches() const {
    std::vector<DrawBatch> batches;
    for (const auto& [first, run] : runs_) {
        for (const Draw& draw : run.draws) {
            batches.push_back(
                {draw.geometry, run.stride, run.count, draw.vertexCount, draw.doubleSided, draw.mirrored});
        }
    }
    return batches;
}

}  // namespace glint
