// Encloses what lookups of a texture can give: the least and the greatest number of each channel over all
// texels that coordinates in a box can reach, with every level that a device may choose.
//
// A lookup gives a convex combination of the texels that it reaches. The result is in the hull of their
// codes, whichever weights the device computes. What can differ between devices is which texels are reached:
//
//   coordinates   Devices hold a place between texels in fixed point, with at least 4 bits (Vulkan 1.3,
//                 subTexelPrecisionBits). So the box is wider by 1/16 of a texel on each level.
//   levels        Cones and pixels have any width, so every level can be chosen.
//   anisotropy    With up to 16 samples in a row, a sample is at most 16 texels of its level away from the
//                 coordinates, and any distance away on the coarsest level (Vulkan 1.3, "Texel Anisotropic
//                 Filtering": samples lie in a footprint of N * 2^lambda texels, and lambda < level + 1).
//   made levels   Levels that Glint makes are known. Those that a device may make by blits instead are known
//                 up to one code for each level (two for colours in sRGB), and never leave the hull of the
//                 texels below them. That holds for roughness, too: the root of a mean of powers lies between
//                 the least and the greatest of its numbers.
#pragma once

#include "gltf/scene.h"
#include "gltf/texels/levels.h"
#include "materials/interval.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace glint::gltf {

// Where a triangle, or any set of points, looks a texture up. Bounds that are not finite stand for
// everywhere.
struct TexCoordBox {
    std::array<double, 2> low{};
    std::array<double, 2> high{};
};

// Returns the box of all coordinates that a device may interpolate between the corners of a triangle, in the
// texture's space after `transform`. It is wider than the corners by what single precision rounds and by the
// 16 bits in which packed hits keep their barycentric coordinates. Requires at least one corner.
TexCoordBox boxOf(std::span<const Float2> corners, const materials::TextureTransform& transform);

// Codes as the image stores them: of 8 bits, or of 16.
struct TexelRange {
    std::array<std::uint16_t, 4> least{65535, 65535, 65535, 65535};
    std::array<std::uint16_t, 4> greatest{};

    bool encloses(const TexelRange& other) const;
    void join(const TexelRange& other);
    bool operator==(const TexelRange&) const = default;
};

using TexelPlace = materials::TexelPlace;

// Returns the numbers in [0, 1] that the codes stand for, as they are stored (contentAsRead() makes of them
// what shading reads). 16 bits include their rounding to 8, for devices that do not filter them. `tolerance`
// is that of LevelRules.
std::array<materials::ValueInterval, 4> valuesOf(const TexelRange& range, PixelFormat format, int tolerance);

// The filter of a lookup.
struct LookupKind {
    Sampler sampler{};
    bool finestLevel = false;  // reads level 0 alone, as alpha tests of rays do, without anisotropy
    bool anisotropic = true;   // the device may filter in this way, where the sampler is trilinear
};

// How the levels after those of the file are made.
struct LevelRules {
    LevelFilters filters{};  // LevelFilter::Data
    bool complete = true;    // levels follow after those of the file, down to one texel
    // Devices make the levels by blits where sides are powers of two, and round each of them.
    bool mayBlit = true;
    // Some devices have the levels of the file alone.
    bool mayStop = false;
    // Another filter may have made the levels: nothing but the hull of what they average is known of them.
    bool isUnknown = false;
    // Devices may read texels that differ from those given by so many codes, unless these are 0 or 1: they
    // round the colours between the ends of a block as they like.
    int tolerance = 0;
};

// Returns whether the image is 2D and all devices read its own texels. Data of Basis Universal are transcoded
// to a format that the device has, and levels that are missing in a block format are packed, both with
// errors.
bool hasKnownTexels(const Image& image);

// Returns the rules for such an image, as fitImage() and the runtime make its levels.
LevelRules levelRulesOf(const Image& image, const ImageUse& use);

// Immutable after construction, so threads can share it. Takes some 2.5 times the memory of the texels.
class TexelBounds {
public:
    // `texels` has the levels of the file, with bytes. The filter Normals must not be marked as unknown.
    TexelBounds(Texels texels, const LevelRules& rules);

    // The codes of all texels of all levels.
    TexelRange whole() const;
    // Joins the codes that lookups in the box can combine to `range`, and looks at no texels that could not
    // change it. Takes constant time for small boxes, and time in proportion to the box's sides in texels for
    // others.
    void joinOver(const TexCoordBox& box, const LookupKind& kind, TexelRange& range) const;
    // Returns a texel that gives the least (or greatest) code of `channel` in `range`, if the box reaches
    // one.
    TexelPlace find(const TexCoordBox& box, const LookupKind& kind, const TexelRange& range,
                    std::size_t channel, bool greatest) const;

private:
    struct Levels;  // texel_bounds.cpp

    std::shared_ptr<const Levels> levels_;
};

}  // namespace glint::gltf
