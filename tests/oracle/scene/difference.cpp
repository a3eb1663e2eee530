#include "oracle/scene/difference.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace glint::oracle {
namespace {

constexpr double kNear = 1.0 / 128.0;  // of a pixel

double relativeError(double device, double truth) {
    return std::abs(device - truth) / std::max(truth, kDark);
}

// Returns the relative error of the worst channel.
double relativeError(const Vec3& device, const Vec3& truth) {
    return std::max({relativeError(device.x, truth.x), relativeError(device.y, truth.y),
                     relativeError(device.z, truth.z)});
}

// Returns what changes beside a place, if the light there changes by about as much as the pixel is off.
std::optional<Cause> changeBeside(const SceneRenderer& renderer, const View& view,
                                  const DifferentPixel& pixel, const Path& path) {
    std::optional<Cause> cause;
    for (int direction = 0; direction < 16; ++direction) {
        const double reach = direction < 8 ? kNear : 0.3 * kNear;
        const double angle = kPi * direction / 4.0;
        Path beside;
        const Vec3 light = renderer
                               .radiance(view.ray(pixel.x + 0.5 + reach * std::cos(angle),
                                                  pixel.y + 0.5 + reach * std::sin(angle)),
                                         &beside)
                               .mean;
        if (relativeError(light, pixel.truth) < 0.5 * pixel.relative) {
            continue;
        }
        if (beside.triangles.front() != path.triangles.front()) {
            return Cause::Edge;
        }
        if (beside.triangles != path.triangles) {
            cause = Cause::MirrorEdge;
        } else if (beside.visible != path.visible) {
            cause = cause.value_or(Cause::ShadowEdge);
        } else {
            cause = cause.value_or(Cause::Steep);
        }
    }
    return cause;
}

// Returns whether a picture agrees with one of the truths, within a relative error.
bool agrees(const Vec3& device, const std::vector<Vec3>& truths, double within) {
    return std::ranges::any_of(truths,
                               [&](const Vec3& truth) { return relativeError(device, truth) <= within; });
}

// Returns decoding, chance or filtering if one of the truths that they cause equals the device's value up to
// a tenth of the error. Their effect may be magnified, together with its own error.
std::optional<Cause> causeInDevice(const CameraLight& exact, const View& view, const Evidence& evidence,
                                   const DifferentPixel& pixel) {
    const double within = std::max(kDiffers, 0.1 * pixel.relative);
    const bool chooses = exact.outcomes.size() > 1;
    std::vector<Vec3> truths{exact.mean};
    std::vector<Vec3> outcomes = exact.outcomes;
    if (evidence.decoding != nullptr) {
        Path path;
        const CameraLight decoded =
            evidence.decoding->radiance(view.ray(pixel.x + 0.5, pixel.y + 0.5), &path);
        truths.push_back(decoded.mean);
        outcomes.insert(outcomes.end(), decoded.outcomes.begin(), decoded.outcomes.end());
    }
    const Vec3 device(pixel.device[0], pixel.device[1], pixel.device[2]);
    if (agrees(device, truths, within)) {
        return Cause::Decoding;
    }
    if (chooses && agrees(device, outcomes, within)) {
        return Cause::Chance;
    }
    if (evidence.filtered != nullptr) {
        const auto& found =
            evidence.filtered->pixels[static_cast<std::size_t>(pixel.y) * view.width() + pixel.x];
        const Vec3 filtered(found[0], found[1], found[2]);
        if (agrees(filtered, truths, within)) {
            return Cause::Filtering;
        }
        if (chooses && agrees(filtered, outcomes, within)) {
            return Cause::Chance;
        }
    }
    return std::nullopt;
}

void explain(const SceneRenderer& renderer, const View& view, const Evidence& evidence,
             DifferentPixel& pixel) {
    Path path;
    const CameraLight exact = renderer.radiance(view.ray(pixel.x + 0.5, pixel.y + 0.5), &path);
    pixel.cause = causeInDevice(exact, view, evidence, pixel);
    if (!pixel.cause) {
        pixel.cause = changeBeside(renderer, view, pixel, path);
    }
    if (!pixel.cause) {
        pixel.cause = path.grazing ? Cause::Terminator : Cause::Other;
    }
    pixel.material = path.triangles.front() == Path::kNothing
                         ? "sky"
                         : renderer.scene().materials[static_cast<std::size_t>(path.materials.front())].name;
}

// Returns the value below which that share of the sorted values lies.
double quantile(const std::vector<double>& sorted, double share) {
    if (sorted.empty()) {
        return 0.0;
    }
    const double place = share * static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<std::size_t>(std::llround(place))];
}

}  // namespace

