#include "alpha_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <utility>

namespace glint::test {
namespace {

using opacity::AlphaLookup;
using opacity::AlphaTexels;
using opacity::AlphaTriangle;
using opacity::ErrorModel;
using opacity::MicroTriangle;
using opacity::State;
using opacity::Wrap;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float moved(float value, int ulps, int lean) {
    for (int i = 0; i < ulps && lean != 0; ++i) {
        value = std::nextafter(value, lean < 0 ? -kInfinity : kInfinity);
    }
    return value;
}

long wrappedTexel(double texel, std::uint32_t size, Wrap wrap) {
    const double count = size;
    if (wrap == Wrap::Clamp) {
        return static_cast<long>(std::clamp(texel, 0.0, count - 1.0));
    }
    if (wrap == Wrap::Repeat) {
        return static_cast<long>(texel - count * std::floor(texel / count));
    }
    const double within = texel - 2.0 * count * std::floor(texel / (2.0 * count));
    return static_cast<long>(within < count ? within : 2.0 * count - 1.0 - within);
}

float texelAt(const AlphaLookup& lookup, double x, double y, int lean, const ErrorModel& model) {
    const AlphaTexels& texels = *lookup.texels;
    const long column = wrappedTexel(x, texels.width, lookup.wrapU);
    const long row = wrappedTexel(y, texels.height, lookup.wrapV);
    const int texel =
        texels.alpha[static_cast<std::size_t>(row) * texels.width + static_cast<std::size_t>(column)];
    const int decoded = std::clamp(texel + lean * model.texelSteps, 0, 255);
    const auto value = static_cast<float>(decoded / 255.0);
    return decoded == 0 || decoded == 255 ? value : moved(value, model.conversionUlps, lean);
}

float textureAt(const AlphaLookup& lookup, double x, double y, int lean, const ErrorModel& model) {
    if (!lookup.linear) {
        return texelAt(lookup, std::floor(x), std::floor(y), lean, model);
    }
    const double left = std::floor(x - 0.5);
    const double top = std::floor(y - 0.5);
    const double alongX = x - 0.5 - left;
    const double alongY = y - 0.5 - top;
    double value = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        const int right = corner % 2;
        const int below = corner / 2;
        const double weight = (right != 0 ? alongX : 1.0 - alongX) * (below != 0 ? alongY : 1.0 - alongY);
        if (weight > 0.0) {
            value += weight * texelAt(lookup, left + right, top + below, lean, model);
        }
    }
    return static_cast<float>(std::clamp(value + lean * model.filter, 0.0, 1.0));
}

float dotRow(const std::array<float, 3>& row, float u, float v) {
    return row[0] * u + row[1] * v + row[2];
}

// Barycentrics of the corners of a micro-triangle.
std::array<std::array<float, 2>, 3> cornersOf(const MicroTriangle& micro, std::uint32_t level) {
    const float step = 1.0F / static_cast<float>(1U << level);
    const float u = static_cast<float>(micro.u) * step;
    const float v = static_cast<float>(micro.v) * step;
    if (micro.inverted) {
        return {{{u + step, v + step}, {u, v + step}, {u + step, v}}};
    }
    return {{{u, v}, {u + step, v}, {u, v + step}}};
}

// Weights of the corners of a micro-triangle at which it is evaluated.
constexpr std::array<float, 3> kPoints[] = {{1, 0, 0},
                                            {0, 1, 0},
                                            {0, 0, 1},
                                            {0.5F, 0.5F, 0},
                                            {0.5F, 0, 0.5F},
                                            {0, 0.5F, 0.5F},
                                            {0.34F, 0.33F, 0.33F},
                                            {0.8F, 0.13F, 0.07F}};

// Evaluates a micro-triangle. Returns whether its state stands; `alpha` is one that contradicts.
class MicroCheck {
public:
    MicroCheck(const AlphaCase& given, const AlphaTriangle& triangle, const ErrorModel& model, bool whole)
        : given_(given), triangle_(triangle), model_(model), whole_(whole) {}

    bool contradicts(const MicroTriangle& micro, std::uint32_t level, State state, float& alpha) const {
        const int lean = state == State::Opaque ? -1 : 1;
        const auto corners = cornersOf(micro, level);
        for (const std::array<float, 3>& weights : kPoints) {
            for (int direction = 0; direction < 9; ++direction) {
                const double dx = (direction % 3 - 1) * model_.texelPosition * 0.999;
                const double dy = (direction / 3 - 1) * model_.texelPosition * 0.999;
                alpha = at(corners, weights, dx, dy, lean);
                const bool passes = alpha >= given_.material.cutoff;
                if (passes != (state == State::Opaque)) {
                    return true;
                }
            }
        }
        return false;
    }

