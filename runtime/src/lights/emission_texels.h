// The brightness of an emissive texture's texels on a part of it.
#pragma once

#include <glint/package_format.h>
#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <vector>

namespace glint {

// A box of texture coordinates.
struct TexelBox {
    std::array<double, 2> lower{};
    std::array<double, 2> upper{};
};

// Luminances of an image and of its halves, from 256 texels along the longer axis on. Takes at most 0.35 MB,
// and time in proportion to the image's texels.
class EmissionTexels {
public:
    // `isColor`: the values are in sRGB.
    EmissionTexels(const ImageView& image, bool isColor);

    // Returns an estimate of the mean luminance within the box, for a sampler with these wrap modes
    // (SamplerEntry). It is 0 only if every texel that the box and its filter reach is black.
    double mean(const TexelBox& box, std::uint32_t wrapU, std::uint32_t wrapV) const;
    // Returns an estimate of the mean luminance of the whole image.
    double mean() const {
        return levels_.back().values.front();
    }

private:
    struct Level {
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        std::vector<float> values;
    };
    static Level halfOf(const Level& level);

    std::uint32_t width_ = 0;  // of the image
    std::uint32_t height_ = 0;
    std::uint32_t skipped_ = 0;  // levels of the image before the first of `levels_`
    std::vector<Level> levels_;
};

}  // namespace glint
