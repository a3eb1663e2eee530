#include "motion/motion_rules.h"

#include <cmath>

namespace glint {
namespace {

// Returns whether a box has moved, since the build, by more than its length at that time.
bool hasLeft(const Box& built, const Box& now) {
    if (built.isEmpty() || now.isEmpty()) {
        return built.isEmpty() != now.isEmpty();
    }
    const std::array<double, 3> from = built.centre();
    const std::array<double, 3> to = now.centre();
    return std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]) > built.diagonal();
}

}  // namespace

BuildAction BlasHistory::next(bool deformed, double surfaceNow) const {
    if (!deformed) {
        return BuildAction::Keep;
    }
    const bool worn = refits >= kMaxRefits || surfaceNow > kMaxGrowth * surface;
    return worn ? BuildAction::Build : BuildAction::Refit;
}

void BlasHistory::apply(BuildAction action, double surfaceNow) {
    if (action == BuildAction::Refit) {
        ++refits;
    } else if (action == BuildAction::Build) {
        refits = 0;
        surface = surfaceNow;
    }
}

BuildAction TlasHistory::next(bool moved, std::span<const Box> now) const {
    if (!moved) {
        return BuildAction::Keep;
    }
    if (updates >= kMaxRefits || now.size() != boxes.size()) {
        return BuildAction::Build;
    }
    for (std::size_t i = 0; i < now.size(); ++i) {
        if (hasLeft(boxes[i], now[i])) {
            return BuildAction::Build;
        }
    }
    return BuildAction::Refit;
}

void TlasHistory::apply(BuildAction action, std::span<const Box> now) {
    if (action == BuildAction::Refit) {
        ++updates;
    } else if (action == BuildAction::Build) {
        updates = 0;
        boxes.assign(now.begin(), now.end());
    }
}

}  // namespace glint
