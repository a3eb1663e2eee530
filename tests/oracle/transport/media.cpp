#include "oracle/transport/media.h"

#include "oracle/material_vectors.h"
#include "oracle/refraction.h"

namespace glint::oracle {

Medium mediumOf(const materials::Material& material) {
    Medium medium;
    medium.ior = Vec3(material["ior"]);
    if (material["dispersion"] > 0.0F && material["transmissionFactor"] > 0.0F) {
        const double spread = (material["ior"] - 1.0) * 0.025 * material["dispersion"];
        medium.ior += Vec3(-spread, 0.0, spread);
    }
    if (material["attenuationDistance"] > 0.0F) {
        medium.absorption =
            absorptionOf(toVec(material["attenuationColor"]), material["attenuationDistance"]);
    }
    return medium;
}

std::size_t Media::placeOf(int material) const {
    for (std::size_t i = inside_.size(); i > 0; --i) {
        if (inside_[i - 1] == material) {
            return i;
        }
    }
    return 0;
}

Vec3 Media::transmittance(double distance) const {
    if (inside_.empty()) {
        return Vec3(1.0);
    }
    const Vec3& absorption = (*all_)[static_cast<std::size_t>(inside_.back())].absorption;
    Vec3 passed(1.0);
    for (int channel = 0; channel < 3; ++channel) {
        // 0 times infinity is not a number.
        passed[channel] = absorption[channel] > 0.0 ? std::exp(-absorption[channel] * distance) : 1.0;
    }
    return passed;
}

Vec3 Media::outside(const SurfacePoint& point, bool& nested) const {
    std::size_t around = inside_.size();
    if (!point.front && around > 0 && placeOf(point.material) == around) {
        --around;
    }
    nested = around > 0;
    return nested ? (*all_)[static_cast<std::size_t>(inside_[around - 1])].ior : Vec3(1.0);
}

void Media::cross(const SurfacePoint& point) {
    if (point.front) {
        inside_.push_back(point.material);
    } else if (const std::size_t place = placeOf(point.material); place > 0) {
        inside_.erase(inside_.begin() + static_cast<std::ptrdiff_t>(place) - 1);
    }
}

}  // namespace glint::oracle
