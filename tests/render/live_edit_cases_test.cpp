// Tests edits that are refused, materials without a case, buffers that grow, and other strategies.
#include "render/edited_scene.h"
#include "render/moving_scenes.h"
#include "render/scene_builder.h"
#include "scene/scene_store.h"
#include "support/must.h"

#include <glint/steps.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace glint::testing {
namespace {

template <typename T>
void expectError(const Result<T>& result, const std::string& id, const std::string& part = "") {
    ASSERT_FALSE(result) << id;
    EXPECT_EQ(result.error().id, id) << toString(result.error());
    EXPECT_NE(result.error().message.find(part), std::string::npos) << toString(result.error());
}

// A material whose parts have cases of their own, but which has none.
materials::Material coatedTexture() {
    materials::Material material = catalogueScene().materials[2];
    material.texture("baseColorTexture").texture = 0;
    return material;
}

// Draws the first two instances, the second with that material, with a package that was compiled for it.
LinearImage pictureWithCoatedTexture(const EditedScene& edited, const EditedSceneOptions& options) {
    gltf::Scene known = catalogueScene();
    known.materials[2] = coatedTexture();
    known.meshes[kKinds + 3].primitives[0].material = 2;
    const LoadedScene loaded(known, options.settings, [&](session::SceneViewData& data) {
        data.instances[0].objectToWorld = edited.instances[0].objectToWorld;
        data.instances[kKinds + 3].objectToWorld = edited.instances[1].objectToWorld;
        for (std::size_t i = 0; i < data.instances.size(); ++i) {
            data.instances[i].visible = i == 0 || i == kKinds + 3;
        }
    });
    return loaded.render(options.renderer, defaultSetup(known, options.width, options.height));
}

class LiveEditErrors : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        edited_ = new EditedScene(EditedSceneOptions());
    }
    static void TearDownTestSuite() {
        delete edited_;
    }
    void SetUp() override {}
    SceneEditor& editor() {
        return edited_->editor();
    }
    static inline EditedScene* edited_ = nullptr;
};

TEST_F(LiveEditErrors, HandlesThatNameNothing) {
    EXPECT_EQ(editor().mesh(999).generation, 0U);
    EXPECT_EQ(editor().material(999).generation, 0U);
    expectError(editor().replaceTexture({}, edited_->textures[0].view()), "scene-edit-handle", "texture");
    expectError(editor().removeTexture({}), "scene-edit-handle");
    expectError(editor().setMaterialValues({}, {}), "scene-edit-handle", "material");
    expectError(editor().setMaterial({}, {}), "scene-edit-handle");
    expectError(editor().removeMaterial({}), "scene-edit-handle");
    expectError(editor().setMeshMaterial({}, 0, edited_->materials[0].handle), "scene-edit-handle", "mesh");
    expectError(editor().setMeshMaterial(edited_->meshes[0].handle, 0, {}), "scene-edit-handle");
    expectError(editor().removeMesh({}), "scene-edit-handle");
    expectError(editor().addInstance({}), "scene-edit-handle");
    expectError(editor().moveInstance({}, {}), "scene-edit-handle", "instance");
    expectError(editor().showInstance({}, true), "scene-edit-handle");
    expectError(editor().setInstanceMesh(edited_->instances[0].handle, {}), "scene-edit-handle");
    expectError(editor().setInstanceMaterial({}, 0, {}), "scene-edit-handle");
    expectError(editor().removeInstance({}), "scene-edit-handle");
    expectError(editor().setLight({}, {}), "scene-edit-handle", "light");
    expectError(editor().removeLight({}), "scene-edit-handle");
    // A handle of what was removed does not name what took its place.
    const LightHandle first = must(editor().addLight({}));
    ASSERT_TRUE(editor().removeLight(first));
    const LightHandle second = must(editor().addLight({}));
    EXPECT_EQ(first.index, second.index);
    expectError(editor().removeLight(first), "scene-edit-handle");
    ASSERT_TRUE(editor().removeLight(second));
    edited_->expectSameAsFresh("nothing has changed");
}

TEST_F(LiveEditErrors, WhatIsInUseStays) {
    expectError(editor().removeMesh(edited_->meshes[0].handle), "scene-edit-used", "1 instances");
    expectError(editor().removeMaterial(edited_->materials[0].handle), "scene-edit-used");
    expectError(editor().removeTexture(edited_->textures[0].handle), "scene-edit-used", "1 materials");
}

