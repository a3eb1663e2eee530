// Images in memory, height fields, and PNG.
#pragma once

#include <glint/result.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace gallery {

struct Image {
    int width = 0;
    int height = 0;
    int channels = 3;                  // 3 or 4
    std::vector<std::uint8_t> pixels;  // first row on top
};

// Calls `colorOf` at every pixel centre with u to the right and v down, both within (0, 1). Colours are
// clamped to [0, 1] and stored without conversion, so encode sRGB if the texture is a colour.
Image paint(int width, int height, int channels, const std::function<glm::vec4(const glm::vec2&)>& colorOf);

// Heights over the unit square, in units of its width. They repeat at the borders.
struct HeightField {
    int size = 0;
    std::vector<float> heights;

    float at(int x, int y) const {
        return heights[static_cast<std::size_t>(y & (size - 1)) * static_cast<std::size_t>(size) +
                       static_cast<std::size_t>(x & (size - 1))];
    }
};

// `size` must be a power of two.
HeightField sculpt(int size, const std::function<float(const glm::vec2&)>& heightOf);

// Returns the tangent-space normals of a height field in glTF's convention: +X right, +Y up in the image.
Image normalMap(const HeightField& field);

// Radiance by direction as an equirectangular map, three numbers a pixel, first row on top: the left border
// is towards -X, and +Z is three quarters of the width to the right of it.
struct Environment {
    int width = 0;
    int height = 0;
    std::vector<float> pixels;
};

// Calls `radianceOf` with the direction of every pixel centre, a unit vector.
Environment paintEnvironment(int width, int height,
                             const std::function<glm::vec3(const glm::vec3&)>& radianceOf);

// Returns the bytes of a file in Radiance's format. Errors: "hdr-encode".
glint::Result<std::vector<std::uint8_t>> encodeHdr(const Environment& environment);

// Errors: "png-encode".
glint::Result<std::vector<std::uint8_t>> encodePng(const Image& image);

}  // namespace gallery
