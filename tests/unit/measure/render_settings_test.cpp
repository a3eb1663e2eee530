#include "render/scene_builder.h"
#include "resolve/resolve.h"

#include <glint/measure/settings.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

namespace glint::measure {
namespace {

using compiler::EmissiveLights;

// Returns a floor under as many lamps of two triangles, without any other light.
gltf::Scene sceneOfLamps(int lamps) {
    gltf::Scene scene = testing::emptyScene();
    materials::Material floor;
    floor["metallicFactor"] = 0.0F;
    materials::Material lamp = floor;
    lamp["emissiveFactor"] = {1.0F, 1.0F, 1.0F};
    const int floorMesh = testing::addMesh(
        scene, testing::makeQuad(testing::addMaterial(scene, floor), {-4, -1, 0}, {8, 0, 0}, {0, 0, -8}));
    testing::addInstance(scene, floorMesh);
    const int mesh = testing::addMesh(
        scene, testing::makeQuad(testing::addMaterial(scene, lamp), {0, 1, -2}, {1, 0, 0}, {0, 0, 1}));
    for (int i = 0; i < lamps; ++i) {
        testing::addInstance(scene, mesh);
    }
    return scene;
}

// Returns the values of --lights that a bench tries besides `auto`.
std::vector<std::string> lightsToTry(const gltf::Scene& scene, EmissiveLights emissive) {
    compiler::Settings settings;
    settings.compile.emissiveLights = emissive;
    settings.sun = compiler::Sun::On;
    const Result<compiler::Build> build =
        resolve(std::span(&scene, 1), settings, {.tracers = package::kAllTracers});
    const compiler::BenchFacts facts = factsOf(*build);
    const std::vector<Setting> tried = settingsFor(facts, compiler::configurationOf(settings), false);
    std::vector<std::string> values = std::ranges::find(tried, "lights", &Setting::name)->values;
    std::erase(values, "auto");
    return values;
}

TEST(RenderSettings, TheBenchChoosesOfEmissiveTriangles) {
    const gltf::Scene few = sceneOfLamps(2);
    EXPECT_EQ(lightsToTry(few, EmissiveLights::On), (std::vector<std::string>{"all", "1", "2"}));
    EXPECT_EQ(lightsToTry(few, EmissiveLights::Off), std::vector<std::string>{});
    EXPECT_EQ(lightsToTry(few, EmissiveLights::Auto), std::vector<std::string>{}) << "of one bounce";
    EXPECT_EQ(lightsToTry(sceneOfLamps(128), EmissiveLights::On),
              (std::vector<std::string>{"all", "1", "2", "4", "8", "16", "32", "64"}));
}

}  // namespace
}  // namespace glint::measure
