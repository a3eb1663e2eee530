#include "measure/features/hemispheres.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint::measure {

namespace {

constexpr double kQuarterPi = std::numbers::pi / 4.0;

// The concentric map of Shirley and Chiu, "A Low Distortion Map Between Disk and Square" (1997), from [-1,
// 1]² to the unit disc, and then to the hemisphere so that areas stay.
Direction fromSquare(double a, double b) {
    double radius = 0.0;
    double angle = 0.0;
    if (std::abs(a) > std::abs(b)) {
        radius = a;
        angle = kQuarterPi * b / a;
    } else if (b != 0.0) {
        radius = b;
        angle = 2.0 * kQuarterPi - kQuarterPi * a / b;
    }
    const double across = radius * std::sqrt(std::max(2.0 - radius * radius, 0.0));
    return {across * std::cos(angle), across * std::sin(angle), 1.0 - radius * radius};
}

// The inverse; z >= 0.
std::array<double, 2> toSquare(const Direction& direction) {
    const double squared = direction[0] * direction[0] + direction[1] * direction[1];
    // 1 - z loses its digits near the pole.
    const double radius = std::sqrt(squared / (1.0 + std::min(direction[2], 1.0)));
    if (squared == 0.0) {
        return {0.0, 0.0};
    }
    double angle = std::atan2(direction[1], direction[0]);
    angle = angle < -kQuarterPi ? angle + 8.0 * kQuarterPi : angle;
    if (angle < kQuarterPi) {
        return {radius, radius * angle / kQuarterPi};
    }
    if (angle < 3.0 * kQuarterPi) {
        return {radius * (2.0 * kQuarterPi - angle) / kQuarterPi, radius};
    }
    if (angle < 5.0 * kQuarterPi) {
        return {-radius, -radius * (angle - 4.0 * kQuarterPi) / kQuarterPi};
    }
    return {radius * (angle - 6.0 * kQuarterPi) / kQuarterPi, -radius};
}

}  // namespace

double HemisphereCell::solidAngle() const {
    return std::ldexp(2.0 * std::numbers::pi, -2 * static_cast<int>(level));
}

Direction HemisphereCell::at(double u, double v) const {
    const double scale = std::ldexp(2.0, -static_cast<int>(level));
    Direction direction = fromSquare((x + u) * scale - 1.0, (y + v) * scale - 1.0);
    direction[2] = lower ? -direction[2] : direction[2];
    return direction;
}

std::uint64_t HemisphereCell::place() const {
    std::uint64_t code = lower ? 1 : 0;
    for (std::uint32_t bit = kDeepestLevel; bit-- > 0;) {
        const std::uint32_t shift = kDeepestLevel - level;
        code = code << 2U | (((y << shift) >> bit & 1U) << 1U) | ((x << shift) >> bit & 1U);
    }
    return code;
}

HemisphereCell cellOf(const Direction& direction) {
    const std::array<double, 2> place = toSquare({direction[0], direction[1], std::abs(direction[2])});
    constexpr double kSide = 1U << kDeepestLevel;
    const auto index = [](double coordinate) {
        return static_cast<std::uint32_t>(std::clamp((coordinate + 1.0) * 0.5 * kSide, 0.0, kSide - 1.0));
    };
    return {direction[2] < 0.0, kDeepestLevel, index(place[0]), index(place[1])};
}

bool liesWithin(const HemisphereCell& cell, const HemisphereCell& outer) {
    const std::uint32_t shift = cell.level - outer.level;
    return cell.lower == outer.lower && cell.level >= outer.level && cell.x >> shift == outer.x &&
           cell.y >> shift == outer.y;
}

}  // namespace glint::measure
