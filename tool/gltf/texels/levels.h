// Makes the mip levels of images by the channels that materials read of them.
#pragma once

#include "gltf/scene.h"
#include "materials/interval.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glint::gltf {

// How the numbers of a channel are averaged.
//
// Roughness r stands for a lobe with alpha = r². The variance of its facets' slopes adds over an area
// (Toksvig 2005, "Mipmapping normal maps"; Olano and Baker 2010, "LEAN mapping"), but GGX has none that is
// finite. The mean of its slopes is pi / 2 alpha, and adds as well, so the mean is that of r². Such means lie
// between the least and the greatest of their numbers, as plain ones do. docs/textures.md compares powers.
enum class LevelFilter : std::uint8_t {
    Data,        // as they are
    Color,       // in linear light, though stored in sRGB
    Normals,     // red, green and blue are vectors; their mean is made a unit vector again
    Roughness,   // by their squares
    Glossiness,  // 1 - roughness, averaged as roughness
};

using LevelFilters = std::array<LevelFilter, 4>;  // by channel

// Returns the filters of an image in which one of Data, Color and Normals is right for red, green and blue.
constexpr LevelFilters filtersOf(LevelFilter filter) {
    return {filter, filter, filter, LevelFilter::Data};
}

// An RGBA image with levels, the largest first.
struct Texels : ImageShape {
    PixelFormat format = PixelFormat::Rgba8;
    std::vector<std::uint8_t> bytes;
};

constexpr bool isPowerOfTwo(int size) {
    return std::has_single_bit(static_cast<std::uint32_t>(size));
}

// Returns how many texels come before one, row by row.
constexpr std::size_t placeOfTexel(int x, int y, int width) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

// Returns the linear number of one in sRGB (IEC 61966-2-1).
double decodeSrgb(double encoded);

// Returns the levels of a full pyramid: 1 + floor(log2(largest side)).
int fullLevels(int width, int height);

// Appends the levels that a full pyramid has more. A texel is the mean over the area that it covers of the
// last level that is there, where a size is odd with shares of texels. Levels are not averaged from ones that
// were rounded. Layers and faces are averaged each by itself; 3D images stay as they are.
void completeLevels(Texels& texels, const LevelFilters& filters);

// ---- What materials read of images ----

struct ImageUse {
    bool isColor = false;        // some texture reads it as colour, in sRGB
    bool isData = false;         // some texture reads it as linear data
    bool isNormals = false;      // all of them read vectors
    bool isEmission = false;     // some material emits what it shows
    std::uint32_t channels = 0;  // that are read: bit 0 for red, to bit 3 for alpha
    // Those of them that all textures read as the roughness of a lobe, and as 1 - roughness.
    std::uint32_t roughness = 0;
    std::uint32_t glossiness = 0;

    bool operator==(const ImageUse&) const = default;
};

// Returns how the levels of such an image are made.
LevelFilters levelFiltersOf(const ImageUse& use);

// Returns whether a device's blits would make those levels, for sides that are powers of two.
bool blitsSuit(const ImageUse& use);

// Returns the use of each of Scene::images. Materials that no primitive has count.
std::vector<ImageUse> imageUses(const Scene& scene);

// Returns what a shader reads of such an image. `isColor` says that red, green and blue are in sRGB. The
// bounds are wider by what drivers round, but 0 and 1 stay exact: a channel that is 0 everywhere is read as
// 0.
std::array<materials::ValueInterval, 4> contentAsRead(const std::array<materials::ValueInterval, 4>& stored,
                                                      bool isColor);

// Returns the number that a code stands for, where it is colour in sRGB or not.
double numberAsRead(double stored, bool isColor);

}  // namespace glint::gltf
