// Checks the code of material features: `glint check-materials`. The functions run on the device, as in
// pictures, over combinations of the declared parameters' values.
#pragma once

#include "materials/material_model.h"

#include <glint/measure/observer.h>
#include <glint/renderer.h>
#include <glint/result.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::measure {

// The checks. docs/material_features.md explains each one and its limits.
enum class MaterialCheck : std::uint8_t {
    Range,        // all values are finite and within their ranges
    Density,      // the density integrates to one, less the share of samples that are lost
    Samples,      // samples follow the density
    Reciprocity,  // view and light may change places, where the declaration says so
    Energy,       // no more light leaves than came in
    Albedo,       // the layer reflects its declared share of a white sky
};
inline constexpr MaterialCheck kMaterialChecks[] = {MaterialCheck::Range,   MaterialCheck::Density,
                                                    MaterialCheck::Samples, MaterialCheck::Reciprocity,
                                                    MaterialCheck::Energy,  MaterialCheck::Albedo};
std::string_view nameOf(MaterialCheck check);  // "range"
// Returns the meaning of `worst` in the check's outcome, and of its limit.
std::string_view quantityOf(MaterialCheck check);  // "distance of the integral from one"

enum class CheckState : std::uint8_t {
    Passed,
    Failed,
    Absent,   // the feature has no such function
    Unasked,  // the declaration does not claim it
    Unsure,   // it depends on another check that failed
    Waived,   // it failed, and the declaration says why it may
};
std::string_view nameOf(CheckState state);  // "passed"

// The place of an evaluation.
struct CheckPlace {
    // The values of the feature's parameters, by name, with "textures" as the last where it has them.
    std::vector<std::pair<std::string, std::vector<float>>> parameters;
    std::string base;                              // "white dielectric"
    std::array<double, 3> view{};                  // unit, in the frame of the surface
    std::optional<std::array<double, 3>> light{};  // the same
};

struct CheckOutcome {
    MaterialCheck check{};
    CheckState state = CheckState::Absent;
    std::uint64_t evaluations = 0;
    double worst = 0.0;  // the value that is nearest to its limit, or farthest beyond it
    double limit = 0.0;
    std::string message{};  // of a failure: the finding
    std::optional<CheckPlace> place{};
};

// A picture of a feature, linear.
struct FeaturePicture {
    std::string name;  // of the file: "wax_furnace"
    LinearImage image;
};

struct FeatureChecks {
    std::string feature;
    std::string declaration;  // its file
    bool isLobe = false;      // a layer or a model
    std::uint32_t combinations = 0;
    std::vector<CheckOutcome> outcomes;  // one for each of kMaterialChecks, in that order

    bool failed() const;
};

struct MaterialChecksReport {
    std::string device;
    std::uint32_t samples = 0;
    std::vector<FeatureChecks> features;  // in the order in which their code runs
    std::vector<FeaturePicture> pictures;
};

struct CheckMaterialsOptions {
    std::vector<std::string> packs;  // folders
    std::string device;
    bool validate = false;
    std::uint32_t samples = 4096;     // directions for each combination and view
    std::uint32_t combinations = 12;  // of parameters, for each feature
    bool pictures = false;
    int jobs = 0;  // threads that compile; 0: one for each core
};

// Checks the features of the packs. Errors: those of loadMaterialModel(), of compiling and of the device,
// "check-unreachable" if a feature changes nothing for every combination of values.
Result<MaterialChecksReport> checkMaterials(const CheckMaterialsOptions& options, const Observer& observer);

// Returns an error for each check that failed: what was found, where, and what it means for a picture.
std::vector<Diagnostic> failuresOf(const FeatureChecks& feature);

}  // namespace glint::measure