    // Whether the alpha test has one answer at all points, with exact arithmetic.
    bool isUniform(const MicroTriangle& micro, std::uint32_t level) const {
        const auto corners = cornersOf(micro, level);
        int passing = 0;
        for (const std::array<float, 3>& weights : kPoints) {
            passing += at(corners, weights, 0.0, 0.0, 0) >= given_.material.cutoff ? 1 : 0;
        }
        return passing == 0 || passing == static_cast<int>(std::size(kPoints));
    }

private:
    float at(const std::array<std::array<float, 2>, 3>& corners, const std::array<float, 3>& weights,
             double dx, double dy, int lean) const {
        std::array<float, 2> point{};
        std::array<float, 2> middle{};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            for (std::size_t corner = 0; corner < 3; ++corner) {
                point[axis] += weights[corner] * corners[corner][axis];
                middle[axis] += corners[corner][axis] / 3.0F;
            }
            // Away from the middle, out of the micro-triangle, but not out of its triangle.
            const float outside = static_cast<float>(whole_ ? 0.0 : 0.99 * model_.microTriangle);
            point[axis] += point[axis] > middle[axis]   ? outside
                           : point[axis] < middle[axis] ? -outside
                                                        : 0.0F;
            point[axis] = std::clamp(point[axis], 0.0F, 1.0F);
        }
        point[1] = std::min(point[1], 1.0F - point[0]);
        return alphaAt(given_, triangle_, point[0], point[1], dx, dy, lean, model_);
    }

    const AlphaCase& given_;
    const AlphaTriangle& triangle_;
    const ErrorModel& model_;
    bool whole_;
};

// What a case is made of, from random numbers.
class CaseMaker {
public:
    explicit CaseMaker(std::uint64_t number) : random_(number * 0x9E3779B97F4A7C15ULL + 1) {}

    AlphaCase make(std::uint64_t number) {
        AlphaCase made;
        made.name = "case " + std::to_string(number);
        makeTexels(made.texels);
        makeMaterial(made);
        for (int i = 0; i < 4; ++i) {
            made.triangles.push_back(makeTriangle(made));
        }
        return made;
    }

private:
    std::uint32_t below(std::uint32_t end) {
        return static_cast<std::uint32_t>(random_() % end);
    }
    float within(float least, float most) {
        return std::uniform_real_distribution<float>(least, most)(random_);
    }

    void makeTexels(AlphaTexels& texels) {
        constexpr std::uint32_t kSizes[] = {1, 2, 3, 7, 16, 31, 64, 100};
        texels.width = kSizes[below(8)];
        texels.height = kSizes[below(8)];
        const std::uint32_t kind = below(5);
        const float radius = within(0.1F, 0.6F);
        const auto constant = static_cast<std::uint8_t>(below(256));
        for (std::uint32_t y = 0; y < texels.height; ++y) {
            for (std::uint32_t x = 0; x < texels.width; ++x) {
                const float u = (static_cast<float>(x) + 0.5F) / static_cast<float>(texels.width) - 0.5F;
                const float v = (static_cast<float>(y) + 0.5F) / static_cast<float>(texels.height) - 0.5F;
                const float edge = (radius - std::hypot(u, v)) * 4.0F * 255.0F + 127.5F;
                const std::uint32_t values[] = {
                    below(2) * 255, static_cast<std::uint32_t>(std::clamp(edge, 0.0F, 255.0F)), constant,
                    x * 255 / texels.width, below(50) == 0 ? 255U - constant : constant};
                texels.alpha.push_back(static_cast<std::uint8_t>(values[kind]));
            }
        }
    }

