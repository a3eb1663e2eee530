#include "emit/feature_proof.h"
#include "gltf/scene_list.h"
#include "materials/packs.h"
#include "measure/features/combinations.h"
#include "plan/plan.h"

#include <glint/measure/check_materials.h>

#include <fmt/format.h>

#include <utility>

namespace glint::measure {

namespace {

// Names of the inputs that the code reads, with their intervals or values.
std::string textOfInputs(const prove::Claim& claim, const std::vector<prove::Interval>& box) {
    std::string text;
    for (std::size_t k = 0; k < box.size(); ++k) {
        const prove::InputRange& input = claim.inputs[k];
        if (input.low == input.high) {
            continue;
        }
        text += text.empty() ? "" : ", ";
        text += box[k].isPoint() ? fmt::format("{} {:.9g}", input.name, box[k].low)
                                 : fmt::format("{} in [{:.6g}, {:.6g}]", input.name, box[k].low, box[k].high);
    }
    return text;
}

FeatureProofOutcome outcomeOf(const compiler::FeatureProof& proof, const prove::ProofResult& result) {
    FeatureProofOutcome outcome;
    outcome.undecidedShare = result.undecidedShare;
    outcome.boxes = result.boxes;
    switch (result.state) {
        case prove::ProofState::Proved:
            outcome.state = FeatureProofState::Proved;
            break;
        case prove::ProofState::Undecided:
            outcome.state = FeatureProofState::Undecided;
            outcome.message = result.undecidedWhy;
            outcome.place = textOfInputs(proof.claim, result.undecidedBox);
            break;
        case prove::ProofState::Refuted: {
            outcome.state = FeatureProofState::Refuted;
            outcome.message = result.counterexample->what;
            std::vector<prove::Interval> point;
            for (const double input : result.counterexample->inputs) {
                point.push_back(prove::Interval::of(input));
            }
            outcome.place = textOfInputs(proof.claim, point);
            break;
        }
    }
    return outcome;
}

}  // namespace

std::string_view nameOf(FeatureProofState state) {
    constexpr std::string_view kNames[] = {"proved", "undecided", "refuted", "unsupported"};
    return kNames[static_cast<std::size_t>(state)];
}

Result<std::vector<FeatureProofOutcome>> proveMaterials(const ProveMaterialsOptions& options,
                                                        const Observer& observer) {
    GLINT_TRY(const auto model, materials::loadMaterialModel(options.packs));
    GLINT_TRY(const auto checked, makeCheckedScene(*model, 2));
    GLINT_TRY(const auto build, compiler::resolve(std::span(&checked.scene, 1), compiler::CompileSettings()));
    std::vector<FeatureProofOutcome> outcomes;
    for (const CheckedFeature& feature : checked.features) {
        observer.progress(fmt::format("proving {} of {}: {}", outcomes.size() + 1, checked.features.size(),
                                      feature.code->name));
        const Result<compiler::FeatureProof> proof = compiler::compileFeatureProof(build, *feature.code);
        FeatureProofOutcome outcome;
        if (proof) {
            prove::ProofOptions limits;
            limits.mostBoxes = options.boxes;
            outcome = outcomeOf(*proof, prove::prove(proof->program, proof->claim, limits));
        } else if (proof.error().id == "prove-unsupported") {
            outcome.state = FeatureProofState::Unsupported;
            outcome.message = proof.error().message;
        } else {
            return proof.error();
        }
        outcome.feature = feature.code->name;
        outcome.declaration = feature.code->declaration;
        outcomes.push_back(std::move(outcome));
    }
    observer.progress("");
    return outcomes;
}

std::optional<Diagnostic> failureOf(const FeatureProofOutcome& outcome) {
    if (outcome.state != FeatureProofState::Refuted) {
        return std::nullopt;
    }
    return makeError("check-proof", outcome.declaration,
                     fmt::format("{}: {}, for {}", outcome.feature, outcome.message, outcome.place),
                     "pixels would be black or wrong, and the light of all samples with them");
}

}  // namespace glint::measure
