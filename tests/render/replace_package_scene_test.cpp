// Tests which packages a renderer takes over, and what its scene keeps of the values before.
#include "context/commands.h"
#include "render/edited_scene.h"
#include "render/pixel_test.h"
#include "render/replacement.h"
#include "render/scene_builder.h"
#include "support/must.h"

#include <glint/session/material_source.h>
#include <glint/session/scene_view.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

// The room, with a feature that no material had: records of materials are longer.
gltf::Scene extendedRoom() {
    gltf::Scene scene = roomScene();
    scene.materials[kGlossy].give("KHR_materials_specular");
    scene.materials[kGlossy]["specularFactor"] = 0.25F;
    return scene;
}

class ReplacePackageScene : public ReplacementTest {
protected:
    void SetUp() override {
        setup_ = defaultSetup(before_, 24, 24);
    }

    const gltf::Scene before_ = roomScene();
};

TEST_F(ReplacePackageScene, ErrorsKeepThePackageBefore) {
    const compiler::CompileSettings uber = roomSettings(package::kStrategyUber);
    const std::shared_ptr<const Package> original = packageOf(before_, uber);
    const std::unique_ptr<GpuScene> scene = uploadScene(*original, before_);
    const RendererOptions options = optionsOf(package::kStrategyUber);
    const std::unique_ptr<Renderer> renderer = makeRenderer(*original, *scene, options);
    const LinearImage old = draw(*renderer);
    const auto expectError = [&](const std::shared_ptr<const Package>& package, const char* id,
                                 bool isForEditable = false) {
        const Result<Renderer::Replacement> replaced = renderer->replacePackage(package);
        ASSERT_FALSE(replaced) << id;
        EXPECT_EQ(replaced.error().id, id) << toString(replaced.error());
        EXPECT_EQ(replaced.error().hint.find("editable") != std::string::npos, isForEditable)
            << toString(replaced.error());
        EXPECT_FALSE(renderer->replacementProgress().pending) << id;
    };
    expectError(packageOf(before_, roomSettings(package::kStrategyVisibility)), "package-strategy");
    gltf::Scene fewer = roomScene();
    fewer.meshes[1].primitives.pop_back();
    expectError(packageOf(fewer, uber), "scene-package");
    gltf::Scene seen = roomScene();
    seen.materials[kGlossy].doubleSided = true;
    expectError(packageOf(seen, uber), "scene-package", true);
    gltf::Scene textured = roomScene();
    textured.materials[kGlossy].texture("baseColorTexture").texture =
        addTexture(textured, 1, 1, {255, 255, 255, 255});
    expectError(packageOf(textured, uber), "scene-package");
    compiler::CompileSettings map = uber;
    map.environmentMap = true;
    expectError(packageOf(before_, map), "package-frame");
    expectEqualImage(draw(*renderer), old, "after errors");
    EXPECT_EQ(renderer->replacementProgress().inUse, 0U);
}

// A package with a fallback knows other features of what emits light, because lamps may be added. The scene's
// emissive triangles are the same.
TEST_F(ReplacePackageScene, AFallbackLeavesEmissiveTrianglesAsTheyAre) {
    gltf::Scene lamps = roomScene();
    lamps.materials[kGlossy]["emissiveFactor"] = {1.0F, 1.0F, 1.0F};
    compiler::CompileSettings settings = roomSettings(package::kStrategyVisibility);
    settings.tracers = tracerOfDevice();
    settings.plan.merge = compiler::MergePolicy::All;
    settings.effects = {false, compiler::builtinEffects({"shadow", "reflection"})};
    settings.emissiveLights = compiler::EmissiveLights::On;
    const std::shared_ptr<const Package> original = packageOf(lamps, settings);
    settings.plan.fallback = true;
    const std::shared_ptr<const Package> extended = packageOf(lamps, settings);
    ASSERT_NE(original->emission(), nullptr);
    EXPECT_NE(original->emission()->sometimes, extended->emission()->sometimes);
    const std::unique_ptr<GpuScene> scene = uploadScene(*original, lamps);
    const std::unique_ptr<Renderer> renderer =
        makeRenderer(*original, *scene, optionsOf(package::kStrategyVisibility));
    const Result<Renderer::Replacement> replaced = renderer->replacePackage(extended);
    EXPECT_TRUE(replaced) << toString(replaced.error());
}

