// Parameters of every type, from lists of materials to pixels, in two models with the same names.
#include "base/files.h"
#include "gltf/import.h"
#include "gltf/material_set.h"
#include "materials/declarations.h"
#include "render/harness.h"
#include "render/pixel_test.h"
#include "render/scene_builder.h"
#include "support/must.h"
#include "support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <regex>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

// A model whose surface emits what its parameters say. `opal`, `Opal` and `OPAL` stand for its name.
constexpr const char* kDeclaration = R"json({
    "name": "opal", "extension": "EXT_opal", "stage": "base",
    "glsl": {"bsdf": "opal_surface.glsl", "model": "opal.glsl", "emission": "opal_surface.glsl",
             "after": ["emission"]},
    "replaces": {"object": "pbrMetallicRoughness"},
    "parameters": [
        {"name": "step", "type": "int", "default": 0, "range": [-1, 2]},
        {"name": "bits", "type": "uint", "default": 0},
        {"name": "flag", "type": "bool", "default": false},
        {"name": "edge", "type": "enum", "values": ["soft", "hard"], "default": "soft"},
        {"name": "turn", "type": "mat3", "default": [1, 0, 0, 0, 1, 0, 0, 0, 1]},
        {"name": "place", "type": "mat4", "default": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
        {"name": "ramp", "type": "color", "count": 4, "range": [0, 4],
         "default": [[0, 0, 0], [0.25, 0, 0], [0.5, 0, 0], [1, 0, 0]]},
        {"name": "marks", "type": "bool", "count": 3, "default": [false, false, false]},
        {"name": "turns", "type": "mat3", "count": 2,
         "default": [[1, 0, 0, 0, 1, 0, 0, 0, 1], [1, 0, 0, 0, 1, 0, 0, 0, 1]]},
        {"name": "color", "is": "baseColorFactor", "default": [1, 1, 1, 1]}
    ],
    "textures": [{"name": "rampTexture"}],
    "features": [{"name": "worn", "gltf": "edge", "neutral": [
        {"when": "edge == soft or not flag or step < 1", "because": "it is not worn"}]}],
    "effects": [{"does": "emits", "when": "doubleSided or not doubleSided"}]
})json";
constexpr const char* kModel = R"(#include "bsdf/model.glsl"
struct Opal {
    float none;
};
void opalPrepare(inout Opal model, vec3 view) {}
vec3 opalEvaluate(Opal model, vec3 view, vec3 l) {
    return vec3(0.0);
}
)";
constexpr const char* kSurface = R"(#include "hit/surface_values.glsl"
void opalBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    surface.bsdf.layers.opal = Opal(0.0);
    surface.bsdf.diffuse = vec3(0.0);
}
void opalEmission(Hit hit, Features features, inout vec3 emitted) {
    int step = GLINT_MATERIAL_OPAL_STEP(hit);
    emitted = GLINT_MATERIAL_OPAL_RAMP(hit, step + 1);
    emitted.r += GLINT_HAS_OPAL_WORN(features) ? 8.0 : 0.0;
    uint bits = GLINT_MATERIAL_OPAL_BITS(hit);
    emitted.g += GLINT_MATERIAL_OPAL_EDGE(hit) == kOpalEdgeHard ? 0.5 : 0.25;
    emitted.g += (GLINT_MATERIAL_OPAL_MARKS(hit, 2u) ? 1.0 : 0.0) + float(bits >> 30) + 4.0 * float(bits & 1u);
    vec3 turned = GLINT_MATERIAL_OPAL_TURN(hit) * vec3(1.0, 2.0, 4.0);
    vec3 twice = GLINT_MATERIAL_OPAL_TURNS(hit, 1) * turned;
    emitted.b += twice.y + (GLINT_MATERIAL_OPAL_PLACE(hit) * vec4(0.0, 0.0, 0.0, 1.0)).x;
    emitted.b += GLINT_MATERIAL_OPAL_FLAG(hit) ? 0.5 : 0.0;
    if (GLINT_HAS_OPAL_RAMP_TEXTURE(features)) {
        emitted = sampleSlot(hit, kOpalRampTexture, features).rgb;
    }
}
)";

void writeModel(const std::filesystem::path& folder, const std::string& name) {
    std::string capital = name;
    std::string upper = name;
    capital[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    for (char& c : upper) {
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    for (const auto& [file, text] :
         {std::pair{".json", kDeclaration}, {".glsl", kModel}, {"_surface.glsl", kSurface}}) {
        std::string made = std::regex_replace(std::string(text), std::regex("opal"), name);
        made = std::regex_replace(made, std::regex("Opal"), capital);
        made = std::regex_replace(made, std::regex("OPAL"), upper);
        ASSERT_TRUE(base::writeFile(folder / (name + file), made));
    }
}

constexpr const char* kList = R"json({"materialList": 1, "materials": [
    {"name": "first", "model": "opal", "edited": ["ramp", "step", "edge", "bits", "flag"], "values": {
        "step": 2, "bits": 3221225473, "flag": true, "edge": "hard", "marks": [false, false, true],
        "ramp": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0.25, 0.125]],
        "turn": [1, 2, 3, 4, 5, 6, 7, 8, 9], "place": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.75, 0, 0, 1],
        "turns": [[9, 9, 9, 9, 9, 9, 9, 9, 9], [0, 0.25, 0, 0, 0.5, 0, 0, 0, 0]]}},
    {"name": "second", "model": "jade", "values": {"step": -1, "edge": "hard", "bits": 1073741824,
        "ramp": [[0.5, 1, 2], [1, 1, 1], [1, 1, 1], [1, 1, 1]]}}
]})json";

