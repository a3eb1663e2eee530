// Proofs about all features of packs, for `glint check-materials --prove`.
#pragma once

#include <glint/measure/observer.h>
#include <glint/result.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::verify {

// How far the proof about a feature came (docs/material_features.md, "Proofs").
enum class FeatureProofState : std::uint8_t {
    Proved,
    Undecided,    // for a share of the inputs the bounds are too wide
    Refuted,      // a counterexample was found
    Unsupported,  // the code does what intervals can't follow
};
std::string_view nameOf(FeatureProofState state);  // "proved"

struct FeatureProofOutcome {
    std::string feature;
    std::string declaration;  // its file
    FeatureProofState state = FeatureProofState::Unsupported;
    double undecidedShare = 1.0;  // of the volume of all inputs
    std::uint64_t boxes = 0;
    std::string message{};  // the failure, the undecided operation, or the unsupported one
    std::string place{};    // the inputs for which it is
};

struct ProveMaterialsOptions {
    std::vector<std::string> packs;  // folders
    std::uint64_t boxes = 4096;      // the most for each feature
};

// Proves for each feature of the packs that every operation is defined and every result finite and in its
// range, for all values of its parameters, texels, views and lights. Needs no device. Has the errors of
// loadMaterialModel(), makeCheckedScene() and compileFeatureProof().
Result<std::vector<FeatureProofOutcome>> proveMaterials(const ProveMaterialsOptions& options,
                                                        const measure::Observer& observer);

// The error of a feature that is refuted.
std::optional<Diagnostic> failureOf(const FeatureProofOutcome& outcome);

}  // namespace glint::verify
