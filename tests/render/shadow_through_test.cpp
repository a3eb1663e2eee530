// Tests what the light of lights keeps on its way through alpha and glass: closed forms behind panes and
// slabs, what the settings differ in, and that every way to trace gives the same picture.
#include "render/pixel_test.h"
#include "render/ways.h"

#include <glint/internal/package_modules.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;
using package::ShadowThrough;

// The light comes down under an angle whose cosine to the plates above the scene is this.
constexpr double kCosine = 0.9284767;
constexpr gltf::Float3 kLightDirection{0.0F, -0.9284767F, -0.3713907F};

materials::Material diffuse(float albedo) {
    materials::Material material;
    material["baseColorFactor"] = {albedo, albedo, albedo, 1.0F};
    material["metallicFactor"] = 0.0F;
    material["specularFactor"] = 0.0F;
    return material;
}

materials::Material glass(gltf::Float3 color) {
    materials::Material material;
    material["baseColorFactor"] = {color[0], color[1], color[2], 1.0F};
    material["metallicFactor"] = 0.0F;
    material["roughnessFactor"] = 0.0F;
    material["transmissionFactor"] = 1.0F;
    return material;
}

// Schlick's reflectance of an index of 1.5, which is that of glTF.
double fresnel(double cosine) {
    return 0.04 + 0.96 * std::pow(1.0 - cosine, 5.0);
}

// A wall before the camera, and a light that comes from above; plates above the view may stand in its way.
gltf::Scene litWall() {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, diffuse(0.8F), {-4, -4, -2}, {8, 0, 0}, {0, 8, 0});
    addDirectionalLight(scene, kLightDirection, 3.0F);
    return scene;
}

// Adds a plate whose front faces up, or down.
void addPlate(gltf::Scene& scene, int material, float height, bool facesUp = true) {
    const gltf::Float3 right = facesUp ? gltf::Float3{18, 0, 0} : gltf::Float3{-18, 0, 0};
    const float left = facesUp ? -9.0F : 9.0F;
    addQuad(scene, material, {left, height, 2.5F}, right, {0, 0, -4.4F});
}

compiler::CompileSettings settingsFor(ShadowThrough through) {
    compiler::CompileSettings settings;
    settings.shadowThrough = through;
    settings.plan.keys.alpha = package::AlphaPolicy::Stochastic;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.strategies = package::kStrategyUber;
    return settings;
}

LinearImage picture(const gltf::Scene& scene, ShadowThrough through) {
    const LoadedScene loaded(scene, settingsFor(through));
    return loaded.render(package::kStrategyUber, darkSetup(scene, 16));
}

// Expects that each pixel keeps this share of the light that it has without plates.
void expectShare(const gltf::Scene& scene, ShadowThrough through, const std::array<double, 3>& share) {
    const LinearImage lit = picture(litWall(), ShadowThrough::Alpha);
    const LinearImage shaded = picture(scene, through);
    ASSERT_EQ(shaded.pixels.size(), lit.pixels.size());
    for (std::size_t i = 0; i < lit.pixels.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            ASSERT_NEAR(shaded.pixels[i][channel] / lit.pixels[i][channel], share[channel], 2e-5)
                << "pixel " << i << ", channel " << channel;
        }
    }
}

constexpr gltf::Float3 kFirst{0.9F, 0.4F, 0.2F};
constexpr gltf::Float3 kSecond{0.5F, 0.8F, 0.7F};

TEST(ShadowThrough, ThinPanesColorTheLight) {
    gltf::Scene scene = litWall();
    addPlate(scene, addMaterial(scene, glass(kFirst)), 3.0F);
    const double passed = 1.0 - fresnel(kCosine);
    expectShare(scene, ShadowThrough::Glass, {kFirst[0] * passed, kFirst[1] * passed, kFirst[2] * passed});
    // The second one is seen from behind, half metal and half transparent.
    materials::Material second = glass(kSecond);
    second["metallicFactor"] = 0.5F;
    second["transmissionFactor"] = 0.6F;
    addPlate(scene, addMaterial(scene, second), 3.5F, false);
    std::array<double, 3> share{};
    for (std::size_t i = 0; i < 3; ++i) {
        share[i] = kFirst[i] * passed * kSecond[i] * 0.5 * 0.6 * passed;
    }
    expectShare(scene, ShadowThrough::Glass, share);
    expectShare(scene, ShadowThrough::Alpha, {0.0, 0.0, 0.0});
    expectShare(scene, ShadowThrough::Opaque, {0.0, 0.0, 0.0});
}

