#include "data/alpha_states.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace glint::opacity {

namespace {

// --- The texels that lookups within a triangle can reach ---

// A triangle in texels of an image: texel t covers [t, t + 1].
struct TexelTriangle {
    std::array<double, 3> x{};
    std::array<double, 3> y{};
    // The error that a lookup's coordinates may have.
    double marginX = 0.0;
    double marginY = 0.0;
};

struct TexelRange {
    std::uint32_t least = 255;
    std::uint32_t most = 0;
};

// Beyond this distance 32 bits no longer distinguish texels, and the whole image counts as reached.
constexpr double kFarthest = 0x1p22;
// An image that is repeated more often counts as reached whole.
constexpr double kMostRepeats = 4.0;

std::int64_t floorDivided(std::int64_t value, std::int64_t by) {
    return value / by - (value % by < 0 ? 1 : 0);
}

void extendRun(const std::uint8_t* texels, std::int64_t first, std::int64_t last, TexelRange& range) {
    std::uint8_t least = 255;
    std::uint8_t most = 0;
    for (std::int64_t i = first; i <= last; ++i) {
        least = std::min(least, texels[i]);
        most = std::max(most, texels[i]);
    }
    range.least = std::min<std::uint32_t>(range.least, least);
    range.most = std::max<std::uint32_t>(range.most, most);
}

struct Ends {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();

    void extend(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
};

// The ends in x of the part of a triangle between two heights. Intersections are rounded in double, which the
// margins of the lookup cover many times.
Ends endsBetween(const TexelTriangle& triangle, double lower, double upper) {
    Ends ends;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const double fromY = triangle.y[i];
        const double toY = triangle.y[j];
        if (fromY >= lower && fromY <= upper) {
            ends.extend(triangle.x[i]);
        }
        for (const double height : {lower, upper}) {
            if ((fromY < height) != (toY < height)) {
                const double at = std::clamp((height - fromY) / (toY - fromY), 0.0, 1.0);
                ends.extend(triangle.x[i] + at * (triangle.x[j] - triangle.x[i]));
            }
        }
    }
    return ends;
}

// Returns the texel in [0, size) that a wrap mode reads for any texel.
std::uint32_t wrapped(std::int64_t texel, std::uint32_t size, Wrap wrap) {
    const auto count = static_cast<std::int64_t>(size);
    if (wrap == Wrap::Clamp) {
        return static_cast<std::uint32_t>(std::clamp<std::int64_t>(texel, 0, count - 1));
    }
    const std::int64_t period = floorDivided(texel, count);
    const std::int64_t within = texel - period * count;
    const bool flipped = wrap == Wrap::Mirror && period % 2 != 0;
    return static_cast<std::uint32_t>(flipped ? count - 1 - within : within);
}

// Walks over every texel that a lookup in the triangle can read: row by row of texels, in each row between
// the ends of the part of the triangle whose lookups reach the row. The walk is exact: it visits only texels
// that some point of the triangle reaches when it is moved by at most the margins.
class TexelWalk {
public:
    // Requires finite numbers. Keeps references.
    TexelWalk(const AlphaLookup& lookup, const TexelTriangle& triangle)
        : lookup_(lookup),
          triangle_(triangle),
          // A linear filter at x reads the texels whose centres are within one texel of x.
          below_(lookup.linear ? 1.5 : 1.0),
          above_(lookup.linear ? 0.5 : 0.0) {
        const auto [lowX, highX] = std::ranges::minmax(triangle.x);
        const auto [lowY, highY] = std::ranges::minmax(triangle.y);
        const double far = std::max({-lowX, highX, -lowY, highY}) + triangle.marginX + triangle.marginY;
        whole_ = !(far < kFarthest) || highY - lowY > kMostRepeats * lookup.texels->height + 16.0;
        if (!whole_) {
            row_ = static_cast<std::int64_t>(std::ceil(lowY - below_ - triangle.marginY));
            lastRow_ = static_cast<std::int64_t>(std::floor(highY + above_ + triangle.marginY));
        }
    }

    // Extends `range` by the next row. Returns false if there was none.
    bool next(TexelRange& range) {
        if (whole_) {
            whole_ = false;
            extendAll(range);
            return true;
        }
        if (row_ > lastRow_) {
            return false;
        }
        const auto row = static_cast<double>(row_);
        const Ends ends =
            endsBetween(triangle_, row - above_ - triangle_.marginY, row + below_ + triangle_.marginY);
        if (ends.least <= ends.most) {
            extendRow(row_, static_cast<std::int64_t>(std::ceil(ends.least - below_ - triangle_.marginX)),
                      static_cast<std::int64_t>(std::floor(ends.most + above_ + triangle_.marginX)), range);
        }
        ++row_;
        return true;
    }

private:
    void extendAll(TexelRange& range) const {
        const AlphaTexels& texels = *lookup_.texels;
        extendRun(texels.alpha.data(), 0, std::int64_t{texels.width} * texels.height - 1, range);
    }