// A masked leaf whose left half is opaque, above a mirror: without rays nothing is tested. UVs keep clear of
// the border, so that the states of all triangles are known.
gltf::Scene maskedRoom() {
    gltf::Scene scene = sceneWithCamera();
    addDirectionalLight(scene, {0.0F, -0.6F, -0.8F}, 2.0F);
    materials::Material leaf = paint(kGreen);
    leaf.alphaMode = materials::AlphaMode::Mask;
    leaf.texture("baseColorTexture").texture =
        addTexture(scene, 2, 1, {255, 255, 255, 255, 255, 255, 255, 100});
    const int mask = addMaterial(scene, leaf);
    for (const float left : {0.1F, 0.6F}) {
        gltf::Primitive quad = makeQuad(mask, {left - 0.8F, -0.5F, -2}, {0.4F, 0, 0}, {0, 1, 0});
        for (gltf::Float2& uv : quad.texCoords0) {
            uv[0] = left + 0.3F * uv[0];
        }
        addInstance(scene, addMesh(scene, quad));
    }
    addQuad(scene, mirrorMaterial(), {-4, -1, 0}, {8, 0, 0}, {0, 0, -8});
    return scene;
}

// What the upload has proved about triangles holds for a package with the same alpha only.
TEST_F(ReplacePackageScene, TheAlphaOfDecidedTrianglesStays) {
    compiler::CompileSettings uber = roomSettings(package::kStrategyUber);
    uber.plan.keys.alpha = package::AlphaPolicy::Stochastic;
    const std::shared_ptr<const Package> original = packageOf(maskedRoom(), uber);
    ASSERT_NE(original, nullptr);
    const RendererOptions options = optionsOf(package::kStrategyUber);
    struct Edit {
        const char* what;
        bool isRefused;
        void (*change)(materials::Material& leaf);
    };
    const Edit edits[] = {
        {"nothing", false, [](materials::Material&) {}},
        {"the colour", false, [](materials::Material& leaf) { leaf["baseColorFactor"][0] = 0.7F; }},
        {"the cutoff", true, [](materials::Material& leaf) { leaf["alphaCutoff"] = 0.3F; }},
        {"the factor", true, [](materials::Material& leaf) { leaf["baseColorFactor"][3] = 0.9F; }},
        {"the transform", true,
         [](materials::Material& leaf) {
             leaf.texture("baseColorTexture").transform.offset = {0.5F, 0.0F};
         }},
    };
    const gltf::Scene still = maskedRoom();
    for (const SceneView::OpacityUse use : {SceneView::OpacityUse::Proved, SceneView::OpacityUse::Tested}) {
        const auto scene = uploadScene(*original, still, [use](SceneView& view) { view.opacity = use; });
        const bool isDecided = use == SceneView::OpacityUse::Proved;
        EXPECT_EQ(scene->statistics().provedOpaque, isDecided ? 2U : 0U);
        EXPECT_EQ(scene->statistics().provedTransparent, isDecided ? 2U : 0U);
        for (const Edit& edit : edits) {
            gltf::Scene edited = maskedRoom();
            edit.change(edited.materials[0]);
            const std::shared_ptr<const Package> package = packageOf(edited, uber);
            const std::unique_ptr<Renderer> renderer = makeRenderer(*original, *scene, options);
            ASSERT_TRUE(package != nullptr && renderer != nullptr);
            const Result<Renderer::Replacement> replaced = renderer->replacePackage(package);
            if (!isDecided || !edit.isRefused) {
                EXPECT_TRUE(replaced) << edit.what << ": " << toString(replaced.error());
                continue;
            }
            ASSERT_FALSE(replaced) << edit.what;
            EXPECT_EQ(replaced.error().id, "scene-package") << edit.what;
            EXPECT_NE(replaced.error().message.find("proved"), std::string::npos)
                << edit.what << ": " << toString(replaced.error());
        }
    }
}