constexpr gltf::Float3 kAttenuation{0.3F, 0.6F, 0.9F};
constexpr float kAttenuationDistance = 0.4F;

materials::Material absorbing() {
    materials::Material material = glass({1, 1, 1});
    material.give("KHR_materials_volume");
    material["thicknessFactor"] = 1.0F;
    material["attenuationColor"] = {kAttenuation[0], kAttenuation[1], kAttenuation[2]};
    material["attenuationDistance"] = kAttenuationDistance;
    return material;
}

TEST(ShadowThrough, ASlabAbsorbsByItsThickness) {
    constexpr double kThickness = 0.7;
    gltf::Scene scene = litWall();
    const int material = addMaterial(scene, absorbing());
    addPlate(scene, material, 3.0F, false);
    addPlate(scene, material, 3.0F + static_cast<float>(kThickness));
    const double passed = std::pow(1.0 - fresnel(kCosine), 2.0);
    std::array<double, 3> share{};
    for (std::size_t i = 0; i < 3; ++i) {
        share[i] = passed * std::pow(static_cast<double>(kAttenuation[i]),
                                     kThickness / kCosine / static_cast<double>(kAttenuationDistance));
    }
    expectShare(scene, ShadowThrough::Glass, share);
}

// Of a volume that holds the wall, light passes one interface and the way from there; so it does of one that
// holds the light.
TEST(ShadowThrough, VolumesThatHoldTheSurfaceOrTheLightAbsorbOneWay) {
    for (const bool holdsLight : {false, true}) {
        gltf::Scene scene = litWall();
        gltf::Light lamp;
        lamp.type = gltf::LightType::Point;
        lamp.position = {0.0F, 4.0F, 0.0F};
        lamp.intensity = 20.0F;
        scene.lights = {lamp};
        const LinearImage lit = picture(scene, ShadowThrough::Alpha);
        addPlate(scene, addMaterial(scene, absorbing()), 3.0F, !holdsLight);
        const LinearImage shaded = picture(scene, ShadowThrough::Glass);
        ASSERT_EQ(shaded.pixels.size(), lit.pixels.size());
        for (std::size_t i = 0; i < lit.pixels.size(); ++i) {
            // Where the pixel's light comes from is in the green channel; the others follow from it. The
            // pixels of the upper half are nearer to the lamp than 6.4 metres, and farther than 1.
            const auto depth = [&](std::size_t channel) {
                return -std::log(static_cast<double>(shaded.pixels[i][channel]) / lit.pixels[i][channel]);
            };
            const auto absorption = [](std::size_t channel) {
                return -std::log(static_cast<double>(kAttenuation[channel])) / kAttenuationDistance;
            };
            const double metres = (depth(1) - depth(2)) / (absorption(1) - absorption(2));
            ASSERT_GT(metres, holdsLight ? 1.0 : 0.99) << "pixel " << i;
            ASSERT_LT(metres, holdsLight ? 3.0 : 9.0) << "pixel " << i;
            ASSERT_NEAR(depth(0) - depth(1), (absorption(0) - absorption(1)) * metres, 2e-3) << "pixel " << i;
            // What is left is one interface, under an angle of at most 80 degrees.
            const double passed = std::exp(absorption(2) * metres - depth(2));
            ASSERT_LT(passed, 0.9602) << "pixel " << i;
            ASSERT_GT(passed, 0.55) << "pixel " << i;
        }
    }
}

