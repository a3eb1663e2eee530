// Describes the contents of textures in words, for the reasons of `glint explain`. Pure functions.
#pragma once

#include "materials/material.h"

#include <cstdint>
#include <string>

namespace glint::compiler {

// Describes the channels (bit 0: red) of a texture: "clearcoatTexture.r is 0", "metallicRoughnessTexture.g is
// 0.31 to 0.8: the least at (3, 5) of /images/2". Numbers are those that shading reads.
std::string heldText(const materials::Material& material, const materials::PrimitiveInputs& primitive,
                     int texture, std::uint32_t channels);

// Describes the known contents of the textures on which a condition depends: those whose texels it names, and
// those that scale its parameters, or have done so before they were folded. Returns an empty text if nothing
// is known of them.
enum class HeldBy : std::uint8_t { All, Folded };
std::string whatTexturesHold(const materials::Material& material, const materials::PrimitiveInputs& primitive,
                             const materials::Expression& when, HeldBy which);

}  // namespace glint::compiler