TEST_F(LiveEditErrors, Values) {
    const InstanceHandle instance = edited_->instances[0].handle;
    std::array<float, 12> rows = edited_->instances[0].objectToWorld;
    rows[3] = INFINITY;
    expectError(editor().moveInstance(instance, rows), "scene-edit-value", "finite");
    expectError(editor().addInstance({edited_->meshes[0].handle, rows}), "scene-edit-value", "finite");
    const MaterialHandle three[3]{};
    expectError(editor().setInstanceMesh(instance, edited_->meshes[0].handle, three), "scene-edit-value",
                "3 materials for 1");
    expectError(editor().setInstanceMaterial(instance, 1, {}), "scene-edit-value");
    expectError(editor().setMeshMaterial(edited_->meshes[0].handle, 1, edited_->materials[0].handle),
                "scene-edit-value");
    const std::vector<std::uint8_t> tooShort(4);
    expectError(editor().setMaterialValues(edited_->materials[0].handle, tooShort), "scene-edit-value");
    session::MaterialSourceData source = edited_->source(3);
    source.textures[0].slot = 99;
    expectError(editor().addMaterial(source.view()), "scene-edit-value", "slot");
    source = edited_->source(3);
    source.textures.push_back(source.textures[0]);
    expectError(editor().addMaterial(source.view()), "scene-edit-value", "two textures");
    expectError(editor().addMesh({}), "scene-edit-value");
    SceneEditor::EditedPrimitive primitive{edited_->primitive(0, 0), edited_->materials[1].handle};
    primitive.geometry.indices = {};
    expectError(editor().addMesh(std::span(&primitive, 1)), "scene-edit-value", "no triangle");
    LightView light;
    light.size = -1;
    expectError(editor().addLight(light), "scene-light");
    LightView disk;
    disk.type = LightView::Type::Disk;
    expectError(editor().addLight(disk), "scene-light");
    light.size = NAN;
    expectError(editor().setLight(edited_->lights[0].handle, light), "scene-light");
    expectError(editor().addTexture({}, true), "scene-image");
    expectError(editor().replaceTexture(edited_->textures[0].handle, {}), "scene-image");
}

// Another image might need what the package lacks.
TEST(LiveEditTextures, ATrustedTextureIsNotReplaced) {
    EditedSceneOptions options;
    options.trustsTextures = true;
    EditedScene edited(std::move(options));
    EXPECT_TRUE(edited.package().trustTextures());
    expectError(edited.editor().replaceTexture(edited.editor().texture(0), edited.textures[0].view()),
                "texture-trusted");
}

TEST_F(LiveEditErrors, Geometry) {
    SceneEditor::EditedPrimitive primitive{edited_->primitive(0, 0), edited_->materials[1].handle};
    const std::uint32_t outside[] = {0, 1, 99};
    primitive.geometry.indices = outside;
    expectError(editor().addMesh(std::span(&primitive, 1)), "scene-index");
    primitive.geometry = edited_->primitive(0, 0);
    primitive.geometry.normals = primitive.geometry.normals.first(2);
    expectError(editor().addMesh(std::span(&primitive, 1)), "scene-attribute");
    primitive.geometry = edited_->primitive(0, 0);
    const std::array<float, 3> difference{};
    PrimitiveView::MorphTarget target;
    target.positions = std::span(&difference, 1);
    primitive.geometry.targets = std::span(&target, 1);
    expectError(editor().addMesh(std::span(&primitive, 1)), "scene-attribute");
    // The package has no pass that moves vertices.
    const std::vector<std::array<float, 3>> differences(primitive.geometry.positions.size());
    target.positions = differences;
    const SceneEditor::AddedMesh mesh = must(editor().addMesh(std::span(&primitive, 1)));
    SceneEditor::PlacedMesh placed{mesh.mesh};
    const std::array<float, 2> weights{1, 1};
    placed.morphWeights = weights;
    expectError(editor().addInstance(placed), "scene-motion");
    placed.morphWeights = std::span(weights).first(1);
    expectError(editor().addInstance(placed), "scene-package");
    EXPECT_TRUE(editor().removeMesh(mesh.mesh));
}