    void makeMaterial(AlphaCase& made) {
        AlphaLookup lookup;
        lookup.wrapU = static_cast<Wrap>(below(3));
        lookup.wrapV = static_cast<Wrap>(below(3));
        lookup.linear = below(2) == 0;
        if (below(3) == 0) {
            const float angle = within(0.0F, 2.0F * std::numbers::pi_v<float>);
            const float scale = within(-3.0F, 3.0F);
            lookup.rowU = {scale * std::cos(angle), scale * std::sin(angle), within(-1.0F, 1.0F)};
            lookup.rowV = {-std::sin(angle), std::cos(angle), within(-1.0F, 1.0F)};
        }
        const float factors[] = {
            1.0F, 1.0F, 1.0F, 0.5F, within(0.0F, 1.5F), 0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN()};
        made.material.factor = factors[below(below(8) == 0 ? 8 : 5)];
        made.material.lookup = lookup;
        made.material.lookup->texels = &made.texels;
        // Cutoffs that equal a texel, or a bound, and the numbers beside them.
        const std::uint32_t texel =
            made.texels.alpha[below(static_cast<std::uint32_t>(made.texels.alpha.size()))];
        const auto exact = static_cast<float>(texel / 255.0);
        const opacity::AlphaBounds bounds = opacity::boundsOf(made.material, texel, texel, {1.0F, 1.0F}, {});
        const float cutoffs[] = {0.5F,
                                 0.5F,
                                 exact,
                                 std::nextafter(exact, 2.0F),
                                 std::nextafter(exact, -1.0F),
                                 bounds.least,
                                 std::nextafter(bounds.least, 2.0F),
                                 bounds.most,
                                 std::nextafter(bounds.most, 2.0F),
                                 made.material.factor * exact,
                                 0.0F,
                                 1.0F,
                                 1.5F,
                                 within(0.0F, 1.0F)};
        made.material.cutoff = cutoffs[below(14)];
    }

    AlphaTriangle makeTriangle(const AlphaCase& made) {
        AlphaTriangle triangle;
        const std::uint32_t kind = below(9);
        const float size = kind < 3 ? 0.2F : 2.0F;
        const float offset = kind == 4 ? 100.0F : kind == 5 ? 3000.0F : 0.0F;
        const float centre[] = {within(-2.0F, 2.0F) + offset, within(-2.0F, 2.0F) - offset};
        for (std::array<float, 2>& uv : triangle.uv) {
            uv = {centre[0] + within(-size, size), centre[1] + within(-size, size)};
            if (kind == 6) {  // on texel borders and on the seam
                uv[0] = std::round(uv[0] * static_cast<float>(made.texels.width)) /
                        static_cast<float>(made.texels.width);
                uv[1] = std::round(uv[1]);
            }
        }
        if (kind == 7) {
            triangle.uv[1] = triangle.uv[0];
            triangle.uv[2] = below(2) == 0 ? triangle.uv[0] : triangle.uv[2];
        }
        if (kind == 8 && below(4) == 0) {
            const float bad[] = {std::numeric_limits<float>::quiet_NaN(), kInfinity, 1e30F, -1e9F};
            triangle.uv[below(3)][below(2)] = bad[below(4)];
        }
        if (below(4) == 0) {
            triangle.vertexAlpha = {within(0.0F, 1.0F), within(0.0F, 1.0F), within(0.0F, 1.0F)};
            if (below(2) == 0) {
                triangle.vertexAlpha = {1.0F, 1.0F, 1.0F};
            }
        }
        return triangle;
    }

    std::mt19937_64 random_;
};

// Whether no arithmetic gives a number.
bool isHopeless(const AlphaCase& given, const AlphaTriangle& triangle) {
    bool finite = std::isfinite(given.material.factor);
    for (const std::array<float, 2>& uv : triangle.uv) {
        finite = finite && std::isfinite(uv[0]) && std::isfinite(uv[1]);
    }
    return !finite;
}

}  // namespace

AlphaCase makeAlphaCase(std::uint64_t number) {
    AlphaCase made = CaseMaker(number).make(number);
    return made;
}

float alphaAt(const AlphaCase& given, const AlphaTriangle& triangle, float u, float v, double dx, double dy,
              int lean, const ErrorModel& model) {
    const float w = 1.0F - u - v;
    float alpha = given.material.factor;
    if (given.material.lookup) {
        AlphaLookup lookup = *given.material.lookup;
        lookup.texels = &given.texels;
        const auto& uv = triangle.uv;
        const float s = w * uv[0][0] + u * uv[1][0] + v * uv[2][0];
        const float t = w * uv[0][1] + u * uv[1][1] + v * uv[2][1];
        const double x = static_cast<double>(dotRow(lookup.rowU, s, t)) * given.texels.width + dx;
        const double y = static_cast<double>(dotRow(lookup.rowV, s, t)) * given.texels.height + dy;
        const float texel = textureAt(lookup, x, y, lean, model);
        const bool exact = alpha == 0.0F || alpha == 1.0F || texel == 0.0F || texel == 1.0F;
        alpha = exact ? alpha * texel : moved(alpha * texel, model.productUlps, lean);
    }
    if (triangle.vertexAlpha) {
        const std::array<float, 3>& vertex = *triangle.vertexAlpha;
        const float product = alpha * (w * vertex[0] + u * vertex[1] + v * vertex[2]);
        alpha = product == 0.0F ? 0.0F : moved(product, model.productUlps, lean);
    }
    return alpha;
}

