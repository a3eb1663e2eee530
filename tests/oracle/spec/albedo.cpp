#include "oracle/spec/albedo.h"

#include "oracle/spec/directions.h"

#include <algorithm>
#include <cmath>

namespace glint::spec {
namespace {

constexpr int kCosines = 96;
constexpr int kAzimuths = 9;

// Node i is at a cosine of ((i + ½) / kCosines)², so that there are more of them near grazing.
double cosineOfNode(int node) {
    return squared((node + 0.5) / kCosines);
}

// The position of a cosine between the nodes, as the node below and the share of the next.
std::pair<std::size_t, double> placeOf(double cosine) {
    const double place = std::clamp(std::sqrt(std::max(cosine, 0.0)) * kCosines - 0.5, 0.0, kCosines - 1.0);
    const auto node = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(kCosines - 2));
    return {node, place - static_cast<double>(node)};
}

// The loss is integrated, not the albedo, whose difference from 1 would have no digits for smooth lobes.
MicrofacetAlbedo::Value integrate(const Vec3& v, const Vec2& alpha, Masking masking) {
    // Anisotropic lobes have nine times as many views.
    const int points = alpha.x == alpha.y ? 64 : 32;
    const Vec3 sums = midpoints(points, 2 * points, Vec3(0.0), [&](const Vec2& point) {
        const Direction d = reflectedDirection(v, alpha, point);
        if (d.solidAngle <= 0.0) {
            return Vec3(0.0);
        }
        const Vec3 h = glm::normalize(v + d.l);
        // What the facets that are visible would reflect if nothing hid them from the light.
        const double seen = 0.25 * visibleNormalDensity(v, h, alpha) / glm::dot(v, h) * d.solidAngle;
        const double lobe =
            d.l.z > 0.0 ? distribution(h, alpha) * visibility(d.l, v, alpha, masking) * d.l.z * d.solidAngle
                        : 0.0;
        const double weight = schlickWeight(glm::dot(v, h));
        return Vec3(seen - lobe, lobe * weight, seen * weight);
    });
    return {sums.x, sums.y, sums.z};
}

}  // namespace

MicrofacetAlbedo::MicrofacetAlbedo(const Vec2& alpha, Masking masking) {
    const int azimuths = alpha.x == alpha.y ? 1 : kAzimuths;
    for (int j = 0; j < azimuths; ++j) {
        const double azimuth = azimuths == 1 ? 0.0 : 0.5 * kPi * j / (kAzimuths - 1);
        std::vector<Value>& row = table_.emplace_back();
        for (int i = 0; i < kCosines; ++i) {
            row.push_back(integrate(polarDirection(cosineOfNode(i), azimuth), alpha, masking));
        }
    }
    // Over s = √μ the mean is 4 ∫ E s³ ds, at midpoints; azimuths by the trapezoidal rule.
    double total = 0.0;
    for (int j = 0; j < azimuths; ++j) {
        const double share = azimuths > 1 && (j == 0 || j == azimuths - 1) ? 0.5 : 1.0;
        for (int i = 0; i < kCosines; ++i) {
            const double weight = share * std::pow((i + 0.5) / kCosines, 3.0);
            mean_.lost += weight * table_[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)].lost;
            mean_.weighted +=
                weight * table_[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)].weighted;
            total += weight;
        }
    }
    mean_.lost /= total;
    mean_.weighted /= total;
}

MicrofacetAlbedo::Value MicrofacetAlbedo::at(const Vec3& v) const {
    const auto [node, share] = placeOf(v.z);
    const auto between = [&, node = node, share = share](const std::vector<Value>& row) {
        return Value{std::lerp(row[node].lost, row[node + 1].lost, share),
                     std::lerp(row[node].weighted, row[node + 1].weighted, share),
                     std::lerp(row[node].seen, row[node + 1].seen, share)};
    };
    if (table_.size() == 1) {
        return between(table_[0]);
    }
    const double azimuth = std::atan2(std::abs(v.y), std::abs(v.x)) / (0.5 * kPi) * (kAzimuths - 1);
    const auto row = std::min(static_cast<std::size_t>(azimuth), static_cast<std::size_t>(kAzimuths - 2));
    const double next = azimuth - static_cast<double>(row);
    const Value a = between(table_[row]);
    const Value b = between(table_[row + 1]);
    return {std::lerp(a.lost, b.lost, next), std::lerp(a.weighted, b.weighted, next),
            std::lerp(a.seen, b.seen, next)};
}

SheenAlbedo::SheenAlbedo(double alpha) {
    for (int i = 0; i < kCosines; ++i) {
        const Vec3 v = polarDirection(cosineOfNode(i), 0.0);
        table_.push_back(midpoints(64, 96, 0.0, [&](const Vec2& point) {
            const Direction d = cosineDirection(point);
            const Vec3 h = glm::normalize(v + d.l);
            return sheenDistribution(h.z, alpha) * sheenVisibility(d.l.z, v.z, alpha) * d.l.z * d.solidAngle;
        }));
    }
}

double SheenAlbedo::at(double cosine) const {
    const auto [node, share] = placeOf(cosine);
    return std::lerp(table_[node], table_[node + 1], share);
}

const MicrofacetAlbedo& Albedos::microfacets(const Vec2& alpha, Masking masking) {
    auto& entry = microfacets_[{{alpha.x, alpha.y}, masking}];
    if (!entry) {
        entry = std::make_unique<MicrofacetAlbedo>(alpha, masking);
    }
    return *entry;
}

const SheenAlbedo& Albedos::sheen(double alpha) {
    auto& entry = sheens_[alpha];
    if (!entry) {
        entry = std::make_unique<SheenAlbedo>(alpha);
    }
    return *entry;
}

}  // namespace glint::spec