// An engine's cloth: the vertices of a mesh change in place, and its normals with them.
TEST(LiveEditVertices, ChangeInPlace) {
    EditedSceneOptions options;
    EditedScene edited(options);
    SceneEditor& editor = edited.editor();
    const PrimitiveView flat = edited.primitive(1, 0);
    const SceneEditor::EditedPrimitive primitive{flat, edited.materials[1].handle};
    const SceneEditor::AddedMesh mesh =
        must(editor.addMesh(std::span(&primitive, 1), SceneEditor::MeshUse::Changing));
    const std::array<float, 12> rows{1, 0, 0, -0.6F, 0, 1, 0, 0, 0, 0, 1, -2.2F};
    const SceneEditor::AddedInstance cloth = must(editor.addInstance({mesh.mesh, rows}));
    const LinearImage before = edited.picture();
    std::vector<std::array<float, 3>> positions(flat.positions.begin(), flat.positions.end());
    for (int step = 1; step <= 3; ++step) {
        for (std::array<float, 3>& position : positions) {
            position[2] += 0.1F * position[0];
            position[1] *= 1.1F;
        }
        ASSERT_TRUE(editor.setVertices(mesh.mesh, 0, {positions, flat.normals}));
        edited.frame();
    }
    const LinearImage after = edited.picture();
    EXPECT_NE(before.pixels, after.pixels);
    // The same vertices in a mesh of their own.
    PrimitiveView bent = flat;
    bent.positions = positions;
    const SceneEditor::EditedPrimitive other{bent, edited.materials[1].handle};
    const SceneEditor::AddedMesh fresh =
        must(editor.addMesh(std::span(&other, 1), SceneEditor::MeshUse::Changing));
    ASSERT_TRUE(editor.setInstanceMesh(cloth.instance, fresh.mesh));
    EXPECT_EQ(edited.picture().pixels, after.pixels);
    expectError(editor.setVertices(edited.meshes[0].handle, 0, {positions}), "scene-edit-value");
    positions.pop_back();
    expectError(editor.setVertices(mesh.mesh, 0, {positions}), "scene-edit-value");
    positions.push_back({NAN, 0, 0});
    expectError(editor.setVertices(mesh.mesh, 0, {positions}), "scene-edit-value");
    EXPECT_TRUE(editor.removeMesh(mesh.mesh));
    edited.frame();
    edited.drain();
}

TEST_F(LiveEditErrors, Keys) {
    session::MaterialSourceData source = edited_->source(3);
    source.keys = {source.keys.front()};
    const MaterialHandle added = must(editor().addMaterial(source.view()));
    const SceneEditor::EditedPrimitive primitive{edited_->primitive(0, 0), added};
    expectError(editor().addMesh(std::span(&primitive, 1)), "scene-edit-key", "no key");
    ASSERT_TRUE(editor().removeMaterial(added));
    // A key that reads what it says is not there.
    source = edited_->source(3);
    source.keys.back().attributes = 0;
    expectError(editor().addMaterial(source.view()), "scene-edit-key", "texCoord0");
}

TEST_F(LiveEditErrors, Rooms) {
    std::vector<TextureHandle> added;
    for (;;) {
        const Result<TextureHandle> texture = editor().addTexture(edited_->textures[0].view(), false);
        if (!texture) {
            expectError(texture, "scene-edit-room");
            break;
        }
        added.push_back(*texture);
    }
    EXPECT_EQ(added.size() + edited_->textures.size(), SceneView{}.textureRoom);
    for (const TextureHandle texture : added) {
        ASSERT_TRUE(editor().removeTexture(texture));
    }
    session::MaterialSourceData source = edited_->source(3);
    std::vector<MaterialHandle> materials;
    for (std::uint32_t i = 0; i < 9 * 8; ++i) {
        source.textures[0].sampler = {i % 3, i / 3 % 3, i / 9 % 2, i / 18 % 2, i / 36, 1};
        const Result<MaterialHandle> material = editor().addMaterial(source.view());
        if (!material) {
            expectError(material, "scene-edit-room", "samplers");
            break;
        }
        materials.push_back(*material);
    }
    EXPECT_LE(materials.size(), SceneView{}.samplerRoom);
    for (const MaterialHandle material : materials) {
        ASSERT_TRUE(editor().removeMaterial(material));
    }
    edited_->expectSameAsFresh("rooms were full and are empty again");
}

TEST_F(LiveEditErrors, Frames) {
    edited_->frame();
    edited_->drain();
    expectError(editor().record(VK_NULL_HANDLE, 0), "scene-edit-frame");
}

