// Tests the decisions that follow from scenes, settings and the place where shaders will run.
#include "resolve/resolve.h"

#include "render/scene_builder.h"
#include "settings/descriptor.h"
#include "support/must.h"

#include <glint/measure/settings.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {
namespace {

materials::Material lamp() {
    materials::Material material;
    material["metallicFactor"] = 0.0F;
    material["emissiveFactor"] = {1.0F, 1.0F, 1.0F};
    return material;
}

void addQuad(gltf::Scene& scene, const materials::Material& material) {
    testing::addQuad(scene, material, {-1, -1, -2}, {2, 0, 0}, {0, 2, 0});
}

// Returns a scene in which nothing but triangles shines.
gltf::Scene sceneOfEmitters() {
    gltf::Scene scene = testing::emptyScene();
    addQuad(scene, lamp());
    return scene;
}

// Returns a scene in which as many settings as possible change something.
gltf::Scene richScene() {
    gltf::Scene scene = sceneOfEmitters();
    const int texture = testing::addTexture(scene, 1, 1, {10, 20, 30, 40});
    materials::Material mirror = testing::mirrorMaterial();
    mirror.texture("baseColorTexture").texture = texture;
    addQuad(scene, mirror);
    materials::Material glossy;
    glossy["roughnessFactor"] = 0.25F;
    glossy.alphaMode = materials::AlphaMode::Mask;
    glossy.texture("baseColorTexture").texture = texture;
    addQuad(scene, glossy);
    materials::Material veil;
    veil.alphaMode = materials::AlphaMode::Blend;
    veil["baseColorFactor"] = {1.0F, 1.0F, 1.0F, 0.5F};
    addQuad(scene, veil);
    materials::Material glass;
    glass["roughnessFactor"] = 0.0F;
    glass.give("KHR_materials_transmission");
    glass["transmissionFactor"] = 1.0F;
    addQuad(scene, glass);
    materials::Material coated;
    coated.give("KHR_materials_clearcoat");
    coated["clearcoatFactor"] = 1.0F;
    addQuad(scene, coated);
    testing::addDirectionalLight(scene, {0, -1, 0}, 1.0F);
    gltf::Light point;
    point.type = gltf::LightType::Point;
    scene.lights.insert(scene.lights.end(), 40, point);
    return scene;
}

Build resolved(const gltf::Scene& scene, const Settings& settings, const Target& target = {}) {
    return must(resolve(std::span(&scene, 1), settings, target));
}

const Target& drawing() {
    static const Target target{.tracers = package::kAllTracers};
    return target;
}

std::set<std::string> idsOf(const Build& build) {
    std::set<std::string> ids;
    for (const Diagnostic& message : build.messages) {
        ids.insert(message.id);
    }
    return ids;
}

std::set<std::string> effectsOf(const Build& build) {
    std::set<std::string> names;
    for (const EffectDecision& decision : build.plan.effects.decisions) {
        if (decision.chosen) {
            names.insert(decision.name);
        }
    }
    return names;
}

// Triangles become lights before effects of lights are found useless.
TEST(Resolve, EmittersCallForShadowsInEveryCommand) {
    const gltf::Scene scene = sceneOfEmitters();
    Settings settings;
    settings.compile.effects = {false, builtinEffects({"shadow"})};
    settings.sun = Sun::Off;
    EXPECT_TRUE(idsOf(resolved(scene, settings)).contains("effect-unused")) << "of one bounce";
    settings.compile.maxBounces = 4;
    for (const Target& target : {Target(), drawing()}) {
        const Build build = resolved(scene, settings, target);
        EXPECT_FALSE(idsOf(build).contains("effect-unused"));
        EXPECT_EQ(build.settings.compile.emissiveLights, EmissiveLights::On);
        EXPECT_EQ(effectsOf(build), std::set<std::string>{"shadow"});
        // The bounces then change the picture, although no effect sends rays.
        const Descriptor& bounces = *sweptSetting("bounces");
        EXPECT_EQ(idleReason(bounces, measure::factsOf(build), configurationOf(settings)), "");
    }
}

TEST(Resolve, BouncesCallForEffects) {
    const gltf::Scene scene = sceneOfEmitters();
    Settings settings;
    EXPECT_FALSE(effectsOf(resolved(scene, settings)).contains("shadow"));
    settings.compile.maxBounces = 4;
    EXPECT_TRUE(effectsOf(resolved(scene, settings)).contains("shadow"));
}

// An engine says where its triangles are, so steps take them only if they are asked to. Nobody knows how many
// there will be. Steps know disks, and frames do with lights that programs have.
TEST(Resolve, LightsOfSteps) {
    const gltf::Scene scene = sceneOfEmitters();
    Settings settings;
    EXPECT_EQ(resolved(scene, settings).settings.compile.diskLights, DiskLights::Off);
    settings.compile.maxBounces = 4;
    EXPECT_EQ(resolved(scene, settings).settings.compile.diskLights, DiskLights::On);
    settings.compile.passes = package::Passes::Steps;
    const CompileSettings without = resolved(scene, settings).settings.compile;
    EXPECT_EQ(without.emissiveLights, EmissiveLights::Off);
    EXPECT_EQ(without.lightSamples, 0U);
    EXPECT_EQ(without.diskLights, DiskLights::On);
    settings.compile.emissiveLights = EmissiveLights::On;
    settings.compile.sizedLights = SizedLights::On;
    settings.compile.diskLights = DiskLights::Off;
    const CompileSettings with = resolved(scene, settings).settings.compile;
    EXPECT_EQ(with.emissiveLights, EmissiveLights::On);
    EXPECT_EQ(with.sizedLights, SizedLights::On);
    EXPECT_EQ(with.lightSamples, 8U);
    EXPECT_EQ(with.diskLights, DiskLights::Off);
}

TEST(Resolve, LeavesNothingToBeDecided) {
    const gltf::Scene scene = richScene();
    Settings settings;
    settings.strategy.reset();
    settings.compile.maxBounces = 4;
    const Build build = resolved(scene, settings, drawing());
    ASSERT_TRUE(build.settings.strategy);
    ASSERT_TRUE(build.settings.compile.strategyChoice);
    EXPECT_EQ(build.settings.compile.strategies, *build.settings.strategy);
    EXPECT_EQ(build.settings.alpha, package::AlphaPolicy::Stochastic);
    EXPECT_EQ(build.settings.compile.plan.keys.alpha, package::AlphaPolicy::Stochastic);
    EXPECT_NE(build.settings.compile.emissiveLights, EmissiveLights::Auto);
    EXPECT_NE(build.settings.compile.skyLight, SkyLight::Auto);
    EXPECT_NE(build.settings.compile.sizedLights, SizedLights::Auto);
    EXPECT_NE(build.settings.compile.diskLights, DiskLights::Auto);
    EXPECT_TRUE(build.settings.compile.lightSamples);
    EXPECT_NE(build.settings.sun, Sun::Auto);
    // The decided settings decide the same once more.
    const Build again = resolved(scene, build.settings, drawing());
    EXPECT_EQ(changeBetween(build.settings, again.settings), 0U);
}

TEST(Resolve, APackageHasDecided) {
    const gltf::Scene scene = richScene();
    DecidedPackage package;
    package.shape = {.strategies = package::strategyTable().back().strategy,
                     .tracers = package::kTracerRayPipeline,
                     .effects = {},
                     .fallback = true};
    package.alpha = package::AlphaPolicy::Tested;
    package.skyLight = true;
    package.lightSamples = 3;
    Target target = drawing();
    target.package = package;
    const Build build = resolved(scene, Settings(), target);
    EXPECT_EQ(build.settings.compile.strategies, package.shape.strategies);
    EXPECT_EQ(build.settings.compile.tracers, package::kTracerRayPipeline);
    EXPECT_EQ(build.settings.alpha, package::AlphaPolicy::Tested);
    EXPECT_EQ(build.settings.compile.skyLight, SkyLight::On);
    EXPECT_EQ(build.settings.compile.emissiveLights, EmissiveLights::Off);
    EXPECT_EQ(build.settings.compile.lightSamples, 3U);
    EXPECT_FALSE(build.settings.compile.trustTextures);
    EXPECT_EQ(build.plan.effects.effects.all, 0U);
}

TEST(Resolve, TexturesThatMayChangeAreNotTrusted) {
    Settings settings;
    EXPECT_TRUE(trustsTextures(settings));
    settings.compile.plan.fallback = true;
    EXPECT_FALSE(trustsTextures(settings));
    settings.compile.plan.fallback = false;
    settings.compile.host = "host";
    EXPECT_FALSE(trustsTextures(settings));
    DecidedPackage package;
    package.trustsTextures = true;
    EXPECT_TRUE(trustsTextures(settings, &package)) << "it has decided";
    package.trustsTextures = false;
    EXPECT_FALSE(trustsTextures(Settings(), &package));
}

TEST(Resolve, KeepsWhatNeedsAnotherBuild) {
    const gltf::Scene scene = richScene();
    const Build build = resolved(scene, Settings(), drawing());
    Settings wanted;
    wanted.samples = 7;
    wanted.renderer.picture = RendererOptions::PictureFormat::Half;
    wanted.compile.plan.merge = MergePolicy::None;
    wanted.package = "package";
    EXPECT_NE(changeBetween(build.settings, wanted) & kChangesPackage, 0U);
    const Settings shown = withoutRebuilding(build.settings, wanted);
    EXPECT_EQ(shown.samples, 7U);
    EXPECT_EQ(shown.renderer.picture, RendererOptions::PictureFormat::Half);
    EXPECT_EQ(shown.compile.plan.merge, build.settings.compile.plan.merge);
    EXPECT_EQ(shown.package, "");
    EXPECT_EQ(changeBetween(build.settings, shown), kChangesFrame | kChangesRenderer);
}

// Returns the parts of a build that `explain` prints.
std::string explained(const Build& build) {
    std::string text = fmt::format("{} {}", fmt::join(effectsOf(build), ","), build.excess.value_or(""));
    for (const Key& key : build.plan.keys) {
        text += fmt::format(" {}:{}", toHex(key.mask), key.shaderId);
    }
    if (const std::optional<StrategyAdvice>& advice = build.settings.compile.strategyChoice) {
        for (const StrategyEstimate& estimate : advice->choice.estimates) {
            text += fmt::format(" {}", estimate.ms);
        }
    }
    return text;
}

// Returns the parts of a build from which packages and pictures are made.
std::string made(const Build& build, SettingCommand command) {
    std::string text = explained(build);
    for (const Descriptor& row : settingsTable()) {
        if ((row.commands & command) != 0) {
            text += fmt::format(" {}={}", row.name, row.values.text(build.settings));
        }
    }
    return text;
}

// Returns values of a setting besides its default.
std::vector<std::string> otherValues(const Descriptor& row) {
    std::vector<std::string> values;
    for (const SettingWord& word : wordsOf(row)) {
        values.push_back(word.name);
    }
    if (row.values.form == ValueForm::Switch) {
        values = {"on", "off"};
    } else if (row.values.form == ValueForm::Whole || row.values.form == ValueForm::Real) {
        for (const double value : {row.values.min + 1.0, row.values.min + 3.0, row.values.max / 2.0}) {
            values.push_back(fmt::format("{}", value));
        }
    }
    std::erase_if(values, [&](const std::string& value) {
        return value == row.values.text(Settings()) || !complaintAbout(row, value).empty();
    });
    return values;
}

// A command that takes a setting uses it, or says that it changes nothing.
TEST(Resolve, EverySettingOfACommandChangesWhatItMakes) {
    const gltf::Scene scene = richScene();
    // Readers of scenes ask for the first by trustsTextures(). A profile is a file.
    const std::set<std::string_view> readsFiles{"trust-textures=off", "merge=profile"};
    int pairs = 0;
    for (const SettingCommand command : {kOfCompile, kOfExplain, kOfRender}) {
        const Target target = command == kOfRender ? drawing() : Target();
        Settings usual;
        usual.advisesStrategy = command == kOfExplain;
        const auto says = [&](const Build& build) {
            return command == kOfExplain ? explained(build) : made(build, command);
        };
        const std::string before = says(resolved(scene, usual, target));
        for (const Descriptor& row : settingsTable()) {
            if ((row.commands & command) == 0) {
                continue;
            }
            // Only --precision auto with the table of a GPU reads this one, and commands warn of it else.
            bool isUsed = otherValues(row).empty() || row.name == "precision-error";
            for (const std::string& value : otherValues(row)) {
                Settings settings = usual;
                row.values.set(settings, value);
                const Result<Build> build = resolve(std::span(&scene, 1), settings, target);
                const auto isIdle = [&] {
                    const std::string reason =
                        idleReason(row, measure::factsOf(*build), configurationOf(build->settings));
                    return !reason.empty();
                };
                isUsed = isUsed || !build || says(*build) != before ||
                         readsFiles.contains(fmt::format("{}={}", row.name, value)) || isIdle();
            }
            EXPECT_TRUE(isUsed) << "--" << row.name << " of command " << command;
            ++pairs;
        }
    }
    EXPECT_GT(pairs, 80);
}

}  // namespace
}  // namespace glint::compiler
