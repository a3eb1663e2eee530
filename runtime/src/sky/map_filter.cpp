#include "sky/map_filter.h"

#include "context/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>

namespace glint {
namespace {

struct Cell {
    std::size_t index = 0;
    double fraction = 0.0;  // position in the cell, [0, 1)
};

// Returns the cell of running sums that `target` falls into. It never returns a cell without weight.
Cell findCell(std::span<const double> sums, double target) {
    const auto after = std::upper_bound(sums.begin(), sums.end(), target);
    std::size_t index = static_cast<std::size_t>(after - sums.begin());
    // Rounding may bring the target up to the last sum.
    index = std::clamp<std::size_t>(index, 1, sums.size() - 1);
    while (index > 1 && sums[index] == sums[index - 1]) {
        --index;
    }
    const double width = sums[index] - sums[index - 1];
    return {index - 1, std::clamp((target - sums[index - 1]) / width, 0.0, 1.0)};
}

}  // namespace

MapDistribution::MapDistribution(const RadianceMap& map) : width_(map.width), height_(map.height) {
    weights_.reserve(map.texels.size());
    for (const Radiance& radiance : map.texels) {
        weights_.push_back(luminance(radiance));
    }
    if (std::ranges::all_of(weights_, [](float weight) { return weight <= 0.0F; })) {
        std::ranges::fill(weights_, 1.0F);
    }
    rowSums_.assign(1, 0.0);
    columnSums_.reserve(std::size_t{width_ + 1} * height_);
    for (std::uint32_t row = 0; row < height_; ++row) {
        double sum = 0.0;
        columnSums_.push_back(sum);
        for (std::uint32_t column = 0; column < width_; ++column) {
            sum += weights_[std::size_t{row} * width_ + column];
            columnSums_.push_back(sum);
        }
        rowSums_.push_back(rowSums_.back() + sum * texelSolidAngle(row, width_, height_));
    }
    total_ = rowSums_.back();
}

MapSample MapDistribution::sample(double row, double column) const {
    const Cell inRows = findCell(rowSums_, row * total_);
    const std::span<const double> sums(&columnSums_[inRows.index * (width_ + 1)], width_ + 1);
    const Cell inColumns = findCell(sums, column * sums.back());
    const auto rowIndex = static_cast<std::uint32_t>(inRows.index);
    const double above = cosineAbove(rowIndex, height_);
    const double cosine = above + inRows.fraction * (cosineAbove(rowIndex + 1, height_) - above);
    const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    const double u = (static_cast<double>(inColumns.index) + inColumns.fraction) / width_;
    const double azimuth = 2.0 * std::numbers::pi * (u - 0.5);
    const std::size_t texel = inRows.index * width_ + inColumns.index;
    return {{sine * std::cos(azimuth), cosine, sine * std::sin(azimuth)}, texel, pdf(texel)};
}

namespace {

// The number of samples for all texels of a level together, and the least number for one texel. A level takes
// an eighth of a second, and a smooth sky has less than 1 % of noise.
constexpr std::uint32_t kLevelSamples = 1U << 23;
constexpr std::uint32_t kMinSamples = 32;
constexpr std::uint32_t kMaxSamples = 1024;
// The number of map samples, which all texels share. A lamp that has a tenth of the light gets 100.
constexpr std::uint32_t kMapSamples = 1024;
constexpr std::uint32_t kMaxThreads = 64;

struct Vec3 {
    float x, y, z;
};

// The lobe about a direction that is also the direction of the surface and of the viewer. It depends on the
// cosine x = n·l alone, since (n·h)² = (1 + x) / 2. The density of l is that of h divided by 4 v·h, which
// gives D (n·h) / (4 v·h) = D / 4.
class Lobe {
public:
    explicit Lobe(double roughness)
        : alpha2_(static_cast<float>(std::pow(roughness, 4.0))),
          scale_(static_cast<float>(alpha2_ / (4.0 * std::numbers::pi))) {}

