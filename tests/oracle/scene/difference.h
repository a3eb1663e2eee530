// Measures how far a picture of the device is from one of the scene renderer, and finds why.
#pragma once

#include "oracle/scene/picture.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::oracle {

// A relative error is that of a channel over its truth, or over this value if the truth is darker.
inline constexpr double kDark = 0.01;
// A pixel counts as different beyond this relative error.
inline constexpr double kDiffers = 1e-3;

// Why a pixel differs. The first cause that applies counts.
enum class Cause : std::uint8_t {
    Decoding,    // the device decodes sRGB texels so
    Chance,      // it chose one of several lights or mirrors: it shows what one of the choices gives
    Filtering,   // it filters textures in less than single precision
    Edge,        // another surface within 1/128 of a pixel: the rasteriser rounds to half of that
    ShadowEdge,  // the same, where another light reaches it
    MirrorEdge,  // the same, where a mirror shows another surface
    Steep,       // the light changes as much within 1/128 of a pixel: highlights, textures
    Terminator,  // a light or the view near a tangent plane
    Other,
    Count
};
inline constexpr std::size_t kCauses = static_cast<std::size_t>(Cause::Count);
std::string_view nameOf(Cause cause);

struct DifferentPixel {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    double relative = 0.0;  // of the worst channel
    std::array<double, 3> device{};
    Vec3 truth{0.0};
    std::optional<Cause> cause;  // of pictures of the pixels' centres
    std::string material;        // of what the camera sees
};

struct Difference {
    std::size_t pixels = 0;
    std::size_t notFinite = 0;  // of the device; left out of all else
    double mean = 0.0;          // of the truth
    double rootMeanSquare = 0.0;
    double relMse = 0.0;    // mean of (device - truth)² / (truth² + 0.01)
    double expected = 0.0;  // root mean square error of independent samples, and of the truth itself
    // Statistics of the pixels' relative errors, each of its worst channel.
    double median = 0.0;
    double p999 = 0.0;
    double largest = 0.0;
    // The mean of (device - truth) / max(truth, kDark) over channels and pixels, and its standard error.
    double signedMean = 0.0;
    double signedError = 0.0;
    // The number of pixels whose worst channel is off by more than six standard deviations of independent
    // samples, plus kDiffers.
    std::size_t outliers = 0;
    std::vector<DifferentPixel> different;  // worst first

    std::size_t count(Cause cause) const;
    double largestOf(Cause cause) const;
};

// Further knowledge about the device besides its picture. Either pointer may be null.
struct Evidence {
    // The truth with the device's own table of texels.
    const SceneRenderer* decoding = nullptr;
    // The same picture, filtered in single precision.
    const LinearImage* filtered = nullptr;
};

// Compares pictures of the pixels' centres. They must have the same size.
Difference centreDifference(const LinearImage& device, const Picture& truth, const SceneRenderer& renderer,
                            const View& view, const Evidence& evidence = {});
// Compares means over the pixels. The device's picture has that many samples. Gives no causes.
Difference meanDifference(const LinearImage& device, const Picture& truth, std::uint32_t samples);

}  // namespace glint::oracle