TEST(ShadowThrough, SettingsDifferInBlendAsTheySay) {
    constexpr float kAlpha = 0.3F;
    gltf::Scene scene = litWall();
    materials::Material veil = diffuse(0.5F);
    veil.alphaMode = materials::AlphaMode::Blend;
    veil.doubleSided = true;
    veil["baseColorFactor"][3] = kAlpha;
    addPlate(scene, addMaterial(scene, veil), 3.0F);
    expectShare(scene, ShadowThrough::Opaque, {0.0, 0.0, 0.0});
    const double passed = 1.0 - static_cast<double>(kAlpha);
    expectShare(scene, ShadowThrough::Glass, {passed, passed, passed});
    // By --alpha each sample has all of the light or none.
    const LinearImage lit = picture(litWall(), ShadowThrough::Alpha);
    const LinearImage chosen = picture(scene, ShadowThrough::Alpha);
    ASSERT_EQ(chosen.pixels.size(), lit.pixels.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < lit.pixels.size(); ++i) {
        const double share = chosen.pixels[i][0] / lit.pixels[i][0];
        EXPECT_LT(std::min(std::abs(share), std::abs(share - 1.0)), 1e-5);
        sum += share;
    }
    const auto count = static_cast<double>(lit.pixels.size());
    EXPECT_NEAR(sum / count, passed, 4.0 * std::sqrt(passed * (1.0 - passed) / count));
}

// Returns a room with what light passes: thin and thick glass, a veil and a grid, between lamps and surfaces.
gltf::Scene glassRoom() {
    gltf::Scene scene = sceneWithCamera();
    const int grey = addMaterial(scene, diffuse(0.6F));
    const int mirror = addMaterial(scene, mirrorMaterial());
    materials::Material frosted = glass(kFirst);
    frosted["roughnessFactor"] = 0.4F;
    frosted.doubleSided = true;
    materials::Material veil = diffuse(0.5F);
    veil.alphaMode = materials::AlphaMode::Blend;
    veil["baseColorFactor"][3] = 0.4F;
    veil.doubleSided = true;
    materials::Material grid = diffuse(0.5F);
    grid.alphaMode = materials::AlphaMode::Mask;
    grid.doubleSided = true;
    grid.texture("baseColorTexture").texture =
        addTexture(scene, 2, 2, {255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 0, 255, 255, 255, 255});
    const auto add = [&](int material, gltf::Float3 corner, gltf::Float3 right, gltf::Float3 up) {
        addQuad(scene, material, corner, right, up);
    };
    add(grey, {-4, -1.1F, 1}, {8, 0, 0}, {0, 0, -7});
    add(grey, {-4, -1.1F, -5.2F}, {8, 0, 0}, {0, 6, 0});
    add(mirror, {-2.1F, -0.9F, -4.6F}, {3.1F, 0, -0.4F}, {0, 2.2F, 0});
    add(addMaterial(scene, frosted), {-1.5F, 1.3F, -1.1F}, {2.2F, 0.1F, 0}, {0, 0.1F, -2.3F});
    add(addMaterial(scene, veil), {0.4F, 1.5F, -1.3F}, {2.2F, 0.1F, 0}, {0, 0.1F, -2.1F});
    add(addMaterial(scene, grid), {-2.4F, 1.7F, -0.7F}, {1.3F, 0.1F, 0}, {0, 0.1F, -3.1F});
    const int slab = addMaterial(scene, absorbing());
    add(slab, {0.7F, 0.3F, -2.1F}, {0, 0, -1.9F}, {1.4F, 0, 0});
    add(slab, {0.7F, 0.52F, -2.1F}, {1.4F, 0, 0}, {0, 0, -1.9F});
    for (const float x : {-1.2F, 1.1F}) {
        gltf::Light lamp;
        lamp.type = gltf::LightType::Point;
        lamp.position = {x, 3.1F, -2.3F};
        lamp.intensity = 9.0F;
        scene.lights.push_back(lamp);
    }
    return scene;
}

compiler::CompileSettings roomSettings(ShadowThrough through, package::ShadowPlacement shadows) {
    compiler::CompileSettings settings = settingsFor(through);
    settings.tracers = package::kAllTracers;
    settings.shadows = shadows;
    settings.maxBounces = 2;
    settings.effects = {false, compiler::builtinEffects({"shadow", "reflection", "refraction"})};
    settings.effects.maxReflectionRoughness = 1.0F;
    return settings;
}