void checkStates(const AlphaCase& given, const opacity::MicromapArray& array, const ErrorModel& model,
                 CheckedStates& checked) {
    for (std::size_t i = 0; i < given.triangles.size(); ++i) {
        const std::int32_t index = array.indices[i];
        const std::uint32_t level =
            index < 0 ? 0 : array.records[static_cast<std::size_t>(index)].subdivisionLevel;
        const MicroCheck check(given, given.triangles[i], model, level == 0);
        const bool hopeless = isHopeless(given, given.triangles[i]);
        const std::uint32_t steps = 1U << level;
        for (std::uint32_t v = 0; v < steps; ++v) {
            for (std::uint32_t u = 0; u + v < steps; ++u) {
                for (const bool inverted : {false, true}) {
                    if (inverted && u + v + 1 >= steps) {
                        continue;
                    }
                    const MicroTriangle micro{u, v, inverted};
                    const std::uint32_t place = opacity::curveIndex(micro, level);
                    const State state = stateAt(array, i, place, level);
                    ++checked.microTriangles;
                    if (!opacity::isKnown(state)) {
                        checked.needless += !hopeless && check.isUniform(micro, level) ? 1 : 0;
                        continue;
                    }
                    ++checked.known;
                    checked.opaque += state == State::Opaque ? 1 : 0;
                    float alpha = 0.0F;
                    if (hopeless || check.contradicts(micro, level, state, alpha)) {
                        checked.wrong.push_back({i, place, level, alpha});
                    }
                }
            }
        }
    }
}

opacity::MicroTriangle microTriangleAt(float u, float v, std::uint32_t level) {
    const std::uint32_t steps = 1U << level;
    const float alongU = std::clamp(u, 0.0F, 1.0F) * static_cast<float>(steps);
    const float alongV = std::clamp(v, 0.0F, 1.0F) * static_cast<float>(steps);
    auto cellU = static_cast<std::uint32_t>(alongU);
    auto cellV = static_cast<std::uint32_t>(alongV);
    const float restU = alongU - static_cast<float>(cellU);
    const float restV = alongV - static_cast<float>(cellV);
    cellU = std::min(cellU, steps - 1);
    cellV = std::min(cellV, steps - 1);
    const std::uint32_t sum = cellU + cellV;
    if (sum >= steps) {
        cellU -= sum - steps + 1;
    }
    return {cellU, cellV, restU + restV >= 1.0F && sum < steps - 1};
}

State stateAt(const opacity::MicromapArray& array, std::size_t triangle, std::uint32_t place,
              std::uint32_t level) {
    const std::int32_t index = array.indices[triangle];
    if (index < 0) {
        return static_cast<State>(~index);
    }
    const opacity::MicromapRecord& record = array.records[static_cast<std::size_t>(index)];
    const std::uint32_t own = place >> (2 * (level - record.subdivisionLevel));
    const std::size_t bit = std::size_t{own} * record.format;
    const std::uint32_t value = array.data[record.dataOffset + bit / 8] >> (bit % 8);
    return static_cast<State>(value & ((1U << record.format) - 1U));
}

std::optional<const char*> faultIn(const opacity::MicromapArray& array, std::uint32_t maxLevel) {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> regions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> counts;
    for (const opacity::MicromapRecord& record : array.records) {
        if (record.format != opacity::kTwoStates && record.format != opacity::kFourStates) {
            return "a record has a format that is neither 1 nor 2";
        }
        if (record.subdivisionLevel > maxLevel) {
            return "a record has a subdivision level above the limit";
        }
        const std::uint64_t first = record.dataOffset;
        regions.emplace_back(first, first + opacity::bytesOfStates(record.subdivisionLevel, record.format));
        ++counts[{record.subdivisionLevel, record.format}];
    }
    std::ranges::sort(regions);
    for (std::size_t i = 0; i < regions.size(); ++i) {
        if (regions[i].second > array.data.size()) {
            return "the states of a record are outside of the data";
        }
        if (i > 0 && regions[i].first < regions[i - 1].second) {
            return "the states of two records overlap";
        }
    }
    for (const std::int32_t index : array.indices) {
        if (index < opacity::specialIndex(State::UnknownOpaque) ||
            (index >= 0 && static_cast<std::size_t>(index) >= array.records.size())) {
            return "an index is neither that of a record nor a special one";
        }
    }
    for (const opacity::MicromapUsage& usage : array.usages) {
        counts[{usage.subdivisionLevel, usage.format}] -= usage.count;
    }
    if (std::ranges::any_of(counts, [](const auto& entry) { return entry.second != 0; })) {
        return "the usages do not count the records";
    }
    return std::nullopt;
}

}  // namespace glint::test
