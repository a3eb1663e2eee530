#include "oracle/spec/bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glint::spec {
namespace {

constexpr double kFurnaceBound = 0.01;

bool mentions(const Comparison& c, const char* word) {
    return c.name.find(word) != std::string::npos;
}

// How far the device may be from what is stated, relative to that, besides the noise of its samples.
double boundOf(const Comparison& c) {
    const bool anisotropic = mentions(c, "anisotropy");
    // The fit of the sheen's albedo is too high on dark cloth.
    const bool sheen = mentions(c, "sheen");
    if (c.lighting == Lighting::Untraced) {
        // Sixteen directions stand in for an anisotropic lobe. They show a spot of few texels up to half too
        // bright. The levels are within 3 % of the integral over the map (docs/reflections.md).
        return anisotropic ? (c.map == MapKind::Spot ? 0.6 : 0.06)
               : sheen     ? 0.06
                           : (c.map == MapKind::Spot ? 0.035 : 0.02);
    }
    if (c.lighting == Lighting::Traced) {
        // What a lobe sends below the plane of a normal-mapped surface is mirrored at the plane.
        return anisotropic ? 0.05 : c.group == "normal map" ? 0.04 : 0.02;
    }
    // Single precision and 8-bit weights: llvmpipe's sRGB texels are off by up to 0.7 %.
    double bound = c.group == "texture" || c.group == "normal map" ? 0.008 : 0.002;
    if (sheen) {
        bound = std::max(bound, 0.012);
    }
    if (c.compensation) {
        // The fits of E are within 0.006 of the truth, and diffuse light has them twice.
        bound = std::max(bound, anisotropic ? 0.05 : 0.02);
    }
    return bound;
}

// Whether the device is within the bound in each channel. What is darker than a five-hundredth of the lights
// and the sky may be off by a thousandth of them. The fits of a lobe's albedo and of its Fresnel part are
// within 0.006 of white, which is much of a channel in which the surface is dark.
bool isWithin(const Comparison& c) {
    for (int i = 0; i < 3; ++i) {
        const double off = std::abs(c.whole.device[i] - c.whole.stated[i]);
        if (!(off <= boundOf(c) * c.whole.stated[i] + 4.0 * c.whole.error[i] +
                         (c.lighting != Lighting::Lights ? 0.006
                          : c.whole.stated[i] < 2e-3     ? 1e-3
                                                         : 0.0))) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::string objectionTo(const Comparison& c) {
    const std::string light = kLightingNames[static_cast<std::size_t>(c.lighting)];
    const bool furnace = c.lighting != Lighting::Lights && c.map == MapKind::White && c.white;
    std::string objection;
    if (c.group != "sphere" && !isWithin(c)) {
        objection = fmt::format("{}: {:.4f} of what is stated, {:.4f} of the specification", light,
                                c.statedRatio(), c.ratio());
    }
    for (std::size_t i = 0; furnace && i < c.zones.size(); ++i) {
        // Spheres have no integral of their own; planes say what is lost.
        if (c.viewsOfZone[i] == 0 || (c.group == "sphere" && (c.losesByDesign || !c.compensation))) {
            continue;
        }
        // Without compensation the loss is that of the integral.
        const Vec3 truth = c.compensation && !c.losesByDesign ? Vec3(1.0) : c.zones[i].stated;
        const double ratio = farthestRatio(c.zones[i].device, truth);
        if (!(std::abs(ratio - 1.0) <= kFurnaceBound + c.noise())) {
            objection += fmt::format("{}{}: {:.4f} in the furnace, {}", objection.empty() ? "" : "; ", light,
                                     ratio, kZoneNames[i]);
        }
    }
    return objection;
}

}  // namespace glint::spec
