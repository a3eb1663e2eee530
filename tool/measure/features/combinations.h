// The scene in which features are checked: a square for each combination of parameters.
#pragma once

#include "gltf/scene.h"
#include "materials/material_model.h"

#include <glint/measure/check_materials.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::measure {

// The material on which a feature is checked.
struct CheckedMaterial {
    std::uint32_t geometry = 0;  // number of its square, and of its material
    int base = 0;                // index into kCheckedBases
    CheckPlace place;            // parameters and base
};

struct CheckedFeature {
    const materials::FeatureCode* code = nullptr;
    std::vector<CheckedMaterial> materials;
};

// The materials below the features. Their colour is white, so that a gain of energy is visible.
struct CheckedBase {
    const char* name;
    float metallic;
    float roughness;
};
inline constexpr CheckedBase kCheckedBases[] = {{"white dielectric", 0.0F, 1.0F},
                                                {"white metal", 1.0F, 0.5F}};

struct CheckedScene {
    gltf::Scene scene;
    std::vector<CheckedFeature> features;
    std::vector<std::uint32_t> bases;  // the squares that have a base alone
};

// Makes a square with normals, tangents, UVs and all declared attributes for up to `combinations`
// combinations of the parameters of each feature of a pack. Combinations for which the feature changes
// nothing are left out. Error "check-unreachable" if none is left.
Result<CheckedScene> makeCheckedScene(const materials::MaterialModel& model, std::uint32_t combinations);

// The values at which a parameter is checked: a usual one, the least and the greatest.
std::vector<float> checkedValues(const materials::Parameter& parameter);

}  // namespace glint::measure