class TypedValues : public ::testing::Test {
protected:
    TypedValues() {
        writeModel(folder_.path(), "opal");
        writeModel(folder_.path(), "jade");
        options_.materialModel = must(materials::loadMaterialModel(std::vector{folder_.path().string()}));
        EXPECT_TRUE(base::writeFile(folder_.path() / "list.json", kList));
    }

    test::TemporaryFolder folder_;
    gltf::ImportOptions options_;
};

compiler::CompileSettings settings() {
    compiler::CompileSettings made;
    made.strategies = package::kStrategyUber;
    made.effects = {false, compiler::builtinEffects({})};
    return made;
}

// What a material shows, by the same sums as the GLSL above.
constexpr gltf::Float3 kFirst{0.5F + 8.0F, 0.25F + 0.5F + 1.0F + 3.0F + 4.0F,
                              // turn * (1, 2, 4) is (37, 44, 51), of which turns[1] takes 0.25 and 0.5.
                              0.125F + 0.25F * 37.0F + 0.5F * 44.0F + 0.75F + 0.5F};
constexpr gltf::Float3 kSecond{0.5F, 1.0F + 0.5F + 1.0F, 2.0F + 2.0F};

// The values of the two materials lie over each other in records, and stand alone in packages of one.
TEST_F(TypedValues, GoFromListsToPictures) {
    const gltf::Scene list = must(gltf::importScene(folder_.path() / "list.json", options_));
    EXPECT_TRUE(list.warnings.empty()) << toString(list.warnings.front());
    for (const int only : {0, 1, -1}) {
        gltf::Scene scene = sceneWithCamera();
        for (int i = 0; i < 2; ++i) {
            if (only < 0 || only == i) {
                addQuad(scene, list.materials[static_cast<std::size_t>(i)], {i == 0 ? -4.0F : 0.0F, -4, -4},
                        {4, 0, 0}, {0, 8, 0});
            }
        }
        const LoadedScene loaded(scene, settings());
        const LinearImage image = loaded.render(package::kStrategyUber, darkSetup(scene, 16));
        if (only != 1) {
            expectColor(at(image, 4, 8), kFirst, 1e-6F, "first");
        }
        if (only != 0) {
            expectColor(at(image, 12, 8), kSecond, 1e-6F, "second");
        }
        // C++ has the fields in the types that records have them.
        const auto& files = loaded.compiled().files;
        const auto header =
            std::ranges::find(files, std::string("glint_tables.h"), &compiler::PackageFile::name);
        ASSERT_NE(header, files.end());
        const std::string text(header->bytes.begin(), header->bytes.end());
        const auto says = [&](const std::string& line) { return text.find(line) != std::string::npos; };
        EXPECT_EQ(says("inline constexpr std::uint32_t kOpalEdgeHard = 1;  // of opalEdge\n"), only != 1);
        for (const char* const member :
             {"std::int32_t opalStep;", "std::uint32_t opalFlag;", "float opalTurn[9];",
              "gpu::vec3 opalRamp[4];", "std::uint32_t opalMarks[3];", "float opalTurns[18];"}) {
            EXPECT_EQ(says(member), only == 0) << member;
        }
    }
}

// Programs change values in records of the package, which keeps features for all that a list calls edited.
TEST_F(TypedValues, ChangeWhileAPackageIsInUse) {
    const gltf::Scene list = must(gltf::importScene(folder_.path() / "list.json", options_));
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, list.materials[0], {-4, -4, -4}, {4, 0, 0}, {0, 8, 0});
    addQuad(scene, list.materials[1], {0, -4, -4}, {4, 0, 0}, {0, 8, 0});
    scene.animatedMaterials = list.animatedMaterials;
    ASSERT_EQ(scene.animatedMaterials.size(), 1U);
    PosedScene posed(scene, std::make_shared<LoadedScene>(scene, settings()));
    RendererOptions options;
    const RenderSetup setup = darkSetup(scene, 16);
    options.strategy = package::kStrategyUber;
    options.width = options.height = 16;
    const auto renderer = posed.makeRenderer(options);
    expectColor(at(drawn(*renderer, setup.frame), 4, 8), kFirst, 1e-6F, "before");
    materials::Material& first = posed.scene.materials[0];
    first["step"] = 0.0;
    first["edge"] = 0.0;
    first["bits"] = 2147483648.0;
    first["flag"] = 0.0;
    first["ramp"][3] = 0.75;
    posed.update();
    const LinearImage after = drawn(*renderer, setup.frame);
    // The feature `worn` stays, since the package keeps it for all values.
    expectColor(at(after, 4, 8), {0.75F + 8.0F, 0.25F + 1.0F + 2.0F, 0.25F * 37.0F + 0.5F * 44.0F + 0.75F},
                1e-6F, "after");
    expectColor(at(after, 12, 8), kSecond, 1e-6F, "the other one");
}

}  // namespace
