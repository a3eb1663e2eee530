#include "data/vertex_format.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

namespace glint {
namespace {

constexpr double kMostCode = 65535.0;
constexpr std::size_t kGridWords = 6;  // least and step

// The numbers of one axis.
struct AxisGrid {
    float least = 0.0F;
    float step = 0.0F;
};

struct Bounds {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();
    bool finite = true;
};

template <typename Function>
bool allOf(std::span<const PrimitiveView> mesh, std::size_t axis, const Function& function) {
    return std::ranges::all_of(mesh, [&](const PrimitiveView& primitive) {
        return std::ranges::all_of(primitive.positions, [&](const std::array<float, 3>& position) {
            return function(position[axis]);
        });
    });
}

Bounds boundsOf(std::span<const PrimitiveView> mesh, std::size_t axis) {
    Bounds bounds;
    bounds.finite = allOf(mesh, axis, [&](float value) {
        bounds.least = std::min<double>(bounds.least, value);
        bounds.most = std::max<double>(bounds.most, value);
        return std::isfinite(value);
    });
    return bounds;
}

std::uint32_t codeOnAxis(float value, const AxisGrid& grid) {
    if (grid.step == 0.0F) {
        return 0;
    }
    const double code = (static_cast<double>(value) - grid.least) / grid.step;
    return static_cast<std::uint32_t>(std::clamp(std::round(code), 0.0, kMostCode));
}

// The product of a float and 16 bits is exact in a double, and a sum of two floats nearly always: the casts
// round as floats do.
float valueOnAxis(std::uint32_t code, const AxisGrid& grid) {
    const auto offset = static_cast<float>(static_cast<double>(grid.step) * code);
    return static_cast<float>(static_cast<double>(grid.least) + offset);
}

// Returns the exponent of the lowest bit that is set. 0 has no such bit and fits any exponent.
int lowestBit(float value) {
    if (value == 0.0F) {
        return std::numeric_limits<int>::max();
    }
    int exponent = 0;
    const auto digits = static_cast<std::uint32_t>(std::abs(std::frexp(value, &exponent)) * 16777216.0F);
    return exponent - 24 + std::countr_zero(digits);
}

// Tries the steps of integers in files (KHR_mesh_quantization): as they are, and as shares of 1.
std::optional<AxisGrid> gridOfIntegers(std::span<const PrimitiveView> mesh, std::size_t axis,
                                       const Bounds& bounds) {
    const double tolerance =
        std::max(std::abs(bounds.least), std::abs(bounds.most)) * std::numeric_limits<float>::epsilon() * 2.0;
    for (const double step : {1.0, 1.0 / 65535.0, 1.0 / 32767.0, 1.0 / 255.0, 1.0 / 127.0}) {
        const AxisGrid grid{static_cast<float>(bounds.least), static_cast<float>(step)};
        const bool keeps =
            bounds.most - bounds.least <= (kMostCode + 0.5) * step && allOf(mesh, axis, [&](float value) {
                const float kept = valueOnAxis(codeOnAxis(value, grid), grid);
                return std::abs(static_cast<double>(kept) - value) <= tolerance;
            });
        if (keeps) {
            return grid;
        }
    }
    return std::nullopt;
}

// Tries the largest power of two that divides all values.
std::optional<AxisGrid> gridOfPowers(std::span<const PrimitiveView> mesh, std::size_t axis,
                                     const Bounds& bounds) {
    int lowest = std::numeric_limits<int>::max();
    const double extent = bounds.most - bounds.least;
    const bool keeps = allOf(mesh, axis, [&](float value) {
        lowest = std::min(lowest, lowestBit(value));
        return extent <= std::ldexp(kMostCode, lowest);
    });
    // Smaller steps are no normal floats, which devices may take for 0.
    if (!keeps || lowest < std::numeric_limits<float>::min_exponent - 1) {
        return std::nullopt;
    }
    return AxisGrid{static_cast<float>(bounds.least), std::ldexp(1.0F, lowest)};
}

std::optional<AxisGrid> keepingAxis(std::span<const PrimitiveView> mesh, std::size_t axis,
                                    const Bounds& bounds) {
    if (bounds.least == bounds.most) {
        return AxisGrid{static_cast<float>(bounds.least), 0.0F};
    }
    const std::optional<AxisGrid> powers = gridOfPowers(mesh, axis, bounds);
    return powers ? powers : gridOfIntegers(mesh, axis, bounds);
}

// Makes a grid of the three axes, each by `make`.
template <typename Make>
std::optional<PositionGrid> gridOf(std::span<const PrimitiveView> mesh, const Make& make) {
    PositionGrid grid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Bounds bounds = boundsOf(mesh, axis);
        if (!bounds.finite || bounds.least > bounds.most) {
            return std::nullopt;
        }
        const std::optional<AxisGrid> made = make(axis, bounds);
        if (!made) {
            return std::nullopt;
        }
        grid.least[axis] = made->least;
        grid.step[axis] = made->step;
    }
    return grid;
}

bool deforms(const PrimitiveView& primitive) {
    return !primitive.joints.empty() || !primitive.targets.empty();
}

}  // namespace