// Materials that no edit has touched are those of the new package, also where they need an alpha test or are
// double-sided now: the records and the TLAS say so.
TEST_F(ReplacePackageScene, AnEditableSceneTakesThePackagesMaterials) {
    const compiler::CompileSettings uber = roomSettings(package::kStrategyUber);
    gltf::Scene changed = extendedRoom();
    changed.materials[2].doubleSided = true;
    std::swap(changed.meshes[1].primitives[0].material, changed.meshes[1].primitives[2].material);
    changed.materials.push_back(paint(kRed));
    const std::shared_ptr<const Package> original = packageOf(before_, uber);
    const std::shared_ptr<const Package> extended = packageOf(changed, uber);
    ASSERT_GT(extended->scene(0).materials.recordBytes, original->scene(0).materials.recordBytes);
    const auto scene = uploadScene(*original, before_, [](SceneView& view) { view.editable = true; });
    const RendererOptions options = optionsOf(package::kStrategyUber);
    const std::unique_ptr<Renderer> renderer = makeRenderer(*original, *scene, options);
    draw(*renderer);
    const Renderer::Replacement replaced = must(renderer->replacePackage(extended));
    expectEqualImage(draw(*renderer), fresh(changed, *extended, options), "the package's materials");
    ASSERT_TRUE(renderer->replacePackage(original));
    expectEqualImage(draw(*renderer), fresh(before_, *original, options), "the first package again");
}

// A material that an edit has replaced stays, if the package has a shader for it. Otherwise everything stays.
TEST_F(ReplacePackageScene, AnEditedMaterialNeedsAShader) {
    const compiler::CompileSettings uber = roomSettings(package::kStrategyUber);
    const std::shared_ptr<const Package> original = packageOf(before_, uber);
    const auto scene = uploadScene(*original, before_, [](SceneView& view) { view.editable = true; });
    const RendererOptions options = optionsOf(package::kStrategyUber);
    const std::unique_ptr<Renderer> renderer = makeRenderer(*original, *scene, options);
    gltf::Scene coated = roomScene();
    giveCoat(coated.materials[kGlossy]);
    const session::MaterialSourceData source = session::makeMaterialSource(
        *original, session::recordLayoutOf(*original, coated.materials[0].model()), coated,
        coated.materials[kGlossy], {});
    SceneEditor& editor = *scene->editor();
    ASSERT_TRUE(editor.setMaterial(editor.material(kGlossy), source.view()));
    const LinearImage before = draw(*renderer);
    // The room without a coat, and one whose coat comes with a sheen.
    gltf::Scene bare = roomScene();
    bare.materials[2] = paint(kGreen);
    gltf::Scene both = roomScene();
    giveSheen(both.materials[2]);
    const std::pair<const gltf::Scene*, const char*> refused[] = {{&bare, "scene-edit-feature"},
                                                                  {&both, "scene-edit-case"}};
    for (const auto& [room, id] : refused) {
        const Result<Renderer::Replacement> replaced = renderer->replacePackage(packageOf(*room, uber));
        ASSERT_FALSE(replaced) << id;
        EXPECT_EQ(replaced.error().id, id) << toString(replaced.error());
        EXPECT_NE(replaced.error().message.find("clearcoat"), std::string::npos)
            << toString(replaced.error());
        expectEqualImage(draw(*renderer), before, "after the error");
    }
    const std::shared_ptr<const Package> fallback =
        packageOf(both, roomSettings(package::kStrategyUber, true));
    const Renderer::Replacement replaced = must(renderer->replacePackage(fallback));
    ASSERT_EQ(replaced.missing.size(), 1U);
    EXPECT_EQ(replaced.missing.front().material, editor.material(kGlossy));
    EXPECT_TRUE(differ(draw(*renderer), before)) << "the other wall has a sheen";
}

// A scene that is edited, with a renderer, beside the scene that it should be by now.
class EditedRoom {
public:
    EditedRoom(const gltf::Scene& scene, const std::shared_ptr<const Package>& package,
               const RendererOptions& options)
        : present(scene),
          package_(package),
          scene_(uploadScene(*package, scene, [](SceneView& view) { view.editable = true; })),
          renderer_(makeRenderer(*package, *scene_, options)) {}

    // Gives the room's material of this number the one that `present` has.
    void setMaterial(std::uint32_t number) {
        const materials::Material& material = present.materials[number];
        const session::MaterialSourceData source = session::makeMaterialSource(
            *package_, session::recordLayoutOf(*package_, material.model()), present, material,
            session::uploadedTextures(editor(), package_->scene(0), present));
        const Result<SceneEditor::Report> set =
            editor().setMaterial(editor().material(number), source.view());
        EXPECT_TRUE(set) << toString(set.error());
    }
    void replacePackage(const std::shared_ptr<const Package>& package) {
        const Result<Renderer::Replacement> replaced = renderer_->replacePackage(package);
        ASSERT_TRUE(replaced) << toString(replaced.error());
        package_ = package;
    }
    // Records the edits that wait.
    Renderer& renderer() {
        const Status recorded = runOnce(
            sharedContext().state(), [&](VkCommandBuffer commands) { return editor().record(commands, 0); });
        EXPECT_TRUE(recorded) << (recorded ? "" : toString(recorded.error()));
        return *renderer_;
    }
    SceneEditor& editor() {
        return *scene_->editor();
    }

