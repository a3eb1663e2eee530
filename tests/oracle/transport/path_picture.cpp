#include "oracle/transport/path_picture.h"

#include "oracle/scene/difference.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace glint::oracle {
namespace {

// A truth's pixel is uneven if one sample has this share of it.
constexpr double kUneven = 0.1;
constexpr double kDeviations = 4.0;

constexpr std::size_t kPathCauses = static_cast<std::size_t>(PathCause::Count);

// Returns the seed of one sample; neighbours share no bits (the finaliser of SplitMix64 follows in Random).
std::uint64_t seedOf(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample) {
    Random mixed((seed * 0x9E3779B97F4A7C15ULL) ^ (pixel << 24U) ^ sample);
    return static_cast<std::uint64_t>(mixed.next() * 0x1p53) * 0xD1342543DE82EF95ULL + sample;
}

// Collects samples: Welford's mean and sum of squares.
class Samples {
public:
    void add(const Vec3& value) {
        count_ += 1.0;
        const Vec3 before = value - mean_;
        mean_ += before / count_;
        squares_ += before * (value - mean_);
        largest_ = std::max(largest_, luminanceOf(value));
    }
    Vec3 mean() const {
        return mean_;
    }
    Vec3 variance() const {
        return count_ > 1.0 ? squares_ / (count_ - 1.0) : Vec3(0.0);
    }
    Vec3 error() const {
        return glm::sqrt(variance() / std::max(count_, 1.0));
    }
    double largestShare() const {
        const double sum = luminanceOf(mean_) * count_;
        return sum > 0.0 ? largest_ / sum : 0.0;
    }

private:
    double count_ = 0.0;
    Vec3 mean_{0.0};
    Vec3 squares_{0.0};
    double largest_ = 0.0;
};

// The distance of a pixel of the device to one of the truth, in standard errors of both, of the worst
// channel.
double deviationsOf(const Vec3& device, const Pixel& truth, std::uint32_t samples) {
    double worst = 0.0;
    for (int channel = 0; channel < 3; ++channel) {
        const double variance = squared(truth.error[channel]) + truth.variance[channel] / samples;
        // A float has 24 bits; an equal pixel has no deviation.
        const double least = squared(1e-7 * truth.mean[channel]) + 1e-30;
        worst =
            std::max(worst, std::abs(device[channel] - truth.mean[channel]) / std::sqrt(variance + least));
    }
    return worst;
}

// `reflecting` may be null.
PathCause causeOf(const PathDifferentPixel& pixel, const PathPixel& notes, const Pixel* reflecting,
                  std::uint32_t samples) {
    if (pixel.deviations <= kDeviations) {
        return PathCause::Noise;
    }
    if (reflecting != nullptr && deviationsOf(pixel.device, *reflecting, samples) <= kDeviations) {
        return PathCause::Below;
    }
    if (notes.largestSample > kUneven) {
        return PathCause::Uneven;
    }
    if (notes.glass > 0.0) {
        return PathCause::Glass;
    }
    if (notes.blended > 0.0) {
        return PathCause::Blended;
    }
    return notes.material < 0 ? PathCause::Sky : PathCause::Other;
}

std::size_t countOf(const PathDifference& difference, PathCause cause) {
    return static_cast<std::size_t>(std::ranges::count_if(
        difference.different, [&](const PathDifferentPixel& pixel) { return pixel.cause == cause; }));
}

double largestOf(const PathDifference& difference, PathCause cause) {
    double largest = 0.0;
    for (const PathDifferentPixel& pixel : difference.different) {
        largest = pixel.cause == cause ? std::max(largest, pixel.relative) : largest;
    }
    return largest;
}

}  // namespace

std::string_view nameOf(PathCause cause) {
    switch (cause) {
        case PathCause::Noise:
            return "noise";
        case PathCause::Uneven:
            return "uneven samples";
        case PathCause::Glass:
            return "glass";
        case PathCause::Blended:
            return "blended";
        case PathCause::Below:
            return "below a surface";
        case PathCause::Sky:
            return "sky";
        case PathCause::Other:
        case PathCause::Count:
            break;
    }
    return "other";
}

