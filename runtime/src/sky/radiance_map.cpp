#include "sky/radiance_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace glint {
namespace {

// The source cells [first, first + weights.size()) that a target cell covers, and the share that each has of
// it.
struct Coverage {
    std::uint32_t first = 0;
    std::vector<double> weights;  // their sum is 1
};

// Cells divide [0, 1] evenly. `measure` is monotonic and maps [0, 1] to the measure by which shares are
// weighted.
template <typename Measure>
std::vector<Coverage> coverages(std::uint32_t sources, std::uint32_t targets, const Measure& measure) {
    std::vector<Coverage> result(targets);
    for (std::uint64_t target = 0; target < targets; ++target) {
        const double begin = measure(static_cast<double>(target) / targets);
        const double end = measure(static_cast<double>(target + 1) / targets);
        const std::uint64_t first = target * sources / targets;
        const std::uint64_t last = ((target + 1) * sources + targets - 1) / targets;
        Coverage& coverage = result[target];
        coverage.first = static_cast<std::uint32_t>(first);
        for (std::uint64_t source = first; source < last; ++source) {
            const double from = std::clamp(measure(static_cast<double>(source) / sources),
                                           std::min(begin, end), std::max(begin, end));
            const double to = std::clamp(measure(static_cast<double>(source + 1) / sources),
                                         std::min(begin, end), std::max(begin, end));
            coverage.weights.push_back((to - from) / (end - begin));
        }
    }
    return result;
}

Diagnostic radianceError(const std::string& what, std::size_t pixel, std::uint32_t width) {
    return makeError("environment-radiance", "",
                     "the pixel at column " + std::to_string(pixel % width) + ", row " +
                         std::to_string(pixel / width) + " from the top left " + what,
                     "correct the image: radiance is 0 to 1e18");
}

}  // namespace

Result<CheckedMap> checkMap(const LinearImage& image) {
    const std::size_t count = std::size_t{image.width} * image.height;
    if (count == 0 || image.pixels.size() != count) {
        return makeError("environment-size", "",
                         "the environment's image is " + std::to_string(image.width) + " x " +
                             std::to_string(image.height) + " with " + std::to_string(image.pixels.size()) +
                             " pixels",
                         "give an image with all its pixels");
    }
    CheckedMap checked;
    checked.map = {image.width, image.height, {}};
    checked.map.texels.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        bool negative = false;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const float value = image.pixels[i][channel];
            if (!(std::abs(value) <= kMaxRadiance)) {
                return radianceError(std::isnan(value)   ? "is NaN"
                                     : std::isinf(value) ? "is infinite"
                                                         : "is brighter than 1e18",
                                     i, image.width);
            }
            negative = negative || value < 0.0F;
            checked.map.texels[i][channel] = std::max(value, 0.0F);
        }
        checked.negativePixels += negative ? 1 : 0;
    }
    return checked;
}

double cosineAbove(std::uint32_t row, std::uint32_t height) {
    return std::cos(std::numbers::pi * row / height);
}

double texelSolidAngle(std::uint32_t row, std::uint32_t width, std::uint32_t height) {
    return 2.0 * std::numbers::pi / width * (cosineAbove(row, height) - cosineAbove(row + 1, height));
}

RadianceMap resample(const RadianceMap& map, std::uint32_t width, std::uint32_t height) {
    const std::vector<Coverage> columns = coverages(map.width, width, [](double u) { return u; });
    const std::vector<Coverage> rows =
        coverages(map.height, height, [](double v) { return std::cos(std::numbers::pi * v); });
    RadianceMap result{width, height, {}};
    result.texels.reserve(std::size_t{width} * height);
    std::vector<std::array<double, 3>> row(map.width);
    for (const Coverage& covered : rows) {
        row.assign(map.width, {});
        for (std::size_t i = 0; i < covered.weights.size(); ++i) {
            const Radiance* source = &map.texels[(covered.first + i) * map.width];
            for (std::uint32_t x = 0; x < map.width; ++x) {
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    row[x][channel] += covered.weights[i] * source[x][channel];
                }
            }
        }
        for (const Coverage& column : columns) {
            std::array<double, 3> sum{};
            for (std::size_t i = 0; i < column.weights.size(); ++i) {
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    sum[channel] += column.weights[i] * row[column.first + i][channel];
                }
            }
            result.texels.push_back(
                {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])});
        }
    }
    return result;
}

}  // namespace glint