    // Returns the weight of a sample under the balance heuristic. It is the weight D x / 4 of the sample's
    // direction over the samples per steradian there, which are `lobeSamples` from the lobe and `mapDensity`
    // from the map. The lobe samples only directions above the surface, which are 1 / (1 + α²) of it. Both
    // are multiplied by q², where D / 4 = s / q². GGX's denominator q = 1 - (1 - α²)(n·h)² is a sum of
    // positive terms.
    float balance(float x, float lobeSamples, float mapDensity) const {
        const float q = alpha2_ + (1.0F - alpha2_) * 0.5F * (1.0F - x);
        return scale_ * x / (lobeSamples * scale_ * (1.0F + alpha2_) + mapDensity * q * q);
    }
    // Returns the cosine of a sample; it is in [0, 1] for u in [0, 1].
    double sampleCosine(double u) const {
        const double a2 = alpha2_;
        const double v = u / (1.0 + a2);
        return 2.0 * (1.0 - v) / (1.0 - (1.0 - a2) * v) - 1.0;
    }

private:
    float alpha2_;
    float scale_;
};

// Returns the reversed bits as a fraction, which is van der Corput's sequence.
double radicalInverse(std::uint32_t i) {
    std::uint32_t bits = 0;
    for (int bit = 0; bit < 32; ++bit) {
        bits = bits << 1U | (i >> bit & 1U);
    }
    return bits * 0x1p-32;
}

// Returns samples in the frame of the lobe, whose axis is z.
std::vector<Vec3> sampleLobe(const Lobe& lobe, std::uint32_t count) {
    std::vector<Vec3> samples;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double x = lobe.sampleCosine((i + 0.5) / count);
        const double azimuth = 2.0 * std::numbers::pi * radicalInverse(i);
        const double sine = std::sqrt(std::max(1.0 - x * x, 0.0));
        samples.push_back({static_cast<float>(sine * std::cos(azimuth)),
                           static_cast<float>(sine * std::sin(azimuth)), static_cast<float>(x)});
    }
    return samples;
}

// Samples of the map are stored side by side for vector instructions.
constexpr std::size_t kLanes = 16;
using Lanes = std::array<float, kLanes>;
struct Lights {
    std::array<Lanes, 3> direction{};
    std::array<Lanes, 3> radiance{};
    Lanes samples{};  // samples that each stands for; 0: none
    Lanes density{};  // expected samples per steradian
};

// The map as the samplers see it: its radiance and the expected map samples per steradian.
class Source {
public:
    explicit Source(const RadianceMap& map) : width_(map.width), height_(map.height) {
        const MapDistribution distribution(map);
        texels_.reserve(map.texels.size());
        for (std::size_t i = 0; i < map.texels.size(); ++i) {
            const Radiance& c = map.texels[i];
            texels_.push_back({c[0], c[1], c[2], static_cast<float>(kMapSamples * distribution.pdf(i))});
            if (expectedSamples(i) >= 1.0) {
                addLight(directionOf(i), i, expectedSamples(i));
            }
        }
        for (std::uint32_t i = 0; i < kMapSamples; ++i) {
            const MapSample sample = distribution.sample((i + 0.5) / kMapSamples, radicalInverse(i));
            if (expectedSamples(sample.texel) < 1.0) {
                addLight(sample.direction, sample.texel, 1.0);
            }
        }
    }

    const std::vector<Lights>& lights() const {
        return lights_;
    }
    const std::array<float, 4>& at(Vec3 d) const {
        constexpr float kPi = std::numbers::pi_v<float>;
        const float u = std::atan2(d.z, d.x) * (0.5F / kPi) + 0.5F;
        const float v = std::acos(std::clamp(d.y, -1.0F, 1.0F)) / kPi;
        const auto x = static_cast<std::uint32_t>(u * static_cast<float>(width_));
        const auto y = static_cast<std::uint32_t>(v * static_cast<float>(height_));
        return texels_[std::size_t{std::min(y, height_ - 1)} * width_ + std::min(x, width_ - 1)];
    }

private:
    // A texel that expects one sample or more counts as that many samples at its centre. The light of a sun
    // is therefore not random.
    double expectedSamples(std::size_t texel) const {
        return texels_[texel][3] *
               texelSolidAngle(static_cast<std::uint32_t>(texel / width_), width_, height_);
    }
    Direction directionOf(std::size_t texel) const {
        const std::size_t row = texel / width_;
        const std::size_t column = texel % width_;
        const double polar = std::numbers::pi * (static_cast<double>(row) + 0.5) / height_;
        const double azimuth = 2.0 * std::numbers::pi * ((static_cast<double>(column) + 0.5) / width_ - 0.5);
        return {std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)};
    }
    void addLight(const Direction& direction, std::size_t texel, double samples) {
        const std::size_t lane = lightCount_++ % kLanes;
        if (lane == 0) {
            lights_.emplace_back();
        }
        Lights& lights = lights_.back();
        for (std::size_t i = 0; i < 3; ++i) {
            lights.direction[i][lane] = static_cast<float>(direction[i]);
            lights.radiance[i][lane] = texels_[texel][i];
        }
        lights.samples[lane] = static_cast<float>(samples);
        lights.density[lane] = texels_[texel][3];
    }

    std::uint32_t width_;
    std::uint32_t height_;
    std::vector<std::array<float, 4>> texels_;
    std::vector<Lights> lights_;
    std::size_t lightCount_ = 0;
};

// A weighted mean of radiance. It is no greater than its greatest value.
class Mean {
public:
    void add(float r, float g, float b, float weight) {
        addSum(weight * r, weight * g, weight * b, weight);
    }
    void addSum(float r, float g, float b, float weight) {
        sum_[0] += r;
        sum_[1] += g;
        sum_[2] += b;
        total_ += weight;
    }
    Radiance value() const {
        return {static_cast<float>(sum_[0] / total_), static_cast<float>(sum_[1] / total_),
                static_cast<float>(sum_[2] / total_)};
    }

private:
    std::array<double, 3> sum_{};
    double total_ = 0.0;
};

