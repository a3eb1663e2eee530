#include "oracle/comparison.h"

#include "oracle/table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

namespace glint::oracle {
namespace {

// ln(2 / 1e-5).
constexpr double kExponent = 12.2;

// Bernstein's inequality: the mean of n independent values with this variance, within `range` of their mean,
// is off by more than this with a probability of at most 2 exp(-kExponent).
double bernstein(double variance, double range, double n) {
    const double linear = kExponent * range / (3.0 * n);
    return linear + std::sqrt(linear * linear + 2.0 * kExponent * variance / n);
}

// Pictures have single precision. This bounds the error of the sum of a few such numbers.
double rounding(double value) {
    return 4e-6 * std::max(1.0, value);
}

// Pixels each way.
constexpr std::uint32_t kTile = 6;
using TileKey = std::array<std::uint32_t, 3>;  // column, row, channel

struct Tile {
    std::uint32_t count = 0;
    double sum = 0.0;
    double squares = 0.0;

    void add(double error) {
        ++count;
        sum += error;
        squares += error * error;
    }
    double mean() const {
        return sum / count;
    }
    double standardError() const {
        return std::sqrt(std::max(squares / count - mean() * mean(), 0.0) / (count - 1.0));
    }
};

// Finds truths by their places.
class Neighbours {
public:
    explicit Neighbours(const std::vector<PixelTruth>& truths) {
        for (const PixelTruth& truth : truths) {
            means_[{truth.x, truth.y}] = truth.light.mean;
        }
    }
    // Returns twice the difference between the largest and the smallest mean of a pixel and those around it.
    // An edge that only touches a corner of the pixel shows in a neighbour.
    double span(const PixelTruth& truth, std::uint32_t channel) const {
        double low = truth.light.mean[static_cast<int>(channel)];
        double high = low;
        for (const std::uint32_t x : {truth.x - 1, truth.x, truth.x + 1}) {
            for (const std::uint32_t y : {truth.y - 1, truth.y, truth.y + 1}) {
                if (const auto found = means_.find({x, y}); found != means_.end()) {
                    low = std::min(low, found->second[static_cast<int>(channel)]);
                    high = std::max(high, found->second[static_cast<int>(channel)]);
                }
            }
        }
        return 2.0 * (high - low);
    }

private:
    std::map<std::array<std::uint32_t, 2>, Vec3> means_;
};

bool wholePixel(const View& view, std::uint32_t x, std::uint32_t y, const Selector& selected) {
    constexpr int kSteps = 16;
    // The rasteriser rounds to 1/256 of a pixel.
    constexpr double kMargin = 0.005;
    for (int i = 0; i <= kSteps; ++i) {
        for (int k = 0; k <= kSteps; ++k) {
            const double across = (1.0 + 2.0 * kMargin) * i / kSteps - kMargin;
            const double down = (1.0 + 2.0 * kMargin) * k / kSteps - kMargin;
            if (!selected(view.ray(x + across, y + down))) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace

std::vector<PixelTruth> pixelTruths(const View& view, const Strata& strata, const Selector& selected,
                                    const RayLight& light) {
    std::vector<PixelTruth> truths;
    for (std::uint32_t y = 0; y < view.height(); ++y) {
        for (std::uint32_t x = 0; x < view.width(); ++x) {
            if (wholePixel(view, x, y, selected)) {
                Random random(static_cast<std::uint64_t>(y) << 32U | x);
                truths.push_back({x, y, averageOfEstimates(strata, random, [&](Vec2 point) {
                                      return light(view.ray(x + point.x, y + point.y), random);
                                  })});
            }
        }
    }
    return truths;
}

std::vector<PixelTruth> centreTruths(const View& view, const std::function<Vec3(const Ray&)>& light) {
    constexpr double kNear = 1.0 / 128.0;
    std::vector<PixelTruth> truths;
    for (std::uint32_t y = 0; y < view.height(); ++y) {
        for (std::uint32_t x = 0; x < view.width(); ++x) {
            const Vec3 value = light(view.ray(x + 0.5, y + 0.5));
            bool steady = true;
            for (const Vec2& offset :
                 {Vec2(kNear, kNear), Vec2(-kNear, kNear), Vec2(kNear, -kNear), Vec2(-kNear, -kNear)}) {
                const Vec3 change = glm::abs(light(view.ray(x + 0.5 + offset.x, y + 0.5 + offset.y)) - value);
                steady = steady && glm::all(glm::lessThan(change, 0.01 * glm::max(value, Vec3(1.0))));
            }
            if (steady) {
                truths.push_back({x, y, {value, Vec3(0.0), value * value}});
            }
        }
    }
    return truths;
}

Comparison compare(const LinearImage& image, const std::vector<PixelTruth>& truths, const Subject& subject) {
    Comparison result;
    result.pixels = truths.size();
    const double count = static_cast<double>(truths.size()) * subject.channels;
    double squares = 0.0;
    double expectedSquares = 0.0;
    std::string worst;
    const Neighbours neighbours(truths);
    std::map<TileKey, Tile> tiles;
    std::array<Tile, 3> channels;
    for (const PixelTruth& truth : truths) {
        const auto& pixel = image.pixels[static_cast<std::size_t>(truth.y) * image.width + truth.x];
        for (std::uint32_t channel = 0; channel < subject.channels; ++channel) {
            const double value = truth.light.mean[static_cast<int>(channel)];
            const double ownError = truth.light.error[static_cast<int>(channel)];
            const double variance =
                std::max(truth.light.square[static_cast<int>(channel)] - value * value, 0.0);
            const double range = subject.range > 0.0
                                     ? subject.range
                                     : neighbours.span(truth, channel) + 10.0 * std::sqrt(variance);
            const double found = pixel[channel];
            const double error = std::isfinite(found) ? found - value : kInfinity;
            const double bound =
                bernstein(variance, range, subject.samples) + 5.0 * ownError + subject.bias + rounding(value);
            if (!(std::abs(error) <= result.worst * bound)) {
                result.worst = std::abs(error) / bound;
                worst = fmt::format("pixel ({}, {}), channel {} is {} instead of {} ± {}", truth.x, truth.y,
                                    channel, found, value, bound);
            }
            tiles[{truth.x / kTile, truth.y / kTile, channel}].add(error);
            result.mean += value / count;
            result.largest = std::max(result.largest, std::abs(error));
            channels[channel].add(error);
            squares += error * error / count;
            expectedSquares += (variance / subject.samples + ownError * ownError) / count;
        }
    }
    result.rootMeanSquare = std::sqrt(squares);
    result.expected = std::sqrt(expectedSquares);
    const double exactness = subject.bias + rounding(result.mean);
    for (std::uint32_t channel = 0; channel < subject.channels; ++channel) {
        if (!(std::abs(channels[channel].mean()) <= std::abs(result.signedMean))) {
            result.signedMean = channels[channel].mean();
            result.signedError = channels[channel].standardError();
        }
        if (!(std::abs(channels[channel].mean()) <= 4.0 * channels[channel].standardError() + exactness)) {
            result.objections.push_back(fmt::format("the mean of channel {} is off by {} ± {}", channel,
                                                    channels[channel].mean(),
                                                    channels[channel].standardError()));
        }
    }
    std::string worstTile;
    for (const auto& [key, tile] : tiles) {
        if (tile.count < kTile * kTile / 2 || !std::isfinite(tile.sum)) {
            continue;
        }
        const double bound = 6.0 * tile.standardError() + exactness;
        if (std::abs(tile.mean()) > result.worstTile * bound) {
            result.worstTile = std::abs(tile.mean()) / bound;
            worstTile =
                fmt::format("the tile of pixels from ({}, {}) on, channel {}, is off by {} ± {} on the mean",
                            key[0] * kTile, key[1] * kTile, key[2], tile.mean(), tile.standardError());
        }
    }
    if (!(result.worst <= 1.0)) {
        result.objections.push_back(worst);
    }
    if (!(result.worstTile <= 1.0)) {
        result.objections.push_back(worstTile);
    }
    if (!(result.rootMeanSquare <= 1.2 * result.expected + exactness)) {
        result.objections.push_back(
            fmt::format("the root mean square error is {}, that of independent samples {}",
                        result.rootMeanSquare, result.expected));
    }
    return result;
}

void expectAgrees(const LinearImage& image, const std::vector<PixelTruth>& truths, const Subject& subject) {
    const std::string name = subject.effect + ", " + subject.what + ", " + subject.truth;
    if (image.pixels.empty() || truths.empty()) {
        ADD_FAILURE() << name << ": nothing to compare";
        return;
    }
    const Comparison comparison = compare(image, truths, subject);
    for (const std::string& objection : comparison.objections) {
        ADD_FAILURE() << name << ": " << objection;
    }
    addRow(subject, comparison);
}

}  // namespace glint::oracle
