#include "image/tone.h"

#include "base/vectors.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace glint::image {

namespace {

constexpr double kMiddleGrey = 0.18;
// Sunlight of 100,000 lux needs 17 stops. --exposure has the same limit.
// A pixel with a smaller share of the median luminance counts as black. A pixel 20 stops below the others
// would change the log-average by less than a display can show.
constexpr double kBlackShare = 1e-6;

// These are F90, Ks and Kd of the specification.
constexpr float kFresnel = 0.04F;
constexpr float kCompressionStart = 0.8F - kFresnel;
constexpr float kDesaturation = 0.15F;

}  // namespace

double luminance(const Rgb& color) {
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
}

float linearToSrgb(float value) {
    return value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1.0F / 2.4F) - 0.055F;
}

float srgbToLinear(float value) {
    return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}

Rgb toneMapNeutral(const Rgb& color) {
    // The specification requires non-negative input.
    Rgb mapped{std::max(color[0], 0.0F), std::max(color[1], 0.0F), std::max(color[2], 0.0F)};

    // Subtracts the reflection of a dielectric at normal incidence, and less of it in the dark.
    const float smallest = std::min({mapped[0], mapped[1], mapped[2]});
    const float offset =
        smallest <= 2.0F * kFresnel ? smallest - smallest * smallest / (4.0F * kFresnel) : kFresnel;
    for (float& channel : mapped) {
        channel -= offset;
    }
    const float peak = std::max({mapped[0], mapped[1], mapped[2]});
    if (peak <= kCompressionStart) {
        return mapped;
    }

    // Compresses values above the start, and moves them towards white.
    constexpr float kRange = 1.0F - kCompressionStart;
    const float compressed = 1.0F - kRange * kRange / (peak + kRange - kCompressionStart);
    const float saturation = 1.0F / (kDesaturation * (peak - compressed) + 1.0F);
    for (float& channel : mapped) {
        channel = channel / peak * compressed * saturation + compressed * (1.0F - saturation);
    }
    return mapped;
}

double automaticExposure(const LinearImage& image, std::span<const std::uint8_t> surfaces) {
    const bool hasSurface = std::ranges::any_of(surfaces, [](std::uint8_t surface) { return surface != 0; });
    std::vector<double> lit;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const std::array<float, 4>& pixel = image.pixels[i];
        const double value = luminance({pixel[0], pixel[1], pixel[2]});
        if ((!hasSurface || surfaces[i] != 0) && std::isfinite(value) && value > 0.0) {
            lit.push_back(value);
        }
    }
    if (lit.empty()) {
        return 0.0;
    }
    const auto middle = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2);
    std::ranges::nth_element(lit, middle);
    const double black = kBlackShare * *middle;
    double sum = 0.0;
    std::size_t count = 0;
    for (const double value : lit) {
        if (value >= black) {
            sum += std::log2(value);
            ++count;
        }
    }
    return std::clamp(std::log2(kMiddleGrey) - sum / static_cast<double>(count), -kMaxExposure, kMaxExposure);
}

Rgb displayed(const Rgb& color, double exposure) {
    if (!base::isFinite(color)) {
        return {1.0F, 0.0F, 1.0F};
    }
    // This bound keeps a large exposure from turning a finite colour into infinity.
    constexpr double kBrightest = 1e30;
    const double scale = std::exp2(exposure);
    Rgb exposed{};
    for (std::size_t i = 0; i < 3; ++i) {
        exposed[i] = static_cast<float>(std::clamp(color[i] * scale, 0.0, kBrightest));
    }
    Rgb mapped = toneMapNeutral(exposed);
    for (float& channel : mapped) {
        channel = std::clamp(channel, 0.0F, 1.0F);
    }
    return mapped;
}

LinearImage displayedImage(const LinearImage& image, double exposure) {
    LinearImage shown = image;
    for (std::array<float, 4>& pixel : shown.pixels) {
        const Rgb color = displayed({pixel[0], pixel[1], pixel[2]}, exposure);
        pixel = {color[0], color[1], color[2], pixel[3]};
    }
    return shown;
}

std::array<std::uint8_t, 3> toDisplay(const Rgb& color, double exposure) {
    const Rgb shown = displayed(color, exposure);
    std::array<std::uint8_t, 3> display{};
    for (std::size_t i = 0; i < 3; ++i) {
        display[i] = static_cast<std::uint8_t>(std::lround(linearToSrgb(shown[i]) * 255.0F));
    }
    return display;
}

}  // namespace glint::image