TEST_F(LiveEditErrors, AKeyWithoutACase) {
    edited_->scene.materials[2] = coatedTexture();
    const session::MaterialSourceData source = edited_->source(2);
    edited_->scene.materials[2] = catalogueScene().materials[2];
    const MaterialHandle added = must(editor().addMaterial(source.view()));
    const SceneEditor::EditedPrimitive primitive{edited_->primitive(0, 0), added};
    expectError(editor().addMesh(std::span(&primitive, 1)), "scene-edit-case", "baseColorTexture");
    expectError(editor().setInstanceMaterial(edited_->instances[0].handle, 0, added), "scene-edit-case",
                "clearcoat");
    expectError(editor().setMeshMaterial(edited_->meshes[0].handle, 0, added), "scene-edit-case");
    expectError(editor().setMaterial(edited_->materials[0].handle, source.view()), "scene-edit-case");
    ASSERT_TRUE(editor().removeMaterial(added));
    // No material of the package has this one.
    materials::Material sheen = catalogueScene().materials[1];
    sheen.give("KHR_materials_sheen");
    sheen["sheenColorFactor"] = {0.5F, 0.5F, 0.5F};
    edited_->scene.materials[1] = sheen;
    const session::MaterialSourceData unknown = edited_->source(1);
    edited_->scene.materials[1] = catalogueScene().materials[1];
    expectError(editor().setMaterial(edited_->materials[0].handle, unknown.view()), "scene-edit-feature",
                "sheen");
    edited_->expectSameAsFresh("nothing has changed");
}

// A case that decides at run time allows keys that no primitive of the package has.
TEST(LiveEditKeys, ACaseForSeveralKeysShadesTheKeysBetweenThem) {
    EditedSceneOptions options;
    options.settings.plan.merge = compiler::MergePolicy::All;
    EditedScene edited(options);
    edited.scene.materials[2] = coatedTexture();
    const session::MaterialSourceData source = edited.source(2);
    const MaterialHandle added = must(edited.editor().addMaterial(source.view()));
    const SceneEditor::Report report =
        must(edited.editor().setInstanceMaterial(edited.instances[1].handle, 0, added));
    EXPECT_TRUE(report.missing.empty());
    expectSameImage(edited.picture(), pictureWithCoatedTexture(edited, options), "a key between others");
}

// A scene that is edited takes poses, too. Only materials that read a texture use it.
TEST(LiveEditUpload, AnEditableSceneTakesPoses) {
    const gltf::Scene scene = catalogueScene();
    const EditedSceneOptions options;
    const LoadedScene loaded(scene, options.settings);
    session::SceneViewData data = session::makeSceneView(scene);
    SceneView view = data.view();
    view.editable = true;
    EXPECT_EQ(loaded.gpuScene().editor(), nullptr);
    const auto editable = uploadScene(loaded.package(), view);
    ASSERT_NE(editable, nullptr);
    EXPECT_TRUE(EngineScene::share(sharedContext(), *editable));
    expectError(editable->editor()->removeTexture(editable->editor()->texture(0)), "scene-edit-used",
                "1 materials");
    for (std::size_t i = 0; i < data.instances.size(); ++i) {
        data.instances[i].objectToWorld[3] += 0.1F * static_cast<float>(i);
        data.instances[i].objectToWorld[11] -= 2.0F;
    }
    ASSERT_TRUE(editable->updateAndWait(data.motion()));
    const RenderSetup setup = defaultSetup(scene, options.width, options.height);
    RendererOptions renderer = options.renderer;
    renderer.width = options.width;
    renderer.height = options.height;
    const auto posed = uploadScene(loaded.package(), data.view());
    EXPECT_EQ(drawn(*makeRenderer(loaded.package(), *editable, renderer), setup.frame).pixels,
              drawn(*makeRenderer(loaded.package(), *posed, renderer), setup.frame).pixels);
}

TEST(LiveEditFallback, ShadesAndReportsKeysWithoutACase) {
    EditedSceneOptions options;
    options.settings.plan.fallback = true;
    EditedScene edited(options);
    const LinearImage before = edited.picture();
    edited.scene.materials[2] = coatedTexture();
    const session::MaterialSourceData source = edited.source(2);
    const MaterialHandle added = must(edited.editor().addMaterial(source.view()));
    const SceneEditor::Report report =
        must(edited.editor().setInstanceMaterial(edited.instances[1].handle, 0, added));
    ASSERT_EQ(report.missing.size(), 1U);
    const SceneEditor::Report::MissingCase& missing = report.missing.front();
    EXPECT_EQ(missing.material, added);
    EXPECT_NE(std::ranges::find(missing.names, "clearcoat"), missing.names.end());
    EXPECT_NE(std::ranges::find(missing.names, "baseColorTexture"), missing.names.end());
    EXPECT_EQ(edited.package().featureNames(missing.features), missing.names);
    const LinearImage after = edited.picture();
    EXPECT_NE(before.pixels, after.pixels);
    // A package that has a case for it shows the same, up to the rounding of other shaders.
    expectSameImage(after, pictureWithCoatedTexture(edited, options), "with a case");
}

