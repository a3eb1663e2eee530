// Directional albedos, integrated numerically: what a white lobe reflects of a uniform white sky.
#pragma once

#include "oracle/spec/lobes.h"

#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace glint::spec {

// The albedo of Trowbridge-Reitz microfacets that reflect once. With Schlick's Fresnel it is f0 (E - y) + f90
// y.
class MicrofacetAlbedo {
public:
    MicrofacetAlbedo(const Vec2& alpha, Masking masking);

    struct Value {
        double lost = 0.0;      // 1 - E, where E is the albedo with a reflectance of 1
        double weighted = 0.0;  // y: with a reflectance of (1 - v·h)⁵
        double seen = 0.0;      // the mean of (1 - v·h)⁵ over visible facets; not of the mean over views
        double whole() const {
            return 1.0 - lost;
        }
    };
    // At a direction with z > 0, interpolated between 96 cosines, and 9 azimuths if the alphas differ.
    Value at(const Vec3& v) const;
    // 2 ∫ E(μ) μ dμ, and the mean over azimuths.
    const Value& mean() const {
        return mean_;
    }

private:
    std::vector<std::vector<Value>> table_;  // by azimuth in a quarter turn, then by the root of the cosine
    Value mean_;
};

// The albedo of the sheen lobe as the text has it. Near grazing it may exceed 1.
class SheenAlbedo {
public:
    explicit SheenAlbedo(double alpha);
    double at(double cosine) const;

private:
    std::vector<double> table_;  // by the root of the cosine
};

// Keeps what was integrated, because the materials of a table share alphas. Not for use by several threads.
class Albedos {
public:
    const MicrofacetAlbedo& microfacets(const Vec2& alpha, Masking masking);
    const SheenAlbedo& sheen(double alpha);

private:
    std::map<std::pair<std::pair<double, double>, Masking>, std::unique_ptr<MicrofacetAlbedo>> microfacets_;
    std::map<double, std::unique_ptr<SheenAlbedo>> sheens_;
};

}  // namespace glint::spec
