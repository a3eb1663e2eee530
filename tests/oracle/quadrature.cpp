#include "oracle/quadrature.h"

#include <algorithm>

namespace glint::oracle {

double Random::next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1p-53;
}

Estimate averageOfEstimates(const Strata& strata, Random& random, const std::function<Estimate(Vec2)>& f) {
    Estimate result;
    Vec3 squaresOfMeans(0.0);
    const double cells = static_cast<double>(strata.strata) * strata.strata;
    for (int repeat = 0; repeat < strata.repeats; ++repeat) {
        Vec3 sum(0.0);
        for (int row = 0; row < strata.strata; ++row) {
            for (int column = 0; column < strata.strata; ++column) {
                const double x = (column + random.next()) / strata.strata;
                const double y = (row + random.next()) / strata.strata;
                const Estimate value = f({x, y});
                sum += value.mean;
                result.square += value.square / (cells * strata.repeats);
            }
        }
        const Vec3 mean = sum / cells;
        result.mean += mean / static_cast<double>(strata.repeats);
        squaresOfMeans += mean * mean / static_cast<double>(strata.repeats);
    }
    const Vec3 variance = glm::max(squaresOfMeans - result.mean * result.mean, Vec3(0.0));
    result.error = glm::sqrt(variance / (strata.repeats - 1.0));
    return result;
}

Estimate average(const Strata& strata, Random& random, const std::function<Vec3(Vec2)>& f) {
    return averageOfEstimates(strata, random, [&](Vec2 point) {
        const Vec3 value = f(point);
        return Estimate{value, Vec3(0.0), value * value};
    });
}

Vec3 cosineDirection(Vec2 point) {
    const double radius = std::sqrt(point.x);
    const double phi = 2.0 * kPi * point.y;
    return {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1.0 - point.x)};
}

Vec3 capDirection(Vec2 point, double halfAngle) {
    // The plain 1 - cosine would lose a narrow cap.
    const double half = std::sin(0.5 * halfAngle);
    const double height = 2.0 * half * half * point.x;
    const double sine = std::sqrt(height * (2.0 - height));
    const double phi = 2.0 * kPi * point.y;
    return {sine * std::cos(phi), sine * std::sin(phi), 1.0 - height};
}

}  // namespace glint::oracle