    gltf::Scene present;

private:
    std::shared_ptr<const Package> package_;
    std::unique_ptr<GpuScene> scene_;
    std::unique_ptr<Renderer> renderer_;
};

compiler::CompileSettings shadowSettings() {
    compiler::CompileSettings settings = roomSettings(package::kStrategyUber);
    settings.tracers = tracerOfDevice();
    settings.plan.merge = compiler::MergePolicy::All;
    settings.effects = {false, compiler::builtinEffects({"shadow", "reflection"})};
    return settings;
}

// The upload knew of no emissive lights. The texture of one material and what an edit has made of another are
// lights by the new package, and none by the first.
TEST_F(ReplacePackageScene, AnEditedSceneGainsAndLosesEmissiveLights) {
    gltf::Scene lamps = roomScene();
    materials::Material& lamp = lamps.materials[kGlossy];
    lamp["emissiveFactor"] = {3.0F, 2.0F, 1.0F};
    lamp.texture("emissiveTexture").texture = addTexture(lamps, 2, 1, {255, 255, 255, 255, 0, 0, 0, 255});
    const RendererOptions options = optionsOf(package::kStrategyUber);
    compiler::CompileSettings dark = shadowSettings();
    dark.emissiveLights = compiler::EmissiveLights::Off;
    for (const std::uint32_t samples : {0U, 2U}) {
        compiler::CompileSettings lit = shadowSettings();
        lit.emissiveLights = compiler::EmissiveLights::On;
        lit.lightSamples = samples;
        const std::shared_ptr<const Package> original = packageOf(lamps, dark);
        const std::shared_ptr<const Package> withLights = packageOf(lamps, lit);
        ASSERT_TRUE(original->emission() == nullptr && withLights->emission() != nullptr);
        EditedRoom room(lamps, original, options);
        room.present.materials[2] = lamp;
        room.present.materials[2]["emissiveFactor"] = {0.5F, 1.0F, 4.0F};
        room.setMaterial(2);
        const LinearImage before = draw(room.renderer());
        for (int round = 0; round < 2; ++round) {
            room.replacePackage(withLights);
            expectSameImage(draw(room.renderer()),
                            fresh(room.present, *packageOf(room.present, lit), options), "with lights");
            room.replacePackage(original);
            expectEqualImage(draw(room.renderer()), before, "without lights");
        }
    }
}

