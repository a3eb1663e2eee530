#include "oracle/spec/bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glint::spec {
namespace {

// The bounds of furnaces differ: an anisotropic lobe's albedo is a fit.
constexpr double kAnisotropicFurnaceBound = 0.012;
constexpr double kFurnaceBound = 0.01;

bool mentions(const Comparison& c, const char* word) {
    return c.name.find(word) != std::string::npos;
}

}  // namespace

Bound boundOf(const Comparison& c) {
    const bool anisotropic = mentions(c, "anisotropy");
    const bool sheen = mentions(c, "sheen");
    if (c.lighting == Lighting::Untraced) {
        if (anisotropic) {
            return c.map == MapKind::Spot
                       ? Bound{0.31,
                               "sixteen directions for an anisotropic lobe make a small spot too bright"}
                       : Bound{0.03, "sixteen directions stand in for an anisotropic lobe"};
        }
        if (sheen) {
            return {0.008, "the fit of the sheen's albedo"};
        }
        return c.map == MapKind::Spot ? Bound{0.015, "the levels of the map are sampled"}
                                      : Bound{0.004, "the levels of the map, and fits of albedos"};
    }
    if (c.lighting == Lighting::Traced) {
        if (anisotropic) {
            return {0.015, "the fit of an anisotropic lobe's albedo"};
        }
        return c.group == "normal map"
                   ? Bound{0.032, "what a lobe sends below the plane is mirrored at the plane"}
                   : Bound{0.005, "fits of albedos"};
    }
    if (c.compensation) {
        if (mentions(c, "thin glass")) {
            return {0.02, "fits of albedos, twice in light that passes at later bounces"};
        }
        return anisotropic ? Bound{0.025, "the fit of an anisotropic lobe's albedo, twice in diffuse light"}
                           : Bound{0.017, "fits of albedos, twice in diffuse light"};
    }
    if (sheen) {
        return {0.01, "the fit of the sheen's albedo"};
    }
    return c.group == "texture" || c.group == "normal map"
               ? Bound{0.008, "llvmpipe's sRGB texels are off by up to 0.7 %"}
               : Bound{0.0015, "single precision"};
}

namespace {

// Whether the device is within the bound in each channel. What is darker than a five-hundredth of the lights
// and the sky may be off by a thousandth of them. The fits of a lobe's albedo and of its Fresnel part are
// within 0.006 of white, which is much of a channel in which the surface is dark.
bool isWithin(const Comparison& c) {
    for (int i = 0; i < 3; ++i) {
        const double off = std::abs(c.whole.device[i] - c.whole.stated[i]);
        if (!(off <= boundOf(c).relative * c.whole.stated[i] + 4.0 * c.whole.error[i] +
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
        const double bound = mentions(c, "anisotropy") ? kAnisotropicFurnaceBound : kFurnaceBound;
        if (!(std::abs(ratio - 1.0) <= bound + c.noise())) {
            objection += fmt::format("{}{}: {:.4f} in the furnace, {}", objection.empty() ? "" : "; ", light,
                                     ratio, kZoneNames[i]);
        }
    }
    return objection;
}

}  // namespace glint::spec
