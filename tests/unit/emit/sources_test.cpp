#include "emit/context.h"
#include "emit/glsl/passes.h"
#include "support/features.h"
#include "support/must.h"
#include "unit/emit/sample_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>

namespace glint {
namespace {

using namespace glint::testing;

std::string sceneSource(const compiler::Plan& plan, const compiler::CompileSettings& settings) {
    const gltf::Scene scene = makeSampleScene();
    const Result<compiler::SourceSet> sources = makeSourceSet(gltf::SceneList({&scene, 1}), plan, settings);
    return sources ? std::string(sources->find("generated/scene.glsl").value_or("")) : std::string();
}

bool defines(const std::string& text, const std::string& macro, const std::string& value) {
    return text.find("#define " + macro + " " + value + "\n") != std::string::npos;
}

TEST(SceneSource, TellsHitsFromPrimarySurfaces) {
    compiler::Plan plan;
    plan.primaryAlways = 0x0000000100000004;
    plan.primarySometimes = 0x0000000200000030;
    plan.always = 0x0000000100000000;
    plan.sometimes = 0x0000000200000010;
    const std::string text = sceneSource(plan, {});
    EXPECT_TRUE(defines(text, "GLINT_ALWAYS_LOBES", "0x4u"));
    EXPECT_TRUE(defines(text, "GLINT_ALWAYS_INPUTS", "0x1u"));
    EXPECT_TRUE(defines(text, "GLINT_SOMETIMES_LOBES", "0x30u"));
    EXPECT_TRUE(defines(text, "GLINT_SOMETIMES_INPUTS", "0x2u"));
    EXPECT_TRUE(defines(text, "GLINT_HIT_ALWAYS_LOBES", "0x0u"));
    EXPECT_TRUE(defines(text, "GLINT_HIT_ALWAYS_INPUTS", "0x1u"));
    EXPECT_TRUE(defines(text, "GLINT_HIT_SOMETIMES_LOBES", "0x10u"));
    EXPECT_TRUE(defines(text, "GLINT_HIT_SOMETIMES_INPUTS", "0x2u"));
}

// Other features of a scene do not change modules that test alpha.
TEST(SceneSource, AlphaHasWhatItReadsAlone) {
    compiler::Plan plan;
    plan.always = bit("texCoord0") | bit("normals") | bit("sheen");
    plan.sometimes = bit("baseColorTexture") | bit("normalTexture");
    compiler::CompileSettings settings;
    EXPECT_TRUE(defines(sceneSource(plan, settings), "GLINT_ALPHA_ALWAYS_INPUTS", "0x0u"));
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    const std::string text = sceneSource(plan, settings);
    EXPECT_TRUE(
        defines(text, "GLINT_ALPHA_ALWAYS_INPUTS", fmt::format("{:#x}u", bit("texCoord0").shared() >> 32U)));
    EXPECT_TRUE(defines(text, "GLINT_ALPHA_SOMETIMES_INPUTS", "0x1u"));
}

TEST(SceneSource, HoldsTheSettings) {
    compiler::CompileSettings settings;
    const std::string usual = sceneSource({}, settings);
    EXPECT_TRUE(defines(usual, "GLINT_ENERGY_COMPENSATION", "1"));
    EXPECT_TRUE(defines(usual, "GLINT_TEXTURE_LOD_CONES", "1"));
    EXPECT_TRUE(defines(usual, "GLINT_PRECISION", "32"));
    EXPECT_NE(usual.find("#define GLINT_RELAXED\n"), std::string::npos);
    EXPECT_TRUE(defines(usual, "GLINT_ALPHA_TESTED", "0"));
    EXPECT_TRUE(defines(usual, "GLINT_MAY_MASK", "1"));
    settings.energyCompensation = false;
    settings.textureLod = compiler::TextureLod::Mip0;
    settings.precision = package::ShadingPrecision::Half;
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    const std::string other = sceneSource({}, settings);
    EXPECT_TRUE(defines(other, "GLINT_ENERGY_COMPENSATION", "0"));
    EXPECT_TRUE(defines(other, "GLINT_TEXTURE_LOD_CONES", "0"));
    EXPECT_TRUE(defines(other, "GLINT_PRECISION", "16"));
    EXPECT_TRUE(defines(other, "GLINT_RELAXED", "mediump"));
    EXPECT_TRUE(defines(other, "GLINT_ALPHA_TESTED", "1"));
}

// Returns the files that a text of Glint's includes.
std::set<std::string> includedBy(std::string_view name) {
    const gltf::Scene scene = makeSampleScene();
    const compiler::SourceSet sources =
        must(makeSourceSet(gltf::SceneList({&scene, 1}), {}, compiler::CompileSettings()));
    std::set<std::string> files;
    const compiler::SourceLookup lookup = [&](std::string_view file) {
        files.emplace(file);
        return sources.find(file);
    };
    std::string text(sources.find(name).value_or(""));
    if (!text.starts_with("#version")) {
        text.insert(0, "#version 460\n");
    }
    must(flatten(name, text, lookup, compiler::FlattenSide::Glsl));
    return files;
}

// An edit of a material's code makes the texts of all modules that include it again.
TEST(Includes, OfPixelsThatShowTheSkyHaveNoCodeOfMaterials) {
    constexpr const char* kMaterials = "generated/layers.glsl";  // includes the functions of packs
    EXPECT_TRUE(includedBy("generated/surface_layers.glsl").contains(kMaterials));
    EXPECT_FALSE(includedBy("first/first_miss.comp").contains(kMaterials));
}

}  // namespace
}  // namespace glint