PathPicture pathPicture(const PathTracer& tracer, const View& view, const PathSampling& sampling) {
    PathPicture result{{view.width(), view.height(), {}}, {}};
    const std::size_t pixels = static_cast<std::size_t>(view.width()) * view.height();
    result.picture.pixels.resize(pixels);
    result.notes.resize(pixels);
    const auto row = [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < view.width(); ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * view.width() + x;
            Samples samples;
            PathPixel& notes = result.notes[pixel];
            for (std::uint32_t i = 0; i < sampling.samples; ++i) {
                Random random(seedOf(sampling.seed, pixel, i));
                const double across = random.next();
                const double down = random.next();
                PathNotes met;
                samples.add(tracer.radiance(view.ray(x + across, y + down), random, &met));
                notes.glass += met.glass ? 1.0 / sampling.samples : 0.0;
                notes.blended += met.blended ? 1.0 / sampling.samples : 0.0;
                notes.material = i == 0 ? met.material : notes.material;
            }
            notes.largestSample = samples.largestShare();
            result.picture.pixels[pixel] = {samples.mean(), samples.error(), samples.variance()};
        }
    };
    forRows(view.height(), row, sampling.threads);
    return result;
}

Estimate pathLight(const PathTracer& tracer, const Ray& ray, std::uint32_t samples, std::uint64_t seed) {
    Samples all;
    for (std::uint32_t i = 0; i < samples; ++i) {
        Random random(seedOf(seed, 0, i));
        all.add(tracer.radiance(ray, random));
    }
    return {all.mean(), all.error(), all.variance() + all.mean() * all.mean()};
}

PathDifference pathDifference(const LinearImage& device, const PathPicture& truth,
                              const PathPicture* reflecting, const gltf::Scene& scene,
                              std::uint32_t samples) {
    PathDifference result;
    double variances = 0.0;
    double difference = 0.0;
    double reflectingDifference = 0.0;
    for (std::size_t i = 0; i < truth.picture.pixels.size(); ++i) {
        const Pixel& pixel = truth.picture.pixels[i];
        const auto& found = device.pixels[i];
        if (!std::isfinite(found[0]) || !std::isfinite(found[1]) || !std::isfinite(found[2])) {
            ++result.notFinite;
            continue;
        }
        ++result.pixels;
        PathDifferentPixel different;
        different.x = static_cast<std::uint32_t>(i % truth.picture.width);
        different.y = static_cast<std::uint32_t>(i / truth.picture.width);
        different.device = Vec3(found[0], found[1], found[2]);
        different.truth = pixel.mean;
        different.deviations = deviationsOf(different.device, pixel, samples);
        const Pixel* const reflected = reflecting != nullptr ? &reflecting->picture.pixels[i] : nullptr;
        different.reflecting = reflected != nullptr ? reflected->mean : Vec3(0.0);
        for (int channel = 0; channel < 3; ++channel) {
            const double value = pixel.mean[channel];
            const double error = different.device[channel] - value;
            const double variance =
                pixel.error[channel] * pixel.error[channel] + pixel.variance[channel] / samples;
            different.relative = std::max(different.relative, std::abs(error) / std::max(value, kDark));
            result.mean += value / 3.0;
            result.deviceMean += different.device[channel] / 3.0;
            result.rootMeanSquare += error * error / 3.0;
            result.relMse += error * error / (value * value + 0.01) / 3.0;
            variances += variance / 3.0;
            difference += error / 3.0;
            reflectingDifference +=
                reflected != nullptr ? (different.device[channel] - reflected->mean[channel]) / 3.0 : 0.0;
        }
        if (different.relative > kDiffers) {
            different.cause = causeOf(different, truth.notes[i], reflected, samples);
            const int material = truth.notes[i].material;
            different.material =
                material < 0 ? "sky" : scene.materials[static_cast<std::size_t>(material)].name;
            result.different.push_back(std::move(different));
        }
    }
    const double count = std::max(static_cast<double>(result.pixels), 1.0);
    result.bias = result.mean > 0.0 ? difference / result.mean : 0.0;
    result.reflectingBias = result.mean > 0.0 ? reflectingDifference / result.mean : 0.0;
    // The channels of a pixel are not independent, so their mean is taken to have the mean of their
    // variances.
    result.biasError = result.mean > 0.0 ? std::sqrt(variances) / result.mean : 0.0;
    result.mean /= count;
    result.deviceMean /= count;
    result.rootMeanSquare = std::sqrt(result.rootMeanSquare / count);
    result.relMse /= count;
    result.expected = std::sqrt(variances / count);
    std::ranges::sort(result.different, std::ranges::greater{}, &PathDifferentPixel::relative);
    return result;
}