// `turn` rotates the lobe's samples about its axis, so that neighbours have different errors.
Radiance lobeMean(const Source& source, const Lobe& lobe, const std::vector<Vec3>& samples, double polar,
                  double azimuth, double turn) {
    const double sinP = std::sin(polar);
    const double cosP = std::cos(polar);
    const double sinA = std::sin(azimuth);
    const double cosA = std::cos(azimuth);
    const auto vec = [](double x, double y, double z) {
        return Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    };
    const Vec3 n = vec(sinP * cosA, cosP, sinP * sinA);
    // One axis goes down the meridian and the other along the parallel, and both are turned.
    const double c = std::cos(turn);
    const double s = std::sin(turn);
    const Vec3 t = vec(c * cosP * cosA - s * sinA, -c * sinP, c * cosP * sinA + s * cosA);
    const Vec3 b = vec(-s * cosP * cosA - c * sinA, s * sinP, -s * cosP * sinA + c * cosA);
    const auto lobeSamples = static_cast<float>(samples.size());
    Mean mean;
    for (const Vec3& l : samples) {
        const auto& [red, green, blue, density] =
            source.at({l.x * t.x + l.y * b.x + l.z * n.x, l.x * t.y + l.y * b.y + l.z * n.y,
                       l.x * t.z + l.y * b.z + l.z * n.z});
        mean.add(red, green, blue, lobe.balance(l.z, lobeSamples, density));
    }
    std::array<Lanes, 4> sums{};
    for (const Lights& lights : source.lights()) {
        for (std::size_t i = 0; i < kLanes; ++i) {
            const float x =
                lights.direction[0][i] * n.x + lights.direction[1][i] * n.y + lights.direction[2][i] * n.z;
            // This is max(x, 0) without the branch that the compiler would make.
            const float above = 0.5F * (x + std::abs(x));
            const float weight = lights.samples[i] * lobe.balance(above, lobeSamples, lights.density[i]);
            sums[0][i] += weight * lights.radiance[0][i];
            sums[1][i] += weight * lights.radiance[1][i];
            sums[2][i] += weight * lights.radiance[2][i];
            sums[3][i] += weight;
        }
    }
    for (std::size_t i = 0; i < kLanes; ++i) {
        mean.addSum(sums[0][i], sums[1][i], sums[2][i], sums[3][i]);
    }
    return mean.value();
}

RadianceMap filterLevel(const Source& source, double roughness, std::uint32_t width, std::uint32_t height) {
    const Lobe lobe(roughness);
    const std::vector<Vec3> samples =
        sampleLobe(lobe, std::clamp(kLevelSamples / (width * height), kMinSamples, kMaxSamples));
    RadianceMap level{width, height, {}};
    level.texels.resize(std::size_t{width} * height);
    forEach(
        height,
        [&](std::size_t index) {
            const auto row = static_cast<std::uint32_t>(index);
            for (std::uint32_t x = 0; x < width; ++x) {
                // The additive recurrence of the plastic number fills the plane evenly (Roberts 2018).
                const double turn = 0.7548776662466927 * x + 0.5698402909980532 * row;
                level.texels[std::size_t{row} * width + x] = lobeMean(
                    source, lobe, samples, std::numbers::pi * (row + 0.5) / height,
                    2.0 * std::numbers::pi * ((x + 0.5) / width - 0.5), 2.0 * std::numbers::pi * turn);
            }
        },
        std::min(threadsOfMachine(), kMaxThreads));
    return level;
}

}  // namespace

RadianceMap fitToDevice(RadianceMap map) {
    const std::uint32_t width = std::clamp(map.width, kMinMapWidth, kMaxMapWidth);
    const std::uint32_t height = std::clamp(map.height, kMinMapHeight, kMaxMapHeight);
    return width == map.width && height == map.height ? std::move(map) : resample(map, width, height);
}

std::uint32_t levelCount(std::uint32_t width) {
    constexpr std::uint32_t kSmallestWidth = 32;
    return static_cast<std::uint32_t>(std::bit_width(width / kSmallestWidth));
}

std::vector<RadianceMap> filterByRoughness(RadianceMap map) {
    const Source source(map);
    const std::uint32_t count = levelCount(map.width);
    const std::uint32_t width = map.width;
    const std::uint32_t height = map.height;
    std::vector<RadianceMap> levels;
    levels.push_back(std::move(map));
    for (std::uint32_t level = 1; level < count; ++level) {
        levels.push_back(filterLevel(source, static_cast<double>(level) / (count - 1),
                                     std::max(width >> level, 1U), std::max(height >> level, 1U)));
    }
    return levels;
}

}  // namespace glint