// What edits have made of materials holds for every policy of alpha and of glass in shadows.
TEST_F(ReplacePackageScene, EditedMaterialsFollowAnotherPolicyOfAlphaAndGlass) {
    gltf::Scene panes = roomScene();
    materials::Material masked = paint(kRed);
    masked.alphaMode = materials::AlphaMode::Mask;
    masked.texture("baseColorTexture").texture =
        addTexture(panes, 2, 1, {255, 255, 255, 255, 255, 255, 255, 100});
    materials::Material blended = masked;
    blended.alphaMode = materials::AlphaMode::Blend;
    materials::Material glass = paint({0.9F, 0.4F, 0.2F}, 0.0F);
    glass.give("KHR_materials_transmission");
    glass["transmissionFactor"] = 1.0F;
    std::vector<std::uint32_t> kinds;
    float x = -1.5F;
    for (const materials::Material& material : {masked, blended, glass, paint(kBlue)}) {
        kinds.push_back(static_cast<std::uint32_t>(addMaterial(panes, material)));
        addQuad(panes, static_cast<int>(kinds.back()), {x, -0.6F, -2.5F}, {0.7F, 0, 0}, {0, 1.2F, 0.2F});
        x += 0.8F;
    }
    std::vector<std::shared_ptr<const Package>> packages;
    std::vector<compiler::CompileSettings> policies;
    for (const auto& [alpha, through] :
         {std::pair(package::AlphaPolicy::Opaque, package::ShadowThrough::Alpha),
          std::pair(package::AlphaPolicy::Tested, package::ShadowThrough::Glass),
          std::pair(package::AlphaPolicy::Stochastic, package::ShadowThrough::Glass),
          std::pair(package::AlphaPolicy::Stochastic, package::ShadowThrough::Alpha)}) {
        policies.push_back(shadowSettings());
        policies.back().plan.keys.alpha = alpha;
        policies.back().shadowThrough = through;
        packages.push_back(packageOf(panes, policies.back()));
    }
    const RendererOptions options = optionsOf(package::kStrategyUber);
    EditedRoom room(panes, packages.front(), options);
    const std::vector<materials::Material> all{masked, blended, glass, paint(kBlue)};
    for (std::size_t round = 0; round < packages.size() + 1; ++round) {
        const std::size_t policy = round % packages.size();
        const std::string what = "policy " + std::to_string(policy);
        if (round > 0) {
            room.replacePackage(packages[policy]);
            expectSameImage(draw(room.renderer()),
                            fresh(room.present, *packageOf(room.present, policies[policy]), options), what);
        }
        // Each pane becomes another one.
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            room.present.materials[kinds[i]] = all[(i + round + 1) % all.size()];
            room.setMaterial(kinds[i]);
        }
        expectSameImage(draw(room.renderer()),
                        fresh(room.present, *packageOf(room.present, policies[policy]), options),
                        what + ", other panes");
    }
}

// Materials exchange their textures, one is read by another sampler, and one no longer.
TEST_F(ReplacePackageScene, AnEditedSceneTakesOtherTexturesOfTheUpload) {
    const compiler::CompileSettings uber = roomSettings(package::kStrategyUber);
    gltf::Scene pictures = roomScene();
    std::vector<int> textures;
    for (const std::uint8_t shade : std::array<std::uint8_t, 3>{20, 120, 220}) {
        textures.push_back(addTexture(pictures, 2, 1, {255, shade, 40, 255, 40, shade, 255, 255}));
        pictures.materials[textures.size()].texture("baseColorTexture").texture = textures.back();
    }
    const std::shared_ptr<const Package> original = packageOf(pictures, uber);
    const RendererOptions options = optionsOf(package::kStrategyUber);
    EditedRoom room(pictures, original, options);
    const LinearImage before = draw(room.renderer());
    room.present.materials[1].texture("baseColorTexture").texture = textures[2];
    room.present.materials[3].texture("baseColorTexture").texture = textures[0];
    room.present.materials[2].texture("baseColorTexture").texture = textures[0];
    room.present.samplers[static_cast<std::size_t>(room.present.textures[2].sampler)] = gltf::Sampler{};
    const std::shared_ptr<const Package> exchanged = packageOf(room.present, uber);
    ASSERT_LT(exchanged->scene(0).textures.size(), original->scene(0).textures.size());
    room.replacePackage(exchanged);
    const LinearImage after = draw(room.renderer());
    EXPECT_TRUE(differ(after, before));
    expectEqualImage(after, fresh(room.present, *exchanged, options), "other textures");
    room.replacePackage(original);
    expectEqualImage(draw(room.renderer()), before, "the first package again");
}

// A material that an edit has removed, because nothing had it, returns with a package that gives it to a
// wall.
TEST_F(ReplacePackageScene, AMaterialReturnsThatAnEditHasRemoved) {
    const compiler::CompileSettings uber = roomSettings(package::kStrategyUber);
    gltf::Scene spare = roomScene();
    const int added = addMaterial(spare, paint({0.9F, 0.8F, 0.1F}));
    const std::shared_ptr<const Package> original = packageOf(spare, uber);
    const RendererOptions options = optionsOf(package::kStrategyUber);
    EditedRoom room(spare, original, options);
    ASSERT_TRUE(room.editor().removeMaterial(room.editor().material(static_cast<std::uint32_t>(added))));
    const LinearImage before = draw(room.renderer());
    room.present.meshes[1].primitives[0].material = added;
    const std::shared_ptr<const Package> golden = packageOf(room.present, uber);
    room.replacePackage(golden);
    expectEqualImage(draw(room.renderer()), fresh(room.present, *golden, options), "it is there again");
    EXPECT_NE(room.editor().material(static_cast<std::uint32_t>(added)).generation, 0U);
    room.replacePackage(original);
    expectEqualImage(draw(room.renderer()), before, "the first package again");
}

