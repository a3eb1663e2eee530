// The checks of material features: packs with one planted fault each, and the example packs, which have none.
#include "base/files.h"
#include "support/must.h"
#include "support/temporary_folder.h"
#include "verify/prove_materials.h"

#include <glint/measure/check_materials.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace glint;
using measure::CheckState;
using measure::FeatureChecks;
using measure::MaterialCheck;
namespace fs = std::filesystem;

// A layer of wax. Every function may be replaced.
struct Wax {
    std::string name;
    std::string share = "layer.factor";                         // reflected of a white sky
    std::string reflected = "layer.factor * cosineDensity(l)";  // of the light from l
    std::string passed = "1.0 - layer.factor";
    std::string sample = "sampleCosine(u)";
    std::string density = "cosineDensity(l)";
    std::string factor = "1.0";  // of the parameter
    std::string gains{};         // a member of "glsl"
};

void writeWax(const fs::path& folder, const Wax& wax) {
    const std::string& name = wax.name;
    std::string capital = name;
    capital[0] = static_cast<char>(capital[0] - 'a' + 'A');
    std::string macro = name;
    std::ranges::transform(macro, macro.begin(), [](char c) { return static_cast<char>(c - 'a' + 'A'); });
    fs::create_directories(folder / name);
    ASSERT_TRUE(base::writeFile(folder / name / (name + ".json"), fmt::format(R"({{
    "name": "{0}", "stage": "layer", "extension": "TEST_{0}",
    "glsl": {{ "bsdf": "{0}_bsdf.glsl", "layer": "{0}.glsl", "reciprocal": true{1} }},
    "parameters": [{{ "name": "{0}Factor", "type": "float", "default": 0, "range": [0, 1] }}],
    "neutral": [{{ "when": "{0}Factor == 0", "because": "{0}Factor is 0" }}]
}})",
                                                                              name, wax.gains)));
    ASSERT_TRUE(base::writeFile(
        folder / name / (name + ".glsl"),
        fmt::format(R"(#include "bsdf/layer.glsl"
struct {1} {{ float factor; }};
void {0}Prepare(inout {1} layer, vec3 view) {{}}
LayerAlbedo {0}Shares({1} layer, vec3 view) {{ return LayerAlbedo(vec3({2}), {4}); }}
LayerLight {0}Evaluate({1} layer, vec3 view, vec3 l) {{ return LayerLight(vec3({3}), {4}, l.z); }}
vec3 {0}Sample({1} layer, vec3 view, vec2 u) {{ return {5}; }}
float {0}Density({1} layer, vec3 view, vec3 l) {{ return {6}; }}
)",
                    name, capital, wax.share, wax.reflected, wax.passed, wax.sample, wax.density)));
    ASSERT_TRUE(base::writeFile(folder / name / (name + "_bsdf.glsl"),
                                fmt::format(R"(#include "hit/surface_values.glsl"
void {0}Bsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {{
    surface.bsdf.layers.{0} = {1}({3} * GLINT_MATERIAL_{2}_FACTOR(hit));
}}
)",
                                            name, capital, macro, wax.factor)));
}

class Silent final : public measure::Observer {
public:
    using measure::Observer::report;
    void report(const Diagnostic& diagnostic) const override {
        ADD_FAILURE() << toString(diagnostic);
    }
    void progress(std::string_view /*text*/) const override {}
    void detail(std::string_view /*text*/) const override {}
};

Result<measure::MaterialChecksReport> check(const fs::path& folder, bool pictures = false) {
    measure::CheckMaterialsOptions options;
    options.packs = {folder.string()};
    options.combinations = 6;
    options.validate = true;
    options.pictures = pictures;
    return measure::checkMaterials(options, Silent());
}

measure::CheckState stateOf(const measure::FeatureChecks& feature, measure::MaterialCheck check) {
    return std::ranges::find(feature.outcomes, check, &measure::CheckOutcome::check)->state;
}

