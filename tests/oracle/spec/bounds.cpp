#include "oracle/spec/bounds.h"

#include <fmt/format.h>

#include <cmath>

namespace glint::spec {
namespace {

constexpr double kBound = 0.02;
constexpr double kLightsBound = 0.002;
constexpr double kFurnaceBound = 0.01;

}  // namespace

std::string objectionTo(const Comparison& c) {
    const std::string light = kLightingNames[static_cast<std::size_t>(c.lighting)];
    const double bound = c.lighting == Lighting::Lights ? kLightsBound : kBound;
    std::string objection;
    if (!(std::abs(c.statedRatio() - 1.0) <= bound + c.noise())) {
        objection = fmt::format("{}: {:.4f} of what is stated, {:.4f} of the specification", light,
                                c.statedRatio(), c.ratio());
    }
    if (c.lighting == Lighting::Lights || c.map != MapKind::White || !c.white) {
        return objection;
    }
    for (std::size_t i = 0; i < c.zones.size(); ++i) {
        if (c.viewsOfZone[i] == 0) {
            continue;
        }
        // Without compensation the loss is the integral's.
        const Vec3 truth = c.compensation ? Vec3(1.0) : c.zones[i].stated;
        const double ratio = farthestRatio(c.zones[i].device, truth);
        if (!(std::abs(ratio - 1.0) <= kFurnaceBound + c.noise())) {
            objection += fmt::format("{}{}: {:.4f} in the furnace, zone {}", objection.empty() ? "" : "; ",
                                     light, ratio, i);
        }
    }
    return objection;
}

}  // namespace glint::spec