std::string toText(const PathDifference& difference, std::uint32_t list) {
    std::string text = fmt::format(
        "pixels          {} ({} not finite)\n"
        "mean            {:.4g}, device {:.4g}: {:+.2e} ± {:.0e} of it\n"
        "RMSE            {:.2e} (samples alone {:.2e})\n"
        "relMSE          {:.2e}\n"
        "off by > {:.0e}  {} pixels\n",
        difference.pixels, difference.notFinite, difference.mean, difference.deviceMean, difference.bias,
        difference.biasError, difference.rootMeanSquare, difference.expected, difference.relMse, kDiffers,
        difference.different.size());
    for (std::size_t i = 0; i < kPathCauses; ++i) {
        const auto cause = static_cast<PathCause>(i);
        if (countOf(difference, cause) > 0) {
            text += fmt::format("  {:<18}{} pixels, largest {:.1e}\n", nameOf(cause),
                                countOf(difference, cause), largestOf(difference, cause));
        }
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(list, difference.different.size()); ++i) {
        const PathDifferentPixel& pixel = difference.different[i];
        text += fmt::format(
            "  ({}, {}) {:.2e}, {:.1f} standard errors, {}, {}: device {:.6f} {:.6f} {:.6f}, truth {:.6f} "
            "{:.6f} {:.6f}, reflecting {:.6f} {:.6f} {:.6f}\n",
            pixel.x, pixel.y, pixel.relative, pixel.deviations, nameOf(pixel.cause), pixel.material,
            pixel.device.x, pixel.device.y, pixel.device.z, pixel.truth.x, pixel.truth.y, pixel.truth.z,
            pixel.reflecting.x, pixel.reflecting.y, pixel.reflecting.z);
    }
    return text;
}

std::string toJson(const PathPicture& truth, const PathSampling& sampling, const PathDifference* difference,
                   std::uint32_t deviceSamples) {
    double mean = 0.0;
    double squares = 0.0;
    double largest = 0.0;
    for (const Pixel& pixel : truth.picture.pixels) {
        for (int channel = 0; channel < 3; ++channel) {
            mean += pixel.mean[channel];
            squares += squared(pixel.error[channel]);
            largest = std::max(largest, pixel.error[channel] / std::max(pixel.mean[channel], kDark));
        }
    }
    const double values = 3.0 * static_cast<double>(truth.picture.pixels.size());
    nlohmann::ordered_json json{
        {"width", truth.picture.width},   {"height", truth.picture.height},
        {"samples", sampling.samples},    {"seed", sampling.seed},
        {"mean", mean / values},          {"standardError", std::sqrt(squares / values)},
        {"largestRelativeError", largest}};
    if (difference != nullptr) {
        nlohmann::ordered_json causes = nlohmann::ordered_json::object();
        for (std::size_t i = 0; i < kPathCauses; ++i) {
            const auto cause = static_cast<PathCause>(i);
            if (countOf(*difference, cause) > 0) {
                causes[std::string(nameOf(cause))] = {{"pixels", countOf(*difference, cause)},
                                                      {"largest", largestOf(*difference, cause)}};
            }
        }
        json["difference"] = {{"samples", deviceSamples},
                              {"pixels", difference->pixels},
                              {"notFinite", difference->notFinite},
                              {"deviceMean", difference->deviceMean},
                              {"bias", difference->bias},
                              {"reflectingBias", difference->reflectingBias},
                              {"biasError", difference->biasError},
                              {"rmse", difference->rootMeanSquare},
                              {"expectedRmse", difference->expected},
                              {"relMse", difference->relMse},
                              {"differing", difference->different.size()},
                              {"causes", std::move(causes)}};
    }
    return json.dump(2) + "\n";
}

}  // namespace glint::oracle