std::optional<PositionGrid> findGrid(std::span<const PrimitiveView> mesh) {
    return gridOf(mesh,
                  [&](std::size_t axis, const Bounds& bounds) { return keepingAxis(mesh, axis, bounds); });
}

std::optional<PositionGrid> coverByGrid(std::span<const PrimitiveView> mesh) {
    return gridOf(mesh, [&](std::size_t axis, const Bounds& bounds) -> std::optional<AxisGrid> {
        if (const std::optional<AxisGrid> kept = keepingAxis(mesh, axis, bounds)) {
            return kept;
        }
        const auto step = static_cast<float>((bounds.most - bounds.least) / kMostCode);
        if (!std::isnormal(step)) {
            return std::nullopt;
        }
        return AxisGrid{static_cast<float>(bounds.least), step};
    });
}

GridPositions placeOnGrid(std::span<const std::array<float, 3>> positions, const PositionGrid& grid) {
    GridPositions placed;
    placed.values.reserve(positions.size());
    placed.words.resize(kGridWords + (3 * positions.size() + 1) / 2);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        placed.words[axis] = std::bit_cast<std::uint32_t>(grid.least[axis]);
        placed.words[3 + axis] = std::bit_cast<std::uint32_t>(grid.step[axis]);
    }
    std::size_t half = 2 * kGridWords;
    for (const std::array<float, 3>& position : positions) {
        std::array<float, 3>& value = placed.values.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const AxisGrid ofAxis{grid.least[axis], grid.step[axis]};
            const std::uint32_t code = codeOnAxis(position[axis], ofAxis);
            value[axis] = valueOnAxis(code, ofAxis);
            placed.words[half / 2] |= code << (half % 2 * 16);
            ++half;
        }
    }
    return placed;
}

std::vector<GridPositions> packPositions(std::span<const PrimitiveView> primitives,
                                         SceneView::VertexForm form) {
    std::vector<GridPositions> packed(primitives.size());
    for (std::size_t first = 0; first < primitives.size() && form != SceneView::VertexForm::Full;) {
        const auto end =
            std::find_if(primitives.begin() + static_cast<std::ptrdiff_t>(first), primitives.end(),
                         [&](const PrimitiveView& other) { return other.mesh != primitives[first].mesh; });
        const std::size_t count = static_cast<std::size_t>(std::distance(primitives.begin(), end)) - first;
        const std::span<const PrimitiveView> mesh = primitives.subspan(first, count);
        std::optional<PositionGrid> grid;
        if (std::ranges::none_of(mesh, deforms)) {
            grid = form == SceneView::VertexForm::Quantized ? coverByGrid(mesh) : findGrid(mesh);
        }
        for (std::size_t i = 0; grid && i < count; ++i) {
            packed[first + i] = placeOnGrid(mesh[i].positions, *grid);
        }
        first += count;
    }
    return packed;
}

std::vector<PrimitiveView> withPositions(std::span<const PrimitiveView> primitives,
                                         std::span<const GridPositions> positions) {
    std::vector<PrimitiveView> changed(primitives.begin(), primitives.end());
    for (std::size_t i = 0; i < changed.size(); ++i) {
        if (!positions[i].words.empty()) {
            changed[i].positions = positions[i].values;
        }
    }
    return changed;
}

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

// The largest step of coordinates: an eighth of a texel of 2048.
constexpr double kMostStep = 1.0 / 16384.0;

std::optional<AxisGrid> rangeOf(std::span<const std::array<float, 2>> texCoords, std::size_t axis) {
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
        return AxisGrid{0.0F, static_cast<float>(1.0 / 65535.0)};
    }
    const double step = (most - least) / kMostCode;
    if (!(step <= kMostStep)) {
        return std::nullopt;
    }
    return AxisGrid{static_cast<float>(least), static_cast<float>(step)};
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
    const std::optional<AxisGrid> u = rangeOf(texCoords, 0);
    const std::optional<AxisGrid> v = rangeOf(texCoords, 1);
    if (!u || !v) {
        return std::nullopt;
    }
    std::vector<std::uint32_t> words{
        std::bit_cast<std::uint32_t>(u->least), std::bit_cast<std::uint32_t>(v->least),
        std::bit_cast<std::uint32_t>(u->step), std::bit_cast<std::uint32_t>(v->step)};
    words.reserve(words.size() + texCoords.size());
    for (const std::array<float, 2>& uv : texCoords) {
        words.push_back(codeOnAxis(uv[0], *u) | codeOnAxis(uv[1], *v) << 16U);
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