TEST_F(ReplacePackageScene, AllRenderersOfTheSceneSwitch) {
    const compiler::CompileSettings uber = roomSettings(package::kStrategyUber);
    const std::shared_ptr<const Package> original = packageOf(before_, uber);
    // Its records of materials have another size, so that they move to another buffer.
    const std::shared_ptr<const Package> extended = packageOf(extendedRoom(), uber);
    ASSERT_GT(extended->scene(0).materials.recordBytes, original->scene(0).materials.recordBytes);
    const std::unique_ptr<GpuScene> scene = uploadScene(*original, before_);
    const RendererOptions options = optionsOf(package::kStrategyUber);
    const std::unique_ptr<Renderer> renderer = makeRenderer(*original, *scene, options);
    const std::unique_ptr<Renderer> other = makeRenderer(*original, *scene, options);
    ASSERT_TRUE(renderer->replacePackage(extended));
    draw(*other);
    const LinearImage image = draw(*renderer);
    expectEqualImage(image, fresh(extendedRoom(), *extended, options), "longer records");
    expectEqualImage(draw(*other), image, "the other renderer");
    EXPECT_EQ(mustFail(Renderer::create(sharedContext(), *original, *scene, options)).id, "scene-package");
    const std::unique_ptr<Renderer> anew = makeRenderer(*extended, *scene, options);
    ASSERT_NE(anew, nullptr);
    expectEqualImage(draw(*anew), image, "made anew");
}

// The hierarchy of lights is part of a scene, whichever package it was uploaded with.
TEST_F(ReplacePackageScene, RenderersOfASceneChooseLightsDifferently) {
    gltf::Scene room = before_;
    for (const float x : {-0.5F, 0.7F}) {
        gltf::Light light;
        light.type = gltf::LightType::Point;
        light.position = {x, 0.5F, -1.5F};
        room.lights.push_back(light);
    }
    compiler::CompileSettings settings = roomSettings(package::kStrategyUber);
    settings.lightSamples = 0;
    const std::shared_ptr<const Package> all = packageOf(room, settings);
    settings.lightSamples = 1;
    const std::shared_ptr<const Package> one = packageOf(room, settings);
    const std::unique_ptr<GpuScene> scene = uploadScene(*all, room);
    const RendererOptions options = optionsOf(package::kStrategyUber);
    const std::unique_ptr<Renderer> weighing = makeRenderer(*all, *scene, options);
    const std::unique_ptr<Renderer> choosing = makeRenderer(*one, *scene, options);
    ASSERT_NE(choosing, nullptr);
    const LinearImage before = draw(*weighing);
    expectEqualImage(draw(*choosing), fresh(room, *one, options), "chosen by the hierarchy");
    expectEqualImage(draw(*weighing), before, "all of them");
}

// Values that the host has given stay, also in longer records, and the material's other values are the new
// package's.
TEST_F(ReplacePackageScene, ValuesOfTheHostStay) {
    const compiler::CompileSettings uber = roomSettings(package::kStrategyUber);
    const std::shared_ptr<const Package> original = packageOf(before_, uber);
    gltf::Scene both = extendedRoom();
    both.materials[2]["baseColorFactor"] = {0.2F, 0.9F, 0.2F, 1.0F};
    const std::shared_ptr<const Package> repainted = packageOf(both, uber);
    const MaterialTable table = original->scene(0).materials;
    ASSERT_GT(repainted->scene(0).materials.recordBytes, table.recordBytes);
    const std::vector<std::uint8_t> kept(table.part(2, 1).bytes.begin(), table.part(2, 1).bytes.end());
    const MaterialView views[] = {{2, kept}};
    const std::shared_ptr<const Package> wanted = packageOf(extendedRoom(), uber);
    const RendererOptions options = optionsOf(package::kStrategyUber);
    for (const bool editable : {false, true}) {
        const auto scene = uploadScene(*original, before_, [&](SceneView& view) {
            view.materials = views;
            view.editable = editable;
        });
        const std::unique_ptr<Renderer> renderer = makeRenderer(*original, *scene, options);
        ASSERT_TRUE(renderer->replacePackage(repainted));
        expectEqualImage(draw(*renderer), fresh(extendedRoom(), *wanted, options), "the host's colour");
    }
}

}  // namespace