    void extendRow(std::int64_t row, std::int64_t first, std::int64_t last, TexelRange& range) const {
        const AlphaTexels& texels = *lookup_.texels;
        const auto width = static_cast<std::int64_t>(texels.width);
        const std::uint8_t* const line =
            texels.alpha.data() + std::size_t{wrapped(row, texels.height, lookup_.wrapV)} * texels.width;
        if (lookup_.wrapU == Wrap::Clamp) {
            extendRun(line, wrapped(first, texels.width, Wrap::Clamp),
                      wrapped(last, texels.width, Wrap::Clamp), range);
            return;
        }
        if (last - first + 1 >= width) {
            extendRun(line, 0, width - 1, range);
            return;
        }
        // At most two repetitions of the image are touched.
        while (first <= last) {
            const std::int64_t end = std::min(last, (floorDivided(first, width) + 1) * width - 1);
            const std::int64_t a = wrapped(first, texels.width, lookup_.wrapU);
            const std::int64_t b = wrapped(end, texels.width, lookup_.wrapU);
            extendRun(line, std::min(a, b), std::max(a, b), range);
            first = end + 1;
        }
    }

    const AlphaLookup& lookup_;
    const TexelTriangle& triangle_;
    double below_;  // a lookup at x reaches texels from x - below on
    double above_;  // and up to x + above
    bool whole_ = false;
    std::int64_t row_ = 0;
    std::int64_t lastRow_ = -1;
};

constexpr float kLeastNormal = std::numeric_limits<float>::min();
constexpr double kSteps = 255.0;

// Barycentrics of the corners 1 and 2.
using Point = std::array<double, 2>;
using Corners = std::array<Point, 3>;

float stepped(float value, int ulps, float towards) {
    for (int i = 0; i < ulps; ++i) {
        value = std::nextafter(value, towards);
    }
    return value;
}

float multiplied(float a, float b, int ulps, float towards) {
    const bool isExact = a == 0.0F || b == 0.0F || a == 1.0F || b == 1.0F;
    if (isExact) {
        return a * b;
    }
    return stepped(a * b, ulps, towards);
}

// The least or the largest value that a shader may read from a texel.
float valueOf(std::uint32_t texel, int ulps, float towards) {
    const bool isExact = texel == 0 || texel == 255;
    const auto value = static_cast<float>(static_cast<double>(texel) / kSteps);
    return isExact ? value : stepped(value, ulps, towards);
}

// Returns a texel's value, moved by the filter's error. Filters make no values outside of [0, 1].
float filtered(float value, double error, float towards) {
    if (error == 0.0) {
        return value;
    }
    const auto moved = static_cast<float>(static_cast<double>(value) + std::copysign(error, towards));
    return std::clamp(stepped(moved, 1, towards), 0.0F, 1.0F);
}

float interpolated(const std::array<float, 3>& corners, const Point& at) {
    return static_cast<float>((1.0 - at[0] - at[1]) * corners[0] + at[0] * corners[1] + at[1] * corners[2]);
}

// A part of a triangle in the lattice of micro-triangles, of `size` steps.
struct Part {
    MicroTriangle place;
    std::uint32_t size = 1;
};

Corners cornersOf(const Part& part, std::uint32_t steps) {
    const double step = 1.0 / steps;
    const double u = part.place.u * step;
    const double v = part.place.v * step;
    const double size = part.size * step;
    if (part.place.inverted) {
        return {{{u + size, v + size}, {u, v + size}, {u + size, v}}};
    }
    return {{{u, v}, {u + size, v}, {u, v + size}}};
}

std::array<Part, 4> quartersOf(const Part& part) {
    const std::uint32_t half = part.size / 2;
    const auto [u, v, inverted] = part.place;
    const std::uint32_t farU = u + half;
    const std::uint32_t farV = v + half;
    // The middle part is inverted.
    const MicroTriangle middle = inverted ? MicroTriangle{farU, farV, false} : MicroTriangle{u, v, true};
    const MicroTriangle first = inverted ? MicroTriangle{farU, farV, true} : MicroTriangle{u, v, false};
    return {{{first, half}, {{farU, v, inverted}, half}, {{u, farV, inverted}, half}, {middle, half}}};
}

// Proves states of parts of one triangle.
class Prover {
public:
    Prover(const AlphaMaterial& material, const AlphaTriangle& triangle, const ErrorModel& model)
        : material_(material), triangle_(triangle), model_(model) {
        provable_ = isUsable(material.factor) && !std::isnan(material.cutoff) &&
                    (material.cutoff <= 0.0F || material.cutoff >= kLeastNormal);
        if (triangle.vertexAlpha) {
            provable_ = provable_ && std::ranges::all_of(*triangle.vertexAlpha, isUsable);
        }
        if (material.lookup) {
            placeInTexels(*material.lookup);
        }
    }