struct Planted {
    Wax wax;
    measure::MaterialCheck fails;
    std::string id;
    std::string says;
};

std::vector<Planted> plantedFaults() {
    std::vector<Planted> faults;
    Wax range{"notnumber"};
    // The direction of a vector without length.
    range.reflected = "layer.factor * cosineDensity(l) * dot(normalize(l.xy), normalize(l.xy))";
    faults.push_back({range, measure::MaterialCheck::Range, "check-range", "NaN or infinite"});
    Wax density{"density"};
    density.density = "1.5 * cosineDensity(l)";
    faults.push_back({density, measure::MaterialCheck::Density, "check-density", "integrates to 1.5"});
    Wax samples{"samples"};
    // Uniform over the hemisphere.
    samples.sample =
        "vec3(sqrt(1.0 - u.x * u.x) * cos(2.0 * kPi * u.y), sqrt(1.0 - u.x * u.x) * sin(2.0 * kPi * u.y), "
        "u.x)";
    faults.push_back({samples, measure::MaterialCheck::Samples, "check-samples", "by chance"});
    Wax reciprocity{"oneway"};
    reciprocity.share = "layer.factor * view.z";
    reciprocity.reflected = "layer.factor * view.z * cosineDensity(l)";
    faults.push_back(
        {reciprocity, measure::MaterialCheck::Reciprocity, "check-reciprocity", "in each other's place"});
    Wax energy{"energy"};
    energy.passed = "1.0";
    faults.push_back({energy, measure::MaterialCheck::Energy, "check-energy", "of a white furnace leaves"});
    Wax albedo{"albedo"};
    albedo.share = "0.25 * layer.factor";
    faults.push_back({albedo, measure::MaterialCheck::Albedo, "check-albedo", "of a white sky, and says"});
    Wax behind{"behind"};
    behind.factor = "(hit.frontFace ? 1.0 : -1.0)";
    behind.share = "max(layer.factor, -0.25 * layer.factor)";
    behind.reflected = "abs(layer.factor) * cosineDensity(l)";
    behind.passed = "1.0 - abs(layer.factor)";
    faults.push_back({behind, measure::MaterialCheck::Albedo, "check-albedo", "double-sided, blended"});
    return faults;
}

TEST(CheckMaterials, FindEachPlantedFaultAndNoOther) {
    const test::TemporaryFolder folder;
    writeWax(folder.path(), {"sound"});
    Wax waived{"waived"};
    waived.passed = "1.0";
    waived.gains = R"(, "gainsEnergy": "it is drawn")";
    writeWax(folder.path(), waived);
    const std::vector<Planted> faults = plantedFaults();
    for (const Planted& planted : faults) {
        writeWax(folder.path(), planted.wax);
    }
    const measure::MaterialChecksReport report = must(check(folder.path()));
    ASSERT_EQ(report.features.size(), faults.size() + 3);
    EXPECT_EQ(report.features.front().feature, "metallicRoughness");
    for (const measure::FeatureChecks& feature : report.features) {
        const auto planted = std::ranges::find(
            faults, feature.feature, [](const Planted& one) -> const std::string& { return one.wax.name; });
        const std::vector<Diagnostic> failures = failuresOf(feature);
        if (planted == faults.end()) {
            EXPECT_TRUE(failures.empty()) << toString(failures.front());
            EXPECT_EQ(stateOf(feature, measure::MaterialCheck::Samples), measure::CheckState::Passed);
            const measure::CheckOutcome& energy = feature.outcomes[4];
            EXPECT_EQ(nameOf(energy.state), feature.feature == "waived" ? "waived" : "passed");
            EXPECT_EQ(energy.message.ends_with("declared: it is drawn"), feature.feature == "waived");
            continue;
        }
        ASSERT_EQ(failures.size(), 1U) << feature.feature << ": " << toString(failures.back());
        EXPECT_EQ(failures[0].id, planted->id);
        EXPECT_TRUE(failures[0].where.ends_with(feature.feature + ".json")) << failures[0].where;
        EXPECT_NE(failures[0].message.find(planted->says), std::string::npos) << failures[0].message;
        EXPECT_NE(failures[0].message.find(feature.feature + "Factor "), std::string::npos)
            << failures[0].message;
        EXPECT_FALSE(failures[0].hint.empty());
        EXPECT_EQ(stateOf(feature, planted->fails), measure::CheckState::Failed);
        // If the density is wrong, nobody knows what samples should follow.
        EXPECT_EQ(stateOf(feature, measure::MaterialCheck::Samples),
                  planted->fails == measure::MaterialCheck::Density   ? measure::CheckState::Unsure
                  : planted->fails == measure::MaterialCheck::Samples ? measure::CheckState::Failed
                                                                      : measure::CheckState::Passed)
            << feature.feature;
    }
}