std::string_view nameOf(Cause cause) {
    switch (cause) {
        case Cause::Decoding:
            return "decoding";
        case Cause::Chance:
            return "chance";
        case Cause::Filtering:
            return "filtering";
        case Cause::Edge:
            return "edge";
        case Cause::ShadowEdge:
            return "shadow edge";
        case Cause::MirrorEdge:
            return "edge in a mirror";
        case Cause::Steep:
            return "steep";
        case Cause::Terminator:
            return "terminator";
        case Cause::Other:
        case Cause::Count:
            break;
    }
    return "other";
}

std::size_t Difference::count(Cause cause) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(different, [&](const DifferentPixel& pixel) { return pixel.cause == cause; }));
}

double Difference::largestOf(Cause cause) const {
    double largestError = 0.0;
    for (const DifferentPixel& pixel : different) {
        largestError = pixel.cause == cause ? std::max(largestError, pixel.relative) : largestError;
    }
    return largestError;
}

Difference meanDifference(const LinearImage& device, const Picture& truth, std::uint32_t samples) {
    Difference result;
    std::vector<double> errors;
    double signedSquares = 0.0;
    for (std::uint32_t y = 0; y < truth.height; ++y) {
        for (std::uint32_t x = 0; x < truth.width; ++x) {
            const Pixel& pixel = truth.at(x, y);
            const auto& found = device.pixels[static_cast<std::size_t>(y) * truth.width + x];
            if (!std::isfinite(found[0]) || !std::isfinite(found[1]) || !std::isfinite(found[2])) {
                ++result.notFinite;
                continue;
            }
            DifferentPixel different{x, y, 0.0, {found[0], found[1], found[2]}, pixel.mean, {}, {}};
            double signedSum = 0.0;
            bool outlier = false;
            for (int channel = 0; channel < 3; ++channel) {
                const double value = pixel.mean[channel];
                const double error = found[static_cast<std::size_t>(channel)] - value;
                const double variance =
                    pixel.variance[channel] / samples + pixel.error[channel] * pixel.error[channel];
                const double relative = std::abs(error) / std::max(value, kDark);
                outlier = outlier ||
                          std::abs(error) > 6.0 * std::sqrt(variance) + kDiffers * std::max(value, kDark);
                different.relative = std::max(different.relative, relative);
                signedSum += error / std::max(value, kDark) / 3.0;
                result.mean += value / 3.0;
                result.rootMeanSquare += error * error / 3.0;
                result.relMse += error * error / (value * value + 0.01) / 3.0;
                result.expected += variance / 3.0;
            }
            ++result.pixels;
            result.outliers += outlier ? 1 : 0;
            result.signedMean += signedSum;
            signedSquares += signedSum * signedSum;
            errors.push_back(different.relative);
            if (different.relative > kDiffers) {
                result.different.push_back(std::move(different));
            }
        }
    }
    const double count = std::max(static_cast<double>(result.pixels), 1.0);
    result.mean /= count;
    result.rootMeanSquare = std::sqrt(result.rootMeanSquare / count);
    result.relMse /= count;
    result.expected = std::sqrt(result.expected / count);
    result.signedMean /= count;
    result.signedError =
        std::sqrt(std::max(signedSquares / count - result.signedMean * result.signedMean, 0.0) / count);
    std::ranges::sort(errors);
    result.median = quantile(errors, 0.5);
    result.p999 = quantile(errors, 0.999);
    result.largest = quantile(errors, 1.0);
    std::ranges::sort(result.different, std::ranges::greater{}, &DifferentPixel::relative);
    return result;
}

Difference centreDifference(const LinearImage& device, const Picture& truth, const SceneRenderer& renderer,
                            const View& view, const Evidence& evidence) {
    Difference result = meanDifference(device, truth, 1);
    forRows(static_cast<std::uint32_t>(result.different.size()),
            [&](std::uint32_t i) { explain(renderer, view, evidence, result.different[i]); });
    return result;
}

}  // namespace glint::oracle
