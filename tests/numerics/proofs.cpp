#include "proofs.h"

#include "evaluate.h"
#include "proof_inputs.h"
#include "spirv/compiler.h"
#include "verify/symbolic.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace glint::numerics {
namespace {

constexpr std::string_view kText =
#include "proofs_text.inc"
    ;

// A module with all claims, each of which stays a function.
compiler::ShaderSource sourceOf(const std::vector<Proof>& proofs) {
    std::string text(kText);
    const std::size_t firstLine = text.find("#line");
    text.insert(firstLine == std::string::npos ? 0 : firstLine,
                fmt::format("#define GLINT_ENERGY_COMPENSATION 1\n#define GLINT_PROVES\n"
                            "#define PROOF(name) void prove##name(float i[{}], inout float o[{}])\n",
                            kMaxInputs, kMaxOutputs));
    compiler::ShaderSource source;
    source.name = "proofs";
    text += fmt::format(
        "layout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer Results {{ float data[]; }} "
        "results;\nvoid main() {{\n    float i[{}];\n    float o[{}];\n",
        kMaxInputs, kMaxOutputs);
    text += fmt::format("    for (int k = 0; k < {}; ++k) {{ i[k] = results.data[k]; }}\n", kMaxInputs);
    for (const Proof& proof : proofs) {
        const std::string name = fmt::format("prove{}", proof.name);
        text += fmt::format("    {}(i, o);\n", name);
        source.functionsApart.push_back(name);
    }
    text += fmt::format("    for (int k = 0; k < {}; ++k) {{ results.data[k] = o[k]; }}\n}}\n", kMaxOutputs);
    source.glsl = std::move(text);
    return source;
}

}  // namespace

const std::vector<Proof>& allProofs() {
    static const std::vector<Proof> kProofs = [] {
        std::vector<Proof> all = hitProofs();
        const std::vector<Proof> bsdf = bsdfProofs();
        all.insert(all.end(), bsdf.begin(), bsdf.end());
        return all;
    }();
    return kProofs;
}

const std::vector<Unclaimed>& unclaimedFunctions() {
    static const std::vector<Unclaimed> kUnclaimed{
        {"`edgeInset`, `inEdges`, `coneGradients`, `planeError`",
         "they divide by the area of a triangle or of a texture, which may be 0, and tell what is not a "
         "number apart by "
         "comparisons; intervals have no such numbers. Probes measure them"},
        {"`screenRay`, `screenPixel`, `screenDistance`",
         "their domain is a relation of eight numbers: an origin in view. Probes measure them"},
        {"`rayTriangleBarycentrics`, `barycentricsAlong`, `emitterPointDensity`, `seenFrom`, "
         "`sampleSeenTriangle`",
         "their files read the scene's buffers; the first two divide by areas, as above"},
        {"`lightImportance`, `angleBeyond`, `packReceiver`, `unpackReceiver`, `lightOfTree`",
         "their file reads the scene's buffers"},
        {"`hostSky`, `environmentCoordinates`, `tapRoughness`, `skyAroundLobe`",
         "their files read textures and the frame"},
        {"`fetchHit`, `evaluateSurface`, `shade` and what calls them",
         "they read vertices, records and textures"},
        {"`sampleBsdf`, but for the directions of its microfacets",
         "its weights are `evaluateBsdf` over `bsdfPdf`, whose quotient is bounded because both follow the "
         "same "
         "lobes; intervals know each alone. `sampling_test.cpp` measures them"},
        {"energy over all directions", "an integral is no bound over boxes; `furnace_test.cpp` measures it"}};
    return kUnclaimed;
}

Result<std::vector<verify::Program>> compileProofs(const std::vector<Proof>& proofs) {
    compiler::ShaderCompileOptions options;
    options.debugInfo = true;  // names, by which functions are found
    GLINT_TRY(const auto words, compiler::compileShader(sourceOf(proofs), options));
    std::vector<verify::Program> programs;
    for (const Proof& proof : proofs) {
        Result<verify::Program> program =
            verify::executeSymbolically(words, fmt::format("prove{}", proof.name));
        if (!program) {
            Diagnostic error = program.error();
            error.where = std::string(proof.function);
            return error;
        }
        programs.push_back(std::move(*program));
    }
    return programs;
}

Result<verify::Program> compileClaim(std::string_view statements) {
    compiler::ShaderSource source;
    source.name = "claim";
    source.glsl = fmt::format(
        "#version 460\nprecision highp float;\nlayout(local_size_x = 1) in;\nlayout(std430, binding = 0) "
        "buffer Results "
        "{{ float data[2]; }} results;\nvoid claim(float i[1], inout float o[1]) {{\n{}\n}}\nvoid main() "
        "{{\n    float "
        "i[1];\n    float o[1];\n    i[0] = results.data[0];\n    claim(i, o);\n    results.data[1] = "
        "o[0];\n}}\n",
        statements);
    source.functionsApart = {"claim"};
    compiler::ShaderCompileOptions options;
    options.debugInfo = true;
    GLINT_TRY(const auto words, compiler::compileShader(source, options));
    return verify::executeSymbolically(words, "claim");
}

bool isProvedQuickly(const Proof& proof) {
    static constexpr std::string_view kNames[] = {
        "OctahedralDecode",    "TransformPoint",
        "TransformNormal",     "SampleLightArea",
        "RandomUnit",          "IncludeSample",
        "AddProduct",          "DifferenceOfProducts",
        "AccurateDot",         "SchlickWeight",
        "SchlickF0",           "Luminance",
        "GgxDistribution",     "GgxVisibility",
        "SampleVisibleNormal", "VisibleNormalPdf",
        "MirroredPdf",         "GgxLoss",
        "GgxMeanAlbedo",       "SampleCosine",
        "SheenDistribution",   "SheenLambda",
        "SheenVisibility",     "SheenMasking",
        "SheenHorizon",        "SheenAlbedo",
        "CosineOfCycles",      "FilmSensitivity",
        "DispersedIor",        "VolumeTransmittance",
        "FresnelSchlick",      "ClearcoatFresnel",
        "SheenShares",         "PassedAgain",
        "SpecularShares",      "SampleLight",
        "EvaluateBase",        "ChancesTranslucent",
    };
    return std::find(std::begin(kNames), std::end(kNames), proof.name) != std::end(kNames);
}

}  // namespace glint::numerics