TEST(ShadowThrough, EveryStrategyAndTracerGivesTheSamePicture) {
    const gltf::Scene scene = glassRoom();
    RenderSetup setup = darkSetup(scene, 24);
    setup.frame.maxReflectionRoughness = 1.0F;
    std::optional<LinearImage> reference;
    const auto expectSame = [&](const LoadedScene& loaded, const Way& way, const std::string& name) {
        RendererOptions options = optionsOf(way);
        options.bounces = 2;
        const LinearImage image = loaded.render(options, setup);
        reference = reference.value_or(image);
        expectSameImage(image, *reference, name);
    };
    forEachWay(scene, roomSettings(ShadowThrough::Glass, package::ShadowPlacement::Inline),
               [&](const LoadedScene& loaded, const Way& way) { expectSame(loaded, way, nameOf(way)); });
    compiler::CompileSettings deferred =
        roomSettings(ShadowThrough::Glass, package::ShadowPlacement::Deferred);
    deferred.strategies = package::kStrategyHitShaders;
    const std::vector<Way> ways = waysOf(deferred.strategies, package::kAllTracers);
    if (!ways.empty()) {
        deferred.tracers = ways.front().tracer;
        const LoadedScene loaded(scene, deferred);
        expectSame(loaded, ways.front(), "deferred shadow rays");
    }
}

// A pane that is as wide as the wall colours light in all, however rough it is: what passes straight for
// shadow rays comes on all ways for paths. Neither counts the other's light.
TEST(ShadowThrough, PathsCountTheLightOfRoughGlassOnce) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, diffuse(0.5F), {-90, -90, -2}, {180, 0, 0}, {0, 180, 0});
    materials::Material frosted = glass({0.9F, 0.9F, 0.9F});
    frosted["roughnessFactor"] = 0.5F;
    frosted.doubleSided = true;
    addQuad(scene, frosted, {-90, -90, 0.5F}, {180, 0, 0}, {0, 180, 0});
    addDirectionalLight(scene, {0.0F, -0.3713907F, -0.9284767F}, 3.0F);
    const auto mean = [&](ShadowThrough through) {
        compiler::CompileSettings settings = settingsFor(through);
        settings.maxBounces = 3;
        settings.effects = {false, compiler::builtinEffects({"shadow", "indirect-diffuse"})};
        const LoadedScene loaded(scene, settings);
        RendererOptions options;
        options.strategy = package::kStrategyUber;
        options.bounces = 3;
        RenderSetup setup = darkSetup(scene, 16);
        setup.samples = 256;
        double sum = 0.0;
        for (const Pixel& pixel : loaded.render(options, setup).pixels) {
            sum += pixel[1] / 256.0;
        }
        return sum;
    };
    const double straight = mean(ShadowThrough::Glass);
    const double paths = mean(ShadowThrough::Alpha);
    std::printf("straight %.5f, by paths %.5f\n", straight, paths);
    EXPECT_GT(paths, 0.2);
    EXPECT_NEAR(straight / paths, 1.0, 0.04);
}

std::vector<std::vector<std::uint32_t>> codeOf(const LoadedScene& loaded) {
    std::vector<std::vector<std::uint32_t>> code;
    for (const package::ModuleKey& key : package::requiredModules(loaded.package().shape())) {
        const auto words = loaded.package().spirv(key);
        code.emplace_back(words.begin(), words.end());
    }
    return code;
}

// A package has nothing of a setting that changes nothing.
TEST(ShadowThrough, WithoutGlassOrBlendPackagesAreTheSame) {
    constexpr auto kInline = package::ShadowPlacement::Inline;
    gltf::Scene scene = litWall();
    addPlate(scene, addMaterial(scene, glass(kFirst)), 3.0F);
    const LoadedScene plain(scene, roomSettings(ShadowThrough::Alpha, kInline));
    const LoadedScene opaque(scene, roomSettings(ShadowThrough::Opaque, kInline));
    const LoadedScene passing(scene, roomSettings(ShadowThrough::Glass, kInline));
    EXPECT_EQ(opaque.package().shadowThrough(), ShadowThrough::Alpha);
    EXPECT_EQ(passing.package().shadowThrough(), ShadowThrough::Glass);
    EXPECT_EQ(codeOf(plain), codeOf(opaque));
    EXPECT_NE(codeOf(plain), codeOf(passing));
    // The glass turns opaque.
    scene.materials.back()["transmissionFactor"] = 0.0F;
    const LoadedScene without(scene, roomSettings(ShadowThrough::Alpha, kInline));
    const LoadedScene asked(scene, roomSettings(ShadowThrough::Glass, kInline));
    EXPECT_EQ(asked.package().shadowThrough(), ShadowThrough::Alpha);
    EXPECT_EQ(codeOf(without), codeOf(asked));
}

}  // namespace
