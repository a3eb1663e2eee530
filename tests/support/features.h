// Names of features as masks, for tests.
#pragma once

#include "materials/material_model.h"
#include "support/features.h"

#include <cstdlib>
#include <string_view>

namespace glint {

// Ends the test program if the built-in model has no such feature, so that a misspelt name can't pass.
inline materials::FeatureMask bit(std::string_view feature) {
    const materials::FeatureMask mask = materials::builtinMaterialModel().mask(feature);
    if (mask == 0) {
        std::abort();
    }
    return mask;
}

}  // namespace glint