TEST(LiveEditFallback, ASceneWithoutContentOfThePackage) {
    const gltf::Scene scene = catalogueScene();
    const LoadedScene loaded(scene, EditedSceneOptions().settings);
    SceneView view;
    view.editable = true;
    view.packageScene = kNoPackageScene;
    const auto empty = uploadScene(loaded.package(), view);
    ASSERT_NE(empty, nullptr);
    EXPECT_EQ(empty->statistics().instances, 0U);
    EXPECT_EQ(empty->editor()->material(0).generation, 0U);
}

// Adds many of everything in one frame, so that every buffer grows, and removes them again.
TEST(LiveEditGrowth, EveryBufferGrowsAndShrinks) {
    EditedSceneOptions options;
    options.settings.lightSamples = 2;
    EditedScene edited(options);
    SceneEditor& editor = edited.editor();
    const SceneStore& state = *edited.gpuScene().state().store;
    edited.expectSameAsFresh("before");
    const auto capacities = [&] {
        return std::array{state.geometries.capacity, state.instances.capacity,  state.materials.capacity,
                          state.lights.capacity,     state.lightNodes.capacity, state.tlasCapacity};
    };
    const auto first = capacities();
    const std::uint64_t allocated = edited.gpuScene().allocatedBytes();
    constexpr std::size_t kMany = 40;
    for (std::size_t i = 0; i < kMany; ++i) {
        const auto kind = static_cast<std::uint32_t>(i % kKinds);
        const MaterialHandle material = must(editor.addMaterial(edited.source(kind).view()));
        edited.materials.push_back({material, kind, false});
        const SceneEditor::EditedPrimitive primitive{edited.primitive(1, 0), material};
        const SceneEditor::AddedMesh mesh = must(editor.addMesh(std::span(&primitive, 1)));
        edited.meshes.push_back({mesh.mesh, 1, {edited.materials.size() - 1}, false});
        const float x = static_cast<float>(i % 8) * 0.5F - 2.0F;
        const float y = static_cast<float>(i / 8) * 0.4F - 0.8F;
        const std::array<float, 12> rows{0.3F, 0, 0, x, 0, 0.3F, 0, y, 0, 0, 0.3F, -2.0F - 0.01F * x};
        const SceneEditor::AddedInstance instance = must(editor.addInstance({mesh.mesh, rows}));
        edited.instances.push_back({instance.instance, edited.meshes.size() - 1, {}, rows, true, false});
        LightView light;
        light.type = LightView::Type::Point;
        light.position = {x, y + 1.0F, -1.0F};
        light.intensity = {0.1F, 0.1F, 0.2F};
        const LightHandle added = must(editor.addLight(light));
        edited.lights.push_back({added, light, false});
    }
    edited.frame();
    const auto grown = capacities();
    for (std::size_t i = 0; i < grown.size(); ++i) {
        EXPECT_GT(grown[i], first[i]) << i;
    }
    edited.expectSameAsFresh("grown");
    while (edited.instances.size() > 2) {
        ASSERT_TRUE(editor.removeInstance(edited.instances.back().handle));
        ASSERT_TRUE(editor.removeMesh(edited.meshes.back().handle));
        ASSERT_TRUE(editor.removeMaterial(edited.materials.back().handle));
        ASSERT_TRUE(editor.removeLight(edited.lights.back().handle));
        edited.instances.pop_back();
        edited.meshes.pop_back();
        edited.materials.pop_back();
        edited.lights.pop_back();
    }
    edited.frame();
    EXPECT_EQ(capacities(), grown) << "buffers shrink only after trim()";
    edited.drain();
    editor.trim();
    edited.frame();
    EXPECT_EQ(capacities(), first);
    edited.expectSameAsFresh("shrunk");
    EXPECT_EQ(edited.gpuScene().allocatedBytes(), allocated);
}

// The shader binding table and the buckets serve any content.
TEST(LiveEditStrategies, OtherStrategiesFollowEdits) {
    for (const package::Strategy strategy : {package::kStrategyVisibility, package::kStrategyHitShaders}) {
        const package::Tracer tracer =
            strategy == package::kStrategyHitShaders ? package::kTracerRayPipeline : package::kTracerRayQuery;
        if ((sharedContext().handles().tracers & tracer) == 0) {
            continue;
        }
        EditedScene edited(EditedSceneOptions(strategy, tracer));
        edited.expectSameAsFresh("as uploaded");
        const SceneEditor::Report report = must(
            edited.editor().setInstanceMaterial(edited.instances[1].handle, 0, edited.materials[5].handle));
        edited.instances[1].materials = {5};
        edited.expectSameAsFresh("a variant");
        ASSERT_TRUE(edited.editor().removeInstance(edited.instances[0].handle));
        edited.instances.erase(edited.instances.begin());
        edited.expectSameAsFresh("without the floor");
    }
}

}  // namespace
}  // namespace glint::testing
