// Tests what edits make of a scene. tests/cli/edits_test.cpp tests what a device makes of it.
#include "support/must.h"

#include <glint/session/edits.h>
#include <glint/session/scene_view.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace glint::session {
namespace {

// "Root" has "Arm" and "Lamp" below it. "Body" has a mesh that follows the two joints "Root" and "Arm", which
// an animation turns. "Shelf" comes last.
gltf::Scene editedRoom() {
    gltf::Scene scene;
    const std::pair<const char*, int> nodes[] = {
        {"Root", -1}, {"Arm", 0}, {"Lamp", 0}, {"Body", -1}, {"Shelf", -1}};
    for (const auto& [name, parent] : nodes) {
        gltf::Node& node = scene.nodes.emplace_back();
        node.name = name;
        node.parent = parent;
        node.source = static_cast<int>(scene.nodes.size()) - 1;
    }
    scene.nodes[0].rest.translation = {1, 0, 0};
    scene.nodes[1].rest.translation = {0, 2, 0};
    scene.nodes[2].light = 0;
    scene.lights.resize(1);
    scene.lights[0].type = gltf::LightType::Point;
    scene.nodes[3].mesh = 0;
    scene.nodes[3].skin = 0;
    scene.materials.resize(2);
    scene.materials[1].name = "Red";
    gltf::Mesh& mesh = scene.meshes.emplace_back();
    mesh.primitives.resize(2);
    mesh.primitives[1].variantMaterials = {1, 0};
    scene.variants = {"Evening"};
    scene.skins.push_back({"", {0, 1}, std::vector<gltf::Matrix4>(2)});
    gltf::Animation& animation = scene.animations.emplace_back();
    animation.samplers.push_back({gltf::Interpolation::Linear, {0, 1}, 3, {0, 2, 0, 0, 3, 0}});
    animation.channels = {{1, gltf::AnimationPath::Translation, 0}};
    applyPose(restPose(scene), scene);
    return scene;
}

int mustApply(const Edit& edit, gltf::Scene& scene) {
    const Result<int> node = applyEdit(edit, {}, scene);
    EXPECT_TRUE(node.ok()) << (node ? "" : toString(node.error()));
    moveTo(Moment{{0}, 1.0}, scene);
    return node ? *node : 0;
}

gltf::Node& named(gltf::Scene& scene, const std::string& name) {
    return scene.nodes[static_cast<std::size_t>(findNode(scene, name).value_or(0))];
}

TEST(Edits, CopiesFollowTheAnimationWithASkinOfTheirOwn) {
    gltf::Scene scene = editedRoom();
    Edit edit{.kind = EditKind::Duplicate, .node = "Root", .translation = {5, 0, 0}, .name = "Copy"};
    const int copy = mustApply(edit, scene);
    const gltf::Node& arm = scene.nodes[static_cast<std::size_t>(copy) + 1];
    EXPECT_EQ(arm.name, "Arm");
    EXPECT_EQ(arm.parent, copy);
    EXPECT_EQ(arm.world[12], 5.0);
    EXPECT_EQ(arm.world[13], 3.0);
    // The light of the copy is another one, at another place.
    ASSERT_EQ(scene.lights.size(), 2U);
    EXPECT_EQ(scene.lights[1].position[0], 5.0);
    EXPECT_EQ(scene.lights[0].position[0], 1.0);
    // Joints outside of what was copied stay those of the original.
    edit = {.kind = EditKind::Duplicate, .node = "Body"};
    mustApply(edit, scene);
    EXPECT_EQ(named(scene, "Body copy").skin, named(scene, "Body").skin);
    // Numbers of new nodes follow those of the file.
    EXPECT_EQ(nodeLabel(scene, copy), "Copy");
    EXPECT_EQ(nodeLabel(scene, copy + 1), "6");
    EXPECT_EQ(findNode(scene, "6"), copy + 1);
}

TEST(Edits, ANodeGoesBelowOneThatComesLater) {
    gltf::Scene scene = editedRoom();
    mustApply({.kind = EditKind::Move, .node = "Shelf", .translation = {0, 0, 7}}, scene);
    const int moved = mustApply({.kind = EditKind::Parent, .node = "Root", .parent = "Shelf"}, scene);
    EXPECT_EQ(scene.nodes[static_cast<std::size_t>(moved)].world[14], 7.0);
    EXPECT_EQ(findNode(scene, "Root"), moved);
    EXPECT_EQ(named(scene, "Arm").world[13], 3.0);
    EXPECT_EQ(named(scene, "Arm").world[14], 7.0);
    EXPECT_EQ(scene.skins[0].joints, (std::vector<int>{moved, *findNode(scene, "Arm")}));
    EXPECT_EQ(scene.lights[0].position[2], 7.0);
    EXPECT_FALSE(isPresent(scene.nodes[0]));
    EXPECT_FALSE(applyEdit({.kind = EditKind::Parent, .node = "Shelf", .parent = "Arm"}, {}, scene).ok());
}

TEST(Edits, ValuesThatAreSetAreNoLongerAnimated) {
    gltf::Scene scene = editedRoom();
    mustApply({.kind = EditKind::Move, .node = "Arm", .scale = {2, 2, 2}}, scene);
    EXPECT_EQ(named(scene, "Arm").world[13], 3.0);
    mustApply({.kind = EditKind::Move, .node = "Arm", .translation = {0, 4, 0}}, scene);
    EXPECT_EQ(named(scene, "Arm").world[13], 4.0);
    EXPECT_EQ(named(scene, "Arm").world[0], 2.0);
}

TEST(Edits, RemovedNodesLeaveTheirJoints) {
    gltf::Scene scene = editedRoom();
    mustApply({.kind = EditKind::Delete, .node = "Root"}, scene);
    EXPECT_FALSE(findNode(scene, "Root").has_value());
    EXPECT_FALSE(findNode(scene, "Arm").has_value());
    EXPECT_FALSE(findNode(scene, "0").has_value());
    EXPECT_FALSE(scene.lights[0].shines());
    EXPECT_EQ(scene.nodes[1].world[13], 3.0);
}

TEST(Edits, MaterialsStayWithTheirNode) {
    gltf::Scene scene = editedRoom();
    mustApply({.kind = EditKind::Duplicate, .node = "Body", .name = "Twin"}, scene);
    Edit paint{.kind = EditKind::Material, .node = "Twin", .material = "Red"};
    paint.primitive = 0;
    mustApply(paint, scene);
    const int mesh = named(scene, "Twin").mesh;
    EXPECT_EQ(named(scene, "Body").mesh, 0);
    EXPECT_EQ(scene.meshes[static_cast<std::size_t>(mesh)].copyOf, 0);
    EXPECT_EQ(scene.meshes[static_cast<std::size_t>(mesh)].primitives[0].material, 1);
    // A variant changes what no edit has changed.
    mustApply({.kind = EditKind::Variant, .variant = "Evening"}, scene);
    EXPECT_EQ(scene.meshes[0].primitives[0].material, 0);
    EXPECT_EQ(scene.meshes[0].primitives[1].material, 1);
    EXPECT_EQ(scene.meshes[static_cast<std::size_t>(mesh)].primitives[1].material, 1);
    mustApply({.kind = EditKind::Variant}, scene);
    EXPECT_EQ(scene.meshes[0].primitives[1].material, 0);
    // The same choice for another node is the same mesh.
    paint.node = "Body";
    mustApply(paint, scene);
    EXPECT_EQ(named(scene, "Body").mesh, mesh);
}

TEST(Edits, AddedScenesKeepTheirParts) {
    gltf::Scene scene = editedRoom();
    SceneFiles files;
    files["room.glb"] = std::make_shared<const gltf::Scene>(editedRoom());
    const Edit add{.kind = EditKind::Add, .translation = {0, 0, 9}, .name = "Second", .file = "room.glb"};
    const int holder = must(applyEdit(add, files, scene));
    moveTo(Moment{{0, 1}, 1.0}, scene);
    EXPECT_EQ(scene.nodes[static_cast<std::size_t>(holder)].source, 5);
    const gltf::Node& arm = scene.nodes[static_cast<std::size_t>(holder) + 2];
    EXPECT_EQ(arm.name, "Arm");
    EXPECT_EQ(arm.world[13], 3.0);
    EXPECT_EQ(arm.world[14], 9.0);
    const gltf::Node& body = scene.nodes[static_cast<std::size_t>(holder) + 4];
    EXPECT_EQ(body.mesh, 1);
    EXPECT_EQ(scene.skins[static_cast<std::size_t>(body.skin)].joints[0], holder + 1);
    EXPECT_EQ(scene.meshes[1].primitives[1].variantMaterials, (std::vector<int>{3, 2}));
    EXPECT_EQ(scene.variants.size(), 1U);
    EXPECT_EQ(scene.lights[1].position[2], 9.0);
    const Edit missing{.kind = EditKind::Add, .file = "none.glb"};
    EXPECT_EQ(applyEdit(missing, files, scene).error().id, "edit-unknown");
}

TEST(Edits, PlanningHasEveryMaterialOfAPrimitive) {
    const gltf::Scene scene = editedRoom();
    const std::vector<Edit> edits{{.kind = EditKind::Variant, .variant = "Evening"},
                                  {.kind = EditKind::Delete, .node = "Body"}};
    EXPECT_TRUE(needShaders(edits));
    EXPECT_FALSE(needShaders(std::span(edits).subspan(1)));
    const Edit show{.kind = EditKind::Show, .node = "Root"};
    EXPECT_FALSE(needsShaders(show, scene));
    gltf::Scene hidden = editedRoom();
    hidden.nodes[1].canShow = false;
    EXPECT_TRUE(needsShaders(show, hidden));
    const Edit light{.kind = EditKind::Light, .node = "Lamp", .intensity = 2.0};
    EXPECT_TRUE(needsShaders(light, scene));
    hidden.lights[0].canShine = true;
    EXPECT_FALSE(needsShaders(light, hidden));
    const gltf::Scene planned = must(plannedScene(scene, edits, {}));
    ASSERT_EQ(planned.meshes.size(), 2U);
    EXPECT_EQ(planned.meshes[0].primitives[1].material, 1);
    EXPECT_EQ(planned.meshes[1].primitives[1].material, 0);
}

}  // namespace
}  // namespace glint::session
