// Makes the mip levels of images.
#pragma once

#include "gltf/scene.h"

#include <cstdint>
#include <vector>

namespace glint::gltf {

// How the numbers of an image are averaged.
enum class LevelFilter : std::uint8_t {
    Color,    // red, green and blue in linear light, though stored in sRGB; alpha as it is
    Data,     // each channel as it is
    Normals,  // red, green and blue are vectors; their mean is made a unit vector again
};

// An RGBA image with levels, the largest first.
struct Texels {
    int width = 0;
    int height = 0;
    PixelFormat format = PixelFormat::Rgba8;
    int levels = 1;
    std::vector<std::uint8_t> bytes;
};

// Returns the levels of a full pyramid: 1 + floor(log2(largest side)).
int fullLevels(int width, int height);

// Appends the levels that a full pyramid has more. A texel is the mean over the area that it covers of the
// last level that is there, where a size is odd with shares of texels. Levels are not averaged from ones that
// were rounded.
void completeLevels(Texels& texels, LevelFilter filter);

}  // namespace glint::gltf
