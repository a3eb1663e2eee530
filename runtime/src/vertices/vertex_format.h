// The compact forms of a vertex's attributes, as shaders/host/geometry.glsl reads them. All are 4 or 8 bytes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace glint {

// Each function returns words for the device, or none if the values would lose more than their bound allows.
// Pure.

// Octahedral, 2 x 16 bits, snorm, the nearest of the neighbouring codes: within 4.4e-5 rad. None if a
// vector's length is not within 1e-3 of 1.
std::optional<std::vector<std::uint32_t>> packNormals(std::span<const std::array<float, 3>> normals);

// Octahedral, 16 and 15 bits, and the sign of w: within 7.5e-5 rad. None if a vector is no unit vector, or w
// is not ±1.
std::optional<std::vector<std::uint32_t>> packTangents(std::span<const std::array<float, 4>> tangents);

// Two coordinates of 16 bits between the least and the largest of the primitive. The first four words are the
// bits of floats: the least u and v, and the step of each. Coordinates that a file has in 16 bits of [0, 1]
// keep their values. None if a step is above 2^-14, as where a texture is repeated many times, or is not
// finite.
std::optional<std::vector<std::uint32_t>> packTexCoords(std::span<const std::array<float, 2>> texCoords);

// Linear RGBA.
struct PackedColors {
    std::uint32_t bits = 0;  // of a channel: 8 if the colours are numbers of 8 bits, else 16
    std::vector<std::uint32_t> words;
};
// None if a channel is outside of [0, 1].
std::optional<PackedColors> packColors(std::span<const std::array<float, 4>> colors);

}  // namespace glint
