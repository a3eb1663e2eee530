// The key of a primitive: the features that shading it needs, and the reasons in words.
#pragma once

#include "materials/material.h"

#include <glint/internal/package_format.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

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

// --- The key of a primitive: the features that shading it needs ---

// Returns the canonical key of one primitive. If `dropped` is not null, (feature name, reason) pairs are
// added to it.
materials::FeatureMask makeKey(const materials::Material& material,
                               const materials::PrimitiveInputs& primitive,
                               const materials::KeyOptions& options,
                               std::vector<std::pair<std::string, std::string>>* dropped = nullptr);

// Returns the same options, but with all lobes, as primary surfaces need them.
materials::KeyOptions keepAllLobes(materials::KeyOptions options);

// Returns the policy under which rays see the alpha of every surface, which is Opaque if all are. Requires
// every PrimitiveInputs::material to index `materials`.
package::AlphaPolicy neededAlphaPolicy(std::span<const materials::Material> materials,
                                       std::span<const materials::PrimitiveInputs> primitives);

}  // namespace glint::compiler
