#include "render/replacement.h"

#include "render/pixel_test.h"
#include "render/scene_builder.h"
#include "resolve/resolve.h"
#include "support/must.h"
#include "support/shared_modules.h"

#include <glint/session/scene_view.h>
#include <glint/session/session.h>

#include <utility>

namespace glint::testing {

compiler::CompileSettings roomSettings(std::uint32_t strategies, bool fallback) {
    compiler::CompileSettings settings;
    settings.strategies = strategies;
    settings.tracers = package::kAllTracers;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.plan.fallback = fallback;
    settings.effects = {false, compiler::builtinEffects({"reflection"})};
    return settings;
}

void giveCoat(materials::Material& material) {
    material.give("KHR_materials_clearcoat");
    material["clearcoatFactor"] = 1.0F;
    material["clearcoatRoughnessFactor"] = 0.1F;
}

void giveSheen(materials::Material& material) {
    material.give("KHR_materials_sheen");
    material["sheenColorFactor"] = {0.9F, 0.4F, 0.1F};
    material["sheenRoughnessFactor"] = 0.5F;
}

gltf::Scene roomScene() {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, mirrorMaterial(), {-4, -1, 0}, {8, 0, 0}, {0, 0, -8});
    materials::Material coated = paint(kGreen);
    giveCoat(coated);
    materials::Material sheen = paint(kBlue);
    giveSheen(sheen);
    gltf::Mesh walls;
    float x = -4.0F;
    for (const materials::Material& material : {paint(kRed), coated, sheen, unlitMaterial(kGreen)}) {
        walls.primitives.push_back(
            makeQuad(addMaterial(scene, material), {x, -0.9F, -5.0F}, {2, 0, 0}, {0, 4, 0}));
        x += 2.0F;
    }
    scene.meshes.push_back(walls);
    addInstance(scene, static_cast<int>(scene.meshes.size()) - 1);
    addDirectionalLight(scene, {0.0F, -0.6F, -0.8F}, 2.0F);
    return scene;
}

gltf::Scene repaintedRoom() {
    gltf::Scene scene = roomScene();
    scene.materials[kGlossy]["baseColorFactor"] = {0.1F, 0.8F, 0.9F, 1.0F};
    return scene;
}

void expectEqualImage(const LinearImage& image, const LinearImage& reference, const std::string& what) {
    ASSERT_EQ(image.pixels.size(), reference.pixels.size()) << what;
    std::size_t others = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        others += image.pixels[i] == reference.pixels[i] ? 0 : 1;
    }
    EXPECT_EQ(others, 0U) << what;
}

std::shared_ptr<const Package> packageOf(const gltf::Scene& scene,
                                         const compiler::CompileSettings& settings) {
    return must(
        session::compileAndLoad(*compiler::resolve(std::span(&scene, 1), settings), &sharedModules()));
}

RendererOptions ReplacementTest::optionsOf(package::Strategy strategy,
                                           std::optional<package::Tracer> tracer) const {
    RendererOptions options;
    options.width = setup_.width;
    options.height = setup_.height;
    options.strategy = strategy;
    options.tracer = tracer;
    return options;
}

LinearImage ReplacementTest::draw(Renderer& renderer) const {
    return drawn(renderer, setup_.frame, setup_.samples);
}

LinearImage ReplacementTest::fresh(const gltf::Scene& scene, const Package& package,
                                   const RendererOptions& options) const {
    const std::unique_ptr<GpuScene> uploaded = uploadScene(package, scene);
    return draw(*makeRenderer(package, *uploaded, options));
}

}  // namespace glint::testing
