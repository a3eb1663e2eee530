#include "verify/prove_materials.h"

#include "emit/compile.h"
#include "emit/context.h"
#include "emit/glsl/passes.h"
#include "emit/material_code.h"
#include "emit/material_layout.h"
#include "gltf/scene.h"
#include "gltf/scene_list.h"
#include "materials/declarations.h"
#include "materials/feature_code.h"
#include "measure/features/checks.h"
#include "plan/plan.h"
#include "resolve/resolve.h"
#include "spirv/compiler.h"
#include "verify/prover.h"
#include "verify/symbolic.h"

#include <glint/result.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <utility>

namespace glint::verify {

struct FeatureProof {
    Program program;
    Claim claim;
};

// `code` is of the plan's model, and the build is of a scene that has the feature. Errors are those of
// compileShader() and executeSymbolically(): "prove-unsupported" where the code reads what the proof has no
// bounds of.
Result<FeatureProof> compileFeatureProof(const compiler::Build& build, const materials::FeatureCode& code);

namespace {

constexpr const char* kProofTemplate = "prove_feature.comp.mustache";
constexpr const char* kProofName = "prove_feature.comp";

// The inputs of the template begin with directions, random numbers and the place.
constexpr std::uint32_t kFirstParameter = 11;
constexpr std::uint32_t kProofOutputs = 35;
// The bound of a range without an end.
constexpr double kFarValue = 1000.0;
// The ranges that shares and lengths may have, as for the check "range" on the device.
constexpr double kShareSlack = 1e-3;

double endOf(double value, double fallback) {
    const bool isEnd = std::abs(value) < kLargestSingle;
    return isEnd ? value : std::copysign(std::max(kFarValue, kFarValue * std::abs(fallback)), value);
}

// Parameters of the feature follow; then four inputs for each texture slot; then the time, and alpha before
// the feature.
struct ProofInputs {
    std::uint32_t firstTexel = kFirstParameter;
    std::uint32_t time = 0;
    std::uint32_t alpha = 0;
    std::uint32_t count = 0;
};

// Returns the parameter whose numbers are in records.
const materials::Parameter& inRecord(const materials::MaterialModel& model,
                                     const materials::Parameter& parameter) {
    const bool isAlias = parameter.aliasOf >= 0;
    return isAlias ? model.parameters[static_cast<std::size_t>(parameter.aliasOf)] : parameter;
}

bool isClaimed(const materials::MaterialModel& model, const materials::Parameter& parameter, int feature) {
    return feature >= 0 && parameter.feature == feature && inRecord(model, parameter).inRecord;
}

ProofInputs inputsFor(const compiler::Plan& plan, int feature) {
    ProofInputs inputs;
    for (const materials::Parameter& parameter : plan.model->parameters) {
        inputs.firstTexel += isClaimed(*plan.model, parameter, feature) ? parameter.numbers : 0;
    }
    const std::size_t slots = materialLayoutOf(plan).textures.size();
    inputs.time = inputs.firstTexel + 4 * static_cast<std::uint32_t>(std::max<std::size_t>(slots, 1));
    inputs.alpha = inputs.time + 1;
    inputs.count = inputs.alpha + 1;
    return inputs;
}

InputRange inputOf(std::string name, double low, double high) {
    return {std::move(name), static_cast<float>(low), static_cast<float>(high), Scale::Linear};
}

// Macros that read parameters from the inputs, and the inputs' ranges.
std::string claimParameters(const materials::MaterialModel& model, int feature, const ProofInputs& inputs,
                            Claim& claim) {
    std::string macros = fmt::format("\nfloat glintGiven[{}];\n", inputs.count);
    std::uint32_t next = kFirstParameter;
    for (const materials::Parameter& parameter : model.parameters) {
        if (!isClaimed(model, parameter, feature)) {
            continue;
        }
        const auto channels = static_cast<std::uint32_t>(parameter.numbers);
        // GLSL reads what a parameter of another base fills by that one's name.
        const materials::Parameter& own = inRecord(model, parameter);
        std::string values;
        for (std::uint32_t channel = 0; channel < channels; ++channel) {
            const double usual = parameter.fallback[channel];
            claim.inputs[next] =
                inputOf(channels == 1 ? parameter.name : fmt::format("{}[{}]", parameter.name, channel),
                        endOf(parameter.low, usual), endOf(parameter.high, usual));
            values += fmt::format("{}glintGiven[{}]", channel == 0 ? "" : ", ", next++);
        }
        macros += fmt::format("#undef GLINT_MATERIAL_{0}\n#define GLINT_MATERIAL_{0}(hit) {1}({2})\n",
                              materials::fieldMacro(own.name), own.type->glsl, values);
    }
    return macros;
}

// hit/texture.glsl with texels that may be any, instead of samples.
std::string claimTexels(std::string text, const materials::MaterialModel& model, int feature,
                        const ProofInputs& inputs, Claim& claim, materials::FeatureMask& mask) {
    const std::size_t begin = text.find("GLINT_RELAXED vec4 sampleSlotAt(");
    const std::size_t end = text.find("// Returns the value of one texture slot of the hit's material.");
    text.replace(
        begin, end - begin,
        fmt::format("GLINT_RELAXED vec4 sampleSlotAt(Hit hit, uint slot, Features features, vec2 uv, vec4 "
                    "uvEdges) {{\n    uint first = {}u + 4u * slot;\n    return vec4(glintGiven[first], "
                    "glintGiven[first + 1u], glintGiven[first + 2u], glintGiven[first + 3u]);\n}}\n\n",
                    inputs.firstTexel));
    const std::size_t second = text.find("    return hasInput(features, GLINT_ROLE_TEX_COORD1)");
    const std::size_t secondEnd = text.find(";\n", second) + 1;
    text.replace(second, secondEnd - second, "    return false;");
    for (const materials::MaterialTexture& texture : model.textures) {
        const materials::Feature& bit = model.features[static_cast<std::size_t>(texture.feature)];
        mask |= feature >= 0 && bit.lobe == feature ? bit.mask() : materials::FeatureMask{0};
    }
    for (std::uint32_t texel = 0; inputs.firstTexel + texel < inputs.time; ++texel) {
        claim.inputs[inputs.firstTexel + texel] =
            inputOf(fmt::format("texel {} of slot {}", texel % 4, texel / 4), 0.0, 1.0);
    }
    return text;
}

// hit/surface_point.glsl with the same texels.
std::string claimPointTexels(std::string text, const ProofInputs& inputs) {
    const std::size_t begin = text.find("vec4 samplePoint(");
    text.replace(
        begin, std::string::npos,
        fmt::format("vec4 samplePoint(SurfacePoint point, uint slot, Features features) {{\n    uint first "
                    "= {}u + 4u * slot;\n    return vec4(glintGiven[first], glintGiven[first + 1u], "
                    "glintGiven[first + 2u], glintGiven[first + 3u]);\n}}\n",
                    inputs.firstTexel));
    return text;
}

std::vector<OutputRange> claimedRanges() {
    constexpr double kAny = kLargestSingle;
    std::vector<OutputRange> ranges(kProofOutputs);
    const auto vector = [&](std::size_t first, const std::string& name, double low, double high) {
        constexpr const char* kAxes[] = {".x", ".y", ".z"};
        for (std::size_t k = 0; k < 3; ++k) {
            ranges[first + k] = {name + kAxes[k], low, high};
        }
    };
    vector(0, "values.color", -kAny, kAny);
    ranges[3] = {"values.metallic", -kAny, kAny};
    ranges[4] = {"values.roughness", -kAny, kAny};
    ranges[5] = {"values.occlusion", -kAny, kAny};
    vector(6, "surface.bsdf.base.f0", -kAny, kAny);
    vector(9, "surface.bsdf.diffuse", -kAny, kAny);
    vector(12, "Shares().reflected", -kShareSlack, 1.0 + kShareSlack);
    ranges[15] = {"Shares().passed", -kShareSlack, 1.0 + kShareSlack};
    vector(16, "Evaluate().reflected", 0.0, kAny);
    ranges[19] = {"Evaluate().passed", -kShareSlack, 1.0 + kShareSlack};
    ranges[20] = {"Density()", 0.0, kAny};
    vector(21, "Sample()", -1.0 - kShareSlack, 1.0 + kShareSlack);
    vector(24, "emission", -kAny, kAny);
    const char* const coordinates[] = {"texCoords[0].x", "texCoords[0].y", "texCoords[1].x",
                                       "texCoords[1].y"};
    for (std::size_t k = 0; k < 4; ++k) {
        ranges[27 + k] = {coordinates[k], -kAny, kAny};
    }
    ranges[31] = {"alpha", -kAny, kAny};
    vector(32, "Diffuse()", 0.0, kAny);
    return ranges;
}

Claim startClaim(const ProofInputs& inputs) {
    constexpr double kTurn = std::numbers::pi;
    Claim claim;
    claim.inputs.assign(inputs.count, {"", 0.0, 0.0, Scale::Whole});
    claim.inputs[0] = {"view.z", 1e-7F, 1.0, Scale::Logarithmic};
    claim.inputs[1] = inputOf("azimuth of the view", -kTurn, kTurn);
    claim.inputs[2] = inputOf("light.z", -1.0, 1.0);
    claim.inputs[3] = inputOf("azimuth of the light", -kTurn, kTurn);
    claim.inputs[4] = inputOf("u.x", 0.0, 0.99999994);
    claim.inputs[5] = inputOf("u.y", 0.0, 0.99999994);
    for (const std::uint32_t axis : {0U, 1U, 2U}) {
        claim.inputs[6 + axis] = inputOf(fmt::format("position[{}]", axis), -kFarValue, kFarValue);
    }
    claim.inputs[9] = inputOf("uv[0]", -16.0, 16.0);
    claim.inputs[10] = inputOf("uv[1]", -16.0, 16.0);
    claim.inputs[inputs.time] = inputOf("time", 0.0, kFarValue);
    claim.inputs[inputs.alpha] = inputOf("alpha", 0.0, 1.0);
    claim.outputs = claimedRanges();
    return claim;
}

// Inputs that the code does not read stay a point, so that nothing is split for them.
void dropUnread(const Program& program, Claim& claim) {
    std::vector<bool> reads(claim.inputs.size(), false);
    std::vector<bool> isUsed(program.nodes.size(), false);
    for (const Node& node : program.nodes) {
        for (const NodeId operand : {node.a, node.b, node.c}) {
            if (operand != kNoNode) {
                isUsed[operand] = true;
            }
        }
    }
    for (const Edge& edge : program.edges) {
        isUsed[edge.value] = true;
    }
    for (const NodeId output : program.outputs) {
        isUsed[output] = true;
    }
    for (std::size_t id = 0; id < program.nodes.size(); ++id) {
        if (program.nodes[id].op == Op::Input && isUsed[id]) {
            reads[static_cast<std::size_t>(program.nodes[id].value)] = true;
        }
    }
    for (std::size_t k = 0; k < claim.inputs.size(); ++k) {
        if (!reads[k]) {
            claim.inputs[k] = {claim.inputs[k].name, 0.0, 0.0, Scale::Whole};
        }
    }
}

}  // namespace

Result<FeatureProof> compileFeatureProof(const compiler::Build& build, const materials::FeatureCode& code) {
    const compiler::Plan& plan = build.plan;
    const compiler::CompileSettings& settings = build.settings.compile;
    for (const materials::Parameter& parameter : plan.model->parameters) {
        if (isClaimed(*plan.model, parameter, code.feature) && !parameter.isVector()) {
            return makeError("prove-unsupported", code.declaration,
                             fmt::format("{} has the type {}; proofs know floats and vectors of them",
                                         parameter.declared, parameter.typeText()),
                             "use check-materials without --prove");
        }
    }
    GLINT_TRY(auto sources, compiler::makeSourceSet(*build.scenes, plan, settings));
    FeatureProof proof;
    const ProofInputs inputs = inputsFor(plan, code.feature);
    proof.claim = startClaim(inputs);
    materials::FeatureMask mask =
        code.feature < 0 ? 0 : plan.model->features[static_cast<std::size_t>(code.feature)].mask();
    sources.add("hit/texture.glsl", claimTexels(std::string(sources.find("hit/texture.glsl").value_or("")),
                                                *plan.model, code.feature, inputs, proof.claim, mask));
    sources.add("hit/surface_point.glsl",
                claimPointTexels(std::string(sources.find("hit/surface_point.glsl").value_or("")), inputs));
    sources.add("hit/frame_time.glsl",
                fmt::format("#include \"host/material.glsl\"\n\nfloat frameTime() {{\n    return "
                            "glintGiven[{}];\n}}\n",
                            inputs.time));
    const std::string record(sources.find("generated/material_record.glsl").value_or(""));
    sources.add("generated/material_record.glsl",
                record + claimParameters(*plan.model, code.feature, inputs, proof.claim));

    namespace mustache = kainjow::mustache;
    mustache::data context;
    const auto section = [&](const char* name, const std::string& file) {
        context.set(name, mustache::data(file.empty() ? mustache::data::type::bool_false
                                                      : mustache::data::type::bool_true));
    };
    section("surface", code.surface);
    section("bsdf", code.bsdf);
    section("layer", code.layer);
    section("model", code.model);
    section("sampled", code.isSampled ? code.model : std::string());
    section("emission", code.emission);
    section("diffuse", code.diffuse);
    section("coordinates", code.coordinates);
    section("opacity", code.opacity);
    context.set("coordinatesFile", code.coordinates);
    context.set("opacityFile", code.opacity);
    context.set("alphaInput", std::to_string(inputs.alpha));
    std::string type = code.name;
    type.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(type.front())));
    context.set("name", code.name);
    context.set("type", type);
    context.set("inputs", std::to_string(inputs.count));
    context.set("outputs", std::to_string(kProofOutputs));
    const package::KeyWords key = plan.model->words(mask);
    context.set("lobes", std::to_string(key.lobes));
    context.set("inputBits", std::to_string(key.inputs));
    context.set("modelWord", fmt::format("{:#x}u", key.model));
    context.set("ownWord", compiler::ownLiteral(key.own));
    GLINT_TRY(const auto text, compiler::renderTemplate(sources, kProofTemplate, context));
    GLINT_TRY(const auto glsl,
              compiler::flatten(kProofName, text, sources.lookup(), compiler::FlattenSide::Glsl));
    compiler::ShaderCompileOptions options;
    options.debugInfo = true;  // names
    const Result<std::vector<std::uint32_t>> words =
        compiler::compileShader({kProofName,
                                 compiler::ShaderStage::Compute,
                                 compiler::dropUnused(glsl).withPlaces(),
                                 {"proveFeature"}},
                                options);
    if (!words) {
        return compiler::explainGlslError(words.error(), *plan.model, settings.host);
    }
    Result<Program> program = executeSymbolically(*words, "proveFeature");
    if (!program) {
        Diagnostic error = program.error();
        error.where = code.declaration;
        return error;
    }
    proof.program = std::move(*program);
    dropUnread(proof.program, proof.claim);
    return proof;
}