TEST(CheckMaterials, TheExamplePacksPass) {
    std::size_t features = 0;
    for (const char* const folder : {"/examples/materials", "/examples/materials/drafts",
                                     "/examples/materials/models", "/examples/materials/openpbr"}) {
        const measure::MaterialChecksReport report =
            must(check(std::string(GLINT_SOURCE_DIR) + folder, true));
        features += report.features.size();
        for (const measure::FeatureChecks& feature : report.features) {
            for (const Diagnostic& failure : failuresOf(feature)) {
                ADD_FAILURE() << toString(failure);
            }
            EXPECT_EQ(stateOf(feature, measure::MaterialCheck::Range), measure::CheckState::Passed)
                << feature.feature;
            EXPECT_EQ(stateOf(feature, measure::MaterialCheck::Energy), measure::CheckState::Passed)
                << feature.feature;
            EXPECT_EQ(stateOf(feature, measure::MaterialCheck::Density),
                      feature.isLobe || feature.feature == "metallicRoughness" ? measure::CheckState::Passed
                                                                               : measure::CheckState::Absent)
                << feature.feature;
        }
        EXPECT_EQ(report.pictures.size(), 2 * report.features.size());
    }
    EXPECT_GE(features, 15U);
}

// Samples rarely meet the one value of a parameter for which code fails; a proof cannot miss it.
TEST(CheckMaterials, ProofsHoldForWaxAndFindAMissingCheck) {
    const test::TemporaryFolder folder;
    const Wax sound{"sound"};
    Wax unchecked{"unchecked"};
    unchecked.density = "cosineDensity(l) * sqrt(0.999 - layer.factor)";
    writeWax(folder.path(), sound);
    writeWax(folder.path(), unchecked);
    const std::vector<verify::FeatureProofOutcome> outcomes =
        must(verify::proveMaterials({{folder.path().string()}, 500}, Silent()));
    ASSERT_EQ(outcomes.size(), 2U);
    for (const verify::FeatureProofOutcome& outcome : outcomes) {
        const bool isSound = outcome.feature == sound.name;
        EXPECT_EQ(nameOf(outcome.state), isSound ? "proved" : "refuted") << outcome.message << outcome.place;
        EXPECT_EQ(verify::failureOf(outcome).has_value(), !isSound);
    }
}