    // Barycentrics may be `outside` far outside of the part.
    State stateOf(const Corners& corners, double outside) const {
        if (!provable_) {
            return State::UnknownOpaque;
        }
        const AlphaBounds vertex = vertexAlphaIn(corners, outside);
        TexelRange range;
        if (!material_.lookup) {
            return judge(boundsOf(material_, 255, 255, vertex, model_));
        }
        const TexelTriangle part = partInTexels(corners, outside);
        TexelWalk walk(*material_.lookup, part);
        AlphaBounds bounds;
        while (walk.next(range)) {
            bounds = boundsOf(material_, range.least, range.most, vertex, model_);
            if (bounds.least < material_.cutoff && bounds.most >= material_.cutoff) {
                break;
            }
        }
        return range.least <= range.most ? judge(bounds) : State::UnknownOpaque;
    }

    // The side to which an unknown part leans.
    State leaningOf(const Corners& corners) const {
        const Point middle{(corners[0][0] + corners[1][0] + corners[2][0]) / 3.0,
                           (corners[0][1] + corners[1][1] + corners[2][1]) / 3.0};
        float alpha = material_.factor;
        if (material_.lookup && provable_) {
            const AlphaLookup& lookup = *material_.lookup;
            const AlphaTexels& texels = *lookup.texels;
            const auto [x, y] = placeOf(middle);
            const bool isNear = std::abs(x) < 0x1p31 && std::abs(y) < 0x1p31;
            const std::uint32_t column =
                isNear ? wrapped(static_cast<std::int64_t>(std::floor(x)), texels.width, lookup.wrapU) : 0;
            const std::uint32_t row =
                isNear ? wrapped(static_cast<std::int64_t>(std::floor(y)), texels.height, lookup.wrapV) : 0;
            alpha *= static_cast<float>(texels.alpha[std::size_t{row} * texels.width + column] / kSteps);
        }
        alpha *= triangle_.vertexAlpha ? interpolated(*triangle_.vertexAlpha, middle) : 1.0F;
        return alpha >= material_.cutoff ? State::UnknownOpaque : State::UnknownTransparent;
    }

    // The longest edge in texels; 0 without a texture.
    double longestEdge() const {
        double longest = 0.0;
        for (std::size_t i = 0; material_.lookup && provable_ && i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            longest = std::max(longest, std::hypot(x_[j] - x_[i], y_[j] - y_[i]));
        }
        return longest;
    }

private:
    static bool isUsable(float value) {
        return std::isfinite(value) && value >= 0.0F;
    }

    void placeInTexels(const AlphaLookup& lookup) {
        const auto row = [&](const std::array<float, 3>& factors, std::uint32_t size,
                             std::array<double, 3>& target) {
            double largest = 0.0;
            for (std::size_t i = 0; i < 3; ++i) {
                const double u = triangle_.uv[i][0];
                const double v = triangle_.uv[i][1];
                target[i] = (factors[0] * u + factors[1] * v + factors[2]) * size;
                largest = std::max(largest, std::abs(factors[0] * u) + std::abs(factors[1] * v) +
                                                std::abs(static_cast<double>(factors[2])));
                provable_ = provable_ && std::isfinite(target[i]);
            }
            return largest * size;
        };
        marginX_ = model_.coordinate * row(lookup.rowU, lookup.texels->width, x_) + model_.texelPosition;
        marginY_ = model_.coordinate * row(lookup.rowV, lookup.texels->height, y_) + model_.texelPosition;
        provable_ = provable_ && std::isfinite(marginX_) && std::isfinite(marginY_);
    }

    std::array<double, 2> placeOf(const Point& at) const {
        const double first = 1.0 - at[0] - at[1];
        return {first * x_[0] + at[0] * x_[1] + at[1] * x_[2], first * y_[0] + at[0] * y_[1] + at[1] * y_[2]};
    }

    TexelTriangle partInTexels(const Corners& corners, double outside) const {
        TexelTriangle part;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [x, y] = placeOf(corners[i]);
            part.x[i] = x;
            part.y[i] = y;
        }
        const auto extent = [](const std::array<double, 3>& values) {
            const auto [least, most] = std::ranges::minmax(values);
            return most - least;
        };
        part.marginX = marginX_ + 2.0 * outside * extent(x_);
        part.marginY = marginY_ + 2.0 * outside * extent(y_);
        return part;
    }

