// The key of a primitive: the features that shading it needs.
#pragma once

#include "materials/material.h"

#include <glint/package_format.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glint::compiler {

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