// Code that decides about alpha and coordinates has no values and lobes, and is proved all the same.
TEST(CheckMaterials, ProofsCoverOpacityAndCoordinates) {
    const test::TemporaryFolder folder;
    const auto write =
        [&](const std::string& name, const std::string& stage, const std::string& body) {
            ASSERT_TRUE(base::writeFile(folder.path() / (name + ".json"),
                                        R"({"name": ")" + name + R"(", "stage": ")" + stage +
                                            R"(", "extension": "TEST_)" + name + R"(", "needs": "texCoord0",
            "glsl": { ")" + stage + R"(": ")" +
                                            name + R"(.glsl" },
            "parameters": [{ "name": ")" + name +
                                            R"(Amount", "type": "float", "default": 0, "range": [0, null] }],
            "neutral": [{ "when": ")" + name +
                                            R"(Amount == 0", "because": "there is none" }]})"));
            ASSERT_TRUE(base::writeFile(folder.path() / (name + ".glsl"), body));
        };
    const std::string opacity = "Opacity(SurfacePoint point, Features features, inout float alpha) {\n    ";
    const std::string coordinates = "Coordinates(inout SurfacePoint point, Features features) {\n    ";
    const std::string include = "#include \"hit/surface_point.glsl\"\nvoid ";
    write("holes", "opacity",
          include + "holes" + opacity +
              "alpha *= fract(point.texCoords[0].x * GLINT_MATERIAL_HOLES_AMOUNT(point));\n}\n");
    write("rust", "opacity", include + "rust" + opacity + "alpha = sqrt(alpha - 0.25);\n}\n");
    write("sway", "coordinates",
          include + "sway" + coordinates +
              "point.texCoords[0] += GLINT_MATERIAL_SWAY_AMOUNT(point) * sin(frameTime());\n}\n");
    write("pinch", "coordinates",
          include + "pinch" + coordinates + "point.texCoords[0] /= max(point.texCoords[0].x, 0.0);\n}\n");
    const std::vector<verify::FeatureProofOutcome> outcomes =
        must(verify::proveMaterials({{folder.path().string()}, 500}, Silent()));
    ASSERT_EQ(outcomes.size(), 4U);
    for (const verify::FeatureProofOutcome& outcome : outcomes) {
        const bool isSound = outcome.feature == "holes" || outcome.feature == "sway";
        EXPECT_EQ(nameOf(outcome.state), isSound ? "proved" : "refuted")
            << outcome.feature << ": " << outcome.message << outcome.place;
    }
}

// Proofs bounded 53 numbers of a feature once.
TEST(CheckMaterials, ProofsBoundEveryParameter) {
    const test::TemporaryFolder folder;
    std::string parameters;
    for (char letter = 'A'; letter <= 'N'; ++letter) {
        parameters +=
            fmt::format(R"({}{{"name": "many{}", "type": "vec4", "default": [1, 1, 1, 1], "range": [0, 1]}})",
                        parameters.empty() ? "" : ", ", letter);
    }
    ASSERT_TRUE(base::writeFile(
        folder.path() / "many.json",
        R"({"name": "many", "stage": "surface", "extension": "TEST_many", "glsl": {"surface": "many.glsl"},
            "parameters": [)" +
            parameters + "]}"));
    ASSERT_TRUE(base::writeFile(folder.path() / "many.glsl", R"(#include "hit/surface_values.glsl"
void manySurface(Hit hit, Features features, inout SurfaceValues values) {
    values.color.rgb *= GLINT_MATERIAL_MANY_A(hit).rgb / (GLINT_MATERIAL_MANY_N(hit).x + 0.5);
}
)"));
    const std::vector<verify::FeatureProofOutcome> outcomes =
        must(verify::proveMaterials({{folder.path().string()}, 500}, Silent()));
    EXPECT_EQ(nameOf(outcomes.front().state), "proved") << outcomes.front().message;
}

TEST(CheckMaterials, AFeatureThatChangesNothingIsAnError) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(base::writeFile(folder.path() / "mud.json", R"({
        "name": "mud", "stage": "surface", "extension": "TEST_mud", "glsl": { "surface": "mud.glsl" },
        "parameters": [{ "name": "mudAmount", "type": "float", "default": 0, "range": [0, 1] }],
        "neutral": [{ "when": "mudAmount < 2", "because": "there is no mud" }]
    })"));
    ASSERT_TRUE(base::writeFile(folder.path() / "mud.glsl", "// mud\n"));
    EXPECT_EQ(mustFail(check(folder.path())).id, "check-unreachable");
}

}  // namespace