namespace {

// Names of the inputs that the code reads, with their intervals or values.
std::string textOfInputs(const Claim& claim, const std::vector<Interval>& box) {
    std::string text;
    for (std::size_t k = 0; k < box.size(); ++k) {
        const InputRange& input = claim.inputs[k];
        if (input.low == input.high) {
            continue;
        }
        text += text.empty() ? "" : ", ";
        text += box[k].isPoint() ? fmt::format("{} {:.9g}", input.name, box[k].low)
                                 : fmt::format("{} in [{:.6g}, {:.6g}]", input.name, box[k].low, box[k].high);
    }
    return text;
}

FeatureProofOutcome outcomeOf(const FeatureProof& proof, const ProofResult& result) {
    FeatureProofOutcome outcome;
    outcome.undecidedShare = result.undecidedShare;
    outcome.boxes = result.boxes;
    switch (result.state) {
        case ProofState::Proved:
            outcome.state = FeatureProofState::Proved;
            break;
        case ProofState::Undecided:
            outcome.state = FeatureProofState::Undecided;
            outcome.message = result.undecidedWhy;
            outcome.place = textOfInputs(proof.claim, result.undecidedBox);
            break;
        case ProofState::Refuted: {
            outcome.state = FeatureProofState::Refuted;
            outcome.message = result.counterexample->what;
            std::vector<Interval> point;
            for (const double input : result.counterexample->inputs) {
                point.push_back(Interval::of(input));
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
                                                        const measure::Observer& observer) {
    GLINT_TRY(const auto model, materials::loadMaterialModel(options.packs));
    GLINT_TRY(const auto checked, measure::makeCheckedScene(*model, 2));
    GLINT_TRY(const auto build, compiler::resolve(std::span(&checked.scene, 1), compiler::CompileSettings()));
    std::vector<FeatureProofOutcome> outcomes;
    for (const measure::CheckedFeature& feature : checked.features) {
        if (feature.isBase()) {
            continue;
        }
        observer.progress(fmt::format("proving {} of {}: {}", outcomes.size() + 1, checked.features.size(),
                                      feature.code->name));
        const Result<FeatureProof> proof = compileFeatureProof(build, *feature.code);
        FeatureProofOutcome outcome;
        if (proof) {
            ProofOptions limits;
            limits.mostBoxes = options.boxes;
            outcome = outcomeOf(*proof, prove(proof->program, proof->claim, limits));
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

}  // namespace glint::verify
