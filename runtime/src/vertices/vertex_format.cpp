#include "vertices/vertex_format.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace glint {
namespace {

using Vector = std::array<double, 3>;

constexpr double kUnitTolerance = 1e-3;

double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// These are the mappings octahedralEncode() and octahedralDecode() of shaders/hit/geometry.glsl.
std::array<double, 2> encode(const Vector& v) {
    const double sum = std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]);
    const double x = v[0] / sum;
    const double y = v[1] / sum;
    if (v[2] >= 0.0) {
        return {x, y};
    }
    return {(1.0 - std::abs(y)) * (x >= 0.0 ? 1.0 : -1.0), (1.0 - std::abs(x)) * (y >= 0.0 ? 1.0 : -1.0)};
}

Vector decode(double x, double y) {
    const double z = 1.0 - std::abs(x) - std::abs(y);
    const double t = std::max(-z, 0.0);
    const Vector v{x + (x >= 0.0 ? -t : t), y + (y >= 0.0 ? -t : t), z};
    const double length = std::sqrt(dot(v, v));
    return {v[0] / length, v[1] / length, v[2] / length};
}

struct Codes {
    int x = 0;
    int y = 0;
};

// Returns the codes of the direction nearest to v, with x in [-mostX, mostX] and y alike (Cigolle et al.
// 2014, "oct precise"). Rounding alone is up to twice as far off.
Codes nearestCodes(const Vector& v, int mostX, int mostY) {
    const std::array<double, 2> at = encode(v);
    Codes best;
    double closest = -2.0;
    for (int i = 0; i < 4; ++i) {
        const Codes tried{std::clamp(static_cast<int>(std::floor(at[0] * mostX)) + i % 2, -mostX, mostX),
                          std::clamp(static_cast<int>(std::floor(at[1] * mostY)) + i / 2, -mostY, mostY)};
        const double cosine =
            dot(v, decode(static_cast<double>(tried.x) / mostX, static_cast<double>(tried.y) / mostY));
        if (cosine > closest) {
            closest = cosine;
            best = tried;
        }
    }
    return best;
}

// Returns the vector with length 1, or no value if its length is not close to 1.
std::optional<Vector> unit(float x, float y, float z) {
    const Vector v{x, y, z};
    const double length = std::sqrt(dot(v, v));
    if (!(std::abs(length - 1.0) <= kUnitTolerance)) {
        return std::nullopt;
    }
    return Vector{v[0] / length, v[1] / length, v[2] / length};
}

std::uint32_t low16(int code) {
    return static_cast<std::uint32_t>(code) & 0xFFFFU;
}

// Returns whether a number is one of the steps of an integer of that size, as in a file of integers.
bool isStep(double value, double most) {
    const double steps = value * most;
    return std::abs(steps - std::round(steps)) <= 0.01;
}

// The numbers that coordinates are made of on one axis.
struct Range {
    float least = 0.0F;
    float step = 0.0F;
};

// The largest step of coordinates: an eighth of a texel of 2048.
constexpr double kMostStep = 1.0 / 16384.0;

std::optional<Range> rangeOf(std::span<const std::array<float, 2>> texCoords, std::size_t axis) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    bool integers = true;
    for (const std::array<float, 2>& uv : texCoords) {
        if (!std::isfinite(uv[axis])) {
            return std::nullopt;
        }
        least = std::min<double>(least, uv[axis]);
        most = std::max<double>(most, uv[axis]);
        integers = integers && isStep(uv[axis], 65535.0);
    }
    if (integers && least >= 0.0 && most <= 1.0) {
        return Range{0.0F, static_cast<float>(1.0 / 65535.0)};
    }
    const double step = (most - least) / 65535.0;
    if (!(step <= kMostStep)) {
        return std::nullopt;
    }
    return Range{static_cast<float>(least), static_cast<float>(step)};
}

std::uint32_t codeOf(float value, const Range& range) {
    if (range.step == 0.0F) {
        return 0;
    }
    const double code = (static_cast<double>(value) - range.least) / range.step;
    return static_cast<std::uint32_t>(std::clamp(std::round(code), 0.0, 65535.0));
}

}  // namespace

std::optional<std::vector<std::uint32_t>> packNormals(std::span<const std::array<float, 3>> normals) {
    std::vector<std::uint32_t> words;
    words.reserve(normals.size());
    for (const std::array<float, 3>& normal : normals) {
        const std::optional<Vector> direction = unit(normal[0], normal[1], normal[2]);
        if (!direction) {
            return std::nullopt;
        }
        const Codes codes = nearestCodes(*direction, 32767, 32767);
        words.push_back(low16(codes.x) | low16(codes.y) << 16U);
    }
    return words;
}

std::optional<std::vector<std::uint32_t>> packTangents(std::span<const std::array<float, 4>> tangents) {
    std::vector<std::uint32_t> words;
    words.reserve(tangents.size());
    for (const std::array<float, 4>& tangent : tangents) {
        const std::optional<Vector> direction = unit(tangent[0], tangent[1], tangent[2]);
        if (!direction || std::abs(tangent[3]) != 1.0F) {
            return std::nullopt;
        }
        const Codes codes = nearestCodes(*direction, 32767, 16383);
        const std::uint32_t sign = tangent[3] < 0.0F ? 1 : 0;
        words.push_back(low16(codes.x) | (static_cast<std::uint32_t>(codes.y) << 17U) | sign << 16U);
    }
    return words;
}

std::optional<std::vector<std::uint32_t>> packTexCoords(std::span<const std::array<float, 2>> texCoords) {
    const std::optional<Range> u = rangeOf(texCoords, 0);
    const std::optional<Range> v = rangeOf(texCoords, 1);
    if (!u || !v) {
        return std::nullopt;
    }
    std::vector<std::uint32_t> words{
        std::bit_cast<std::uint32_t>(u->least), std::bit_cast<std::uint32_t>(v->least),
        std::bit_cast<std::uint32_t>(u->step), std::bit_cast<std::uint32_t>(v->step)};
    words.reserve(words.size() + texCoords.size());
    for (const std::array<float, 2>& uv : texCoords) {
        words.push_back(codeOf(uv[0], *u) | codeOf(uv[1], *v) << 16U);
    }
    return words;
}

std::optional<PackedColors> packColors(std::span<const std::array<float, 4>> colors) {
    PackedColors packed;
    packed.bits = 8;
    for (const std::array<float, 4>& color : colors) {
        for (const float channel : color) {
            if (!(channel >= 0.0F && channel <= 1.0F)) {
                return std::nullopt;
            }
            packed.bits = isStep(channel, 255.0) ? packed.bits : 16;
        }
    }
    const auto code = [](float channel, double most) {
        return static_cast<std::uint32_t>(std::round(channel * most));
    };
    for (const std::array<float, 4>& color : colors) {
        if (packed.bits == 8) {
            packed.words.push_back(code(color[0], 255.0) | code(color[1], 255.0) << 8U |
                                   code(color[2], 255.0) << 16U | code(color[3], 255.0) << 24U);
        } else {
            packed.words.push_back(code(color[0], 65535.0) | code(color[1], 65535.0) << 16U);
            packed.words.push_back(code(color[2], 65535.0) | code(color[3], 65535.0) << 16U);
        }
    }
    return packed;
}

}  // namespace glint
