#include "oracle/spec/map.h"

#include "oracle/spec/directions.h"

#include <algorithm>
#include <cmath>

namespace glint::spec {
namespace {

using oracle::kPi;

// The real harmonics of orders 0 to 2 at a direction.
std::array<double, 9> harmonicsAt(const Vec3& d) {
    const double root = std::sqrt(1.0 / kPi);
    const double first = std::sqrt(3.0) * 0.5 * root;
    const double second = std::sqrt(15.0) * 0.5 * root;
    return {0.5 * root,
            first * d.x,
            first * d.y,
            first * d.z,
            second * d.x * d.y,
            second * d.y * d.z,
            second * d.x * d.z,
            std::sqrt(5.0) * 0.25 * root * (3.0 * d.z * d.z - 1.0),
            0.5 * second * (d.x * d.x - d.y * d.y)};
}

Vec3 directionAt(double column, double row, double width, double height) {
    const double polar = kPi * row / height;
    const double azimuth = 2.0 * kPi * (column / width - 0.5);
    return {std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)};
}

}  // namespace

Map::Map(std::size_t width, std::size_t height, const std::function<Vec3(const Vec3&)>& radiance)
    : width_(width), height_(height) {
    for (std::size_t row = 0; row < height; ++row) {
        for (std::size_t column = 0; column < width; ++column) {
            const Vec3 value =
                radiance(directionAt(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5,
                                     static_cast<double>(width), static_cast<double>(height)));
            texels_.emplace_back(static_cast<float>(value.x), static_cast<float>(value.y),
                                 static_cast<float>(value.z));
        }
    }
}

Vec3 Map::at(const Vec3& direction) const {
    const double u = std::atan2(direction.z, direction.x) / (2.0 * kPi) + 0.5;
    const double v = std::atan2(std::hypot(direction.x, direction.z), direction.y) / kPi;
    const auto width = static_cast<double>(width_);
    const auto height = static_cast<double>(height_);
    const double x = u * width - 0.5 + width;  // above 0
    const double y = std::clamp(v * height - 0.5, 0.0, height - 1.0);
    const auto column = static_cast<std::size_t>(x);
    const auto row = std::min(static_cast<std::size_t>(y), height_ - 2);
    const double right = x - static_cast<double>(column);
    const double below = y - static_cast<double>(row);
    const auto texel = [&](std::size_t r, std::size_t c) { return texels_[r * width_ + c % width_]; };
    return glm::mix(glm::mix(texel(row, column), texel(row, column + 1), right),
                    glm::mix(texel(row + 1, column), texel(row + 1, column + 1), right), below);
}

Harmonics::Harmonics(const Map& map) {
    const auto width = static_cast<double>(map.width());
    const auto height = static_cast<double>(map.height());
    for (std::size_t row = 0; row < map.height(); ++row) {
        const auto top = static_cast<double>(row);
        const double solidAngle =
            2.0 * kPi / width * (std::cos(kPi * top / height) - std::cos(kPi * (top + 1.0) / height));
        for (std::size_t column = 0; column < map.width(); ++column) {
            const auto basis =
                harmonicsAt(directionAt(static_cast<double>(column) + 0.5, top + 0.5, width, height));
            const Vec3 light = map.texels()[row * map.width() + column] * solidAngle;
            for (std::size_t i = 0; i < 9; ++i) {
                coefficients_[i] += light * basis[i];
            }
        }
    }
}

Vec3 Harmonics::irradianceOverPi(const Vec3& normal) const {
    const auto basis = harmonicsAt(normal);
    Vec3 sum(0.0);
    for (std::size_t i = 0; i < 9; ++i) {
        // The cosine lobe's own coefficients, over π: 1, 2/3 and 1/4.
        sum += coefficients_[i] * (basis[i] * (i == 0 ? 1.0 : i < 4 ? 2.0 / 3.0 : 0.25));
    }
    return glm::max(sum, Vec3(0.0));
}

Vec3 lobeMean(const Map& map, const Vec3& direction, double roughness) {
    if (roughness <= 0.0) {
        return map.at(direction);
    }
    const double alpha2 = std::pow(roughness, 4.0);
    const glm::dmat3 frame = oracle::frameAbout(direction);
    struct Sum {
        Vec3 light{0.0};
        double weight = 0.0;
        Sum& operator+=(const Sum& other) {
            light += other.light;
            weight += other.weight;
            return *this;
        }
        Sum operator/(double count) const {
            return {light / count, weight / count};
        }
    };
    const Sum sum = midpoints(64, 128, Sum{}, [&](const Vec2& point) {
        // Facets with the density D(h) (n·h).
        const double cosine2 = (1.0 - point.x) / (1.0 + (alpha2 - 1.0) * point.x);
        const double sine = std::sqrt(std::max(1.0 - cosine2, 0.0));
        const double phi = 2.0 * kPi * point.y;
        const Vec3 h(sine * std::cos(phi), sine * std::sin(phi), std::sqrt(cosine2));
        const Vec3 l = 2.0 * h.z * h - Vec3(0.0, 0.0, 1.0);
        return l.z > 0.0 ? Sum{map.at(frame * l) * l.z, l.z} : Sum{};
    });
    return sum.light / sum.weight;
}

Vec3 levelMean(const Map& map, const Vec3& direction, double roughness, int levels) {
    const double level = std::clamp(roughness, 0.0, 1.0) * (levels - 1);
    const double lower = std::min(std::floor(level), levels - 2.0);
    return glm::mix(lobeMean(map, direction, lower / (levels - 1)),
                    lobeMean(map, direction, (lower + 1.0) / (levels - 1)), level - lower);
}

Vec3 cosineMean(const Map& map, const Vec3& normal) {
    const glm::dmat3 frame = oracle::frameAbout(normal);
    return midpoints(64, 128, Vec3(0.0),
                     [&](const Vec2& point) { return map.at(frame * cosineDirection(point).l); });
}

}  // namespace glint::spec