    AlphaBounds vertexAlphaIn(const Corners& corners, double outside) const {
        if (!triangle_.vertexAlpha) {
            return {1.0F, 1.0F};
        }
        const std::array<float, 3>& alpha = *triangle_.vertexAlpha;
        const auto [smallest, largest] = std::ranges::minmax(alpha);
        const double error = model_.vertexAlpha * largest +
                             2.0 * outside * (static_cast<double>(largest) - static_cast<double>(smallest));
        double least = std::numeric_limits<double>::infinity();
        double most = 0.0;
        for (const Point& corner : corners) {
            const double at = interpolated(alpha, corner);
            least = std::min(least, at);
            most = std::max(most, at);
        }
        return {static_cast<float>(std::max(least - error, 0.0)), static_cast<float>(most + error)};
    }

    State judge(const AlphaBounds& bounds) const {
        if (bounds.least >= material_.cutoff) {
            return State::Opaque;
        }
        return bounds.most < material_.cutoff ? State::Transparent : State::UnknownOpaque;
    }

    const AlphaMaterial& material_;
    const AlphaTriangle& triangle_;
    const ErrorModel& model_;
    bool provable_ = true;
    // The triangle in texels, and the error of a lookup's coordinates.
    std::array<double, 3> x_{};
    std::array<double, 3> y_{};
    double marginX_ = 0.0;
    double marginY_ = 0.0;
};

// Finds the states of a part and of all that is in it.
void fillPart(const Prover& prover, const ErrorModel& model, const Part& part, std::uint32_t level,
              TriangleStates& found) {
    const Corners corners = cornersOf(part, 1U << found.level);
    const State state = prover.stateOf(corners, model.outside + model.microTriangle);
    if (!isKnown(state) && level < found.level) {
        for (const Part& quarter : quartersOf(part)) {
            fillPart(prover, model, quarter, level + 1, found);
        }
        return;
    }
    // The micro-triangles of a part follow each other on the curve.
    const std::uint32_t below = found.level - level;
    const MicroTriangle atLevel{part.place.u >> below, part.place.v >> below, part.place.inverted};
    const std::size_t first = std::size_t{curveIndex(atLevel, level)} << (2 * below);
    std::fill_n(found.states.begin() + static_cast<std::ptrdiff_t>(first), microTriangles(below),
                isKnown(state) ? state : prover.leaningOf(corners));
}

constexpr Corners kWhole{{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}};

}  // namespace

AlphaBounds boundsOf(const AlphaMaterial& material, std::uint32_t leastTexel, std::uint32_t mostTexel,
                     const AlphaBounds& vertex, const ErrorModel& model) {
    AlphaBounds bounds{material.factor, material.factor};
    constexpr float kUp = std::numeric_limits<float>::infinity();
    if (material.lookup) {
        const auto steps = static_cast<std::uint32_t>(model.texelSteps);
        const double error = material.lookup->linear ? model.filter : 0.0;
        const float least = valueOf(leastTexel - std::min(leastTexel, steps), model.conversionUlps, -kUp);
        const float most = valueOf(std::min(mostTexel + steps, 255U), model.conversionUlps, kUp);
        bounds.least = multiplied(bounds.least, filtered(least, error, -kUp), model.productUlps, -kUp);
        bounds.most = multiplied(bounds.most, filtered(most, error, kUp), model.productUlps, kUp);
    }
    bounds.least = multiplied(bounds.least, vertex.least, model.productUlps, -kUp);
    bounds.most = multiplied(bounds.most, vertex.most, model.productUlps, kUp);
    // Devices may flush denormal numbers.
    bounds.least = bounds.least < kLeastNormal ? 0.0F : bounds.least;
    return bounds;
}

State stateOf(const AlphaMaterial& material, const AlphaTriangle& triangle, const ErrorModel& model) {
    const Prover prover(material, triangle, model);
    const State state = prover.stateOf(kWhole, model.outside);
    return isKnown(state) ? state : prover.leaningOf(kWhole);
}

TriangleStates statesOf(const AlphaMaterial& material, const AlphaTriangle& triangle, std::uint32_t maxLevel,
                        double texels, const ErrorModel& model) {
    const Prover prover(material, triangle, model);
    TriangleStates found;
    const State whole = prover.stateOf(kWhole, model.outside);
    if (isKnown(whole)) {
        found.states = {whole};
        return found;
    }
    const double edge = prover.longestEdge();
    while (found.level < maxLevel && edge > texels * static_cast<double>(1U << found.level)) {
        ++found.level;
    }
    // Without a texture, vertex alpha alone decides, and a few lines through the triangle are enough.
    found.level = triangle.vertexAlpha && !material.lookup ? std::min(maxLevel, 3U) : found.level;
    found.states.resize(microTriangles(found.level));
    fillPart(prover, model, {{0, 0, false}, 1U << found.level}, 0, found);
    return found;
}

}  // namespace glint::opacity
