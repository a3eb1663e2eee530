// Tests hierarchy, transforms, cameras and lights.
#include "support/must.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glint::test {
namespace {

Result<gltf::Scene> importMembers(const std::string& members) {
    return importText(R"({"asset": {"version": "2.0"}, )" + members + "}");
}

gltf::Scene mustImport(const std::string& members) {
    return must(importMembers(members));
}

std::string errorId(const std::string& members) {
    const Result<gltf::Scene> scene = importMembers(members);
    return scene ? "imported" : scene.error().id;
}

void expectNear(const gltf::Matrix4& actual, const gltf::Matrix4& expected) {
    for (std::size_t i = 0; i < actual.size(); ++i) {
        EXPECT_NEAR(actual[i], expected[i], 1e-12) << "element " << i;
    }
}

TEST(GltfNodes, ComposesTransforms) {
    // The top is turned by 90 degrees about Z, then moved; the child is mirrored and stretched.
    const gltf::Scene scene = mustImport(R"("nodes": [
        {"name": "top", "translation": [1, 2, 3], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476],
         "children": [1]},
        {"name": "low", "translation": [10, 0, 0], "scale": [-2, 3, 0]}])");
    ASSERT_EQ(scene.nodes.size(), 2U);
    EXPECT_EQ(scene.nodes[0].parent, -1);
    EXPECT_EQ(scene.nodes[1].parent, 0);
    EXPECT_EQ(scene.nodes[1].name, "low");
    expectNear(scene.nodes[0].world, {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1});
    expectNear(scene.nodes[1].world, {0, -2, 0, 0, -3, 0, 0, 0, 0, 0, 0, 0, 1, 12, 3, 1});
}

TEST(GltfNodes, ReadsMatrices) {
    const gltf::Scene scene = mustImport(R"("nodes": [
        {"matrix": [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 10, 0, 11, 12, 13, 1]},
        {"matrix": [1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2], "scale": [2, 2, 2]}])");
    expectNear(scene.nodes.at(0).world, {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 10, 0, 11, 12, 13, 1});
    expectNear(scene.nodes.at(1).world, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    EXPECT_EQ(countWarnings(scene, "node-matrix"), 3U) << "the first one shears, too";
}

TEST(GltfNodes, TakesTheDefaultScene) {
    const std::string nodes = R"("nodes": [{"name": "a"}, {"name": "b", "children": [2]}, {"name": "c"}])";
    const gltf::Scene second =
        mustImport(nodes + R"(, "scene": 1, "scenes": [{"nodes": [0]}, {"nodes": [1]}])");
    ASSERT_EQ(second.nodes.size(), 2U);
    EXPECT_EQ(second.nodes[0].name, "b");
    EXPECT_EQ(second.nodes[1].name, "c");
    EXPECT_EQ(mustImport(nodes + R"(, "scenes": [{"nodes": [0]}, {"nodes": [1]}])").nodes.at(0).name, "a");
    EXPECT_EQ(mustImport(nodes).nodes.size(), 3U);
    EXPECT_EQ(mustImport(nodes + R"(, "scenes": [{}])").nodes.size(), 0U);
    EXPECT_EQ(errorId(nodes + R"(, "scene": 1, "scenes": [{}])"), "index-range");
}

TEST(GltfNodes, TakesTheSceneThatIsAskedFor) {
    const std::string members = R"("nodes": [{"name": "a"}, {"name": "b"}, {"name": "c"}, {"name": "d"}],
        "scenes": [{"name": "First", "nodes": [0]}, {"nodes": [1]}, {"name": "Room", "nodes": [2]},
                   {"name": "1", "nodes": [3]}])";
    const auto read = [&](const std::string& scene, const std::string& more = "") {
        return importText(R"({"asset": {"version": "2.0"}, )" + members + more + "}", {.scene = scene});
    };
    const auto drawn = [&](const std::string& scene, const std::string& more = "") {
        const Result<gltf::Scene> result = read(scene, more);
        return result ? result->nodes.at(0).name : toString(result.error());
    };
    EXPECT_EQ(drawn(""), "a");
    EXPECT_EQ(drawn("", R"(, "scene": 2)"), "c");
    EXPECT_EQ(drawn("0", R"(, "scene": 2)"), "a");
    EXPECT_EQ(drawn("Room"), "c");
    EXPECT_EQ(drawn("1"), "b");  // a number comes before a name
    const gltf::Scene room = must(read("Room"));
    EXPECT_EQ(room.sceneInFile, 2);
    EXPECT_EQ(room.scenesInFile, (std::vector<std::string>{"First", "", "Room", "1"}));
    // Only a choice that the file leaves open is worth a note.
    EXPECT_EQ(findWarning(*read(""), "scene-choice").message,
              "the file names none of its 4 scenes as the default; scene 0 \"First\" is read");
    EXPECT_EQ(countWarnings(*read("", R"(, "scene": 0)"), "scene-choice"), 0U);
    EXPECT_EQ(countWarnings(room, "scene-choice"), 0U);

    for (const char* const wrong : {"4", "-1", "Roon", "2x", "18446744073709551616"}) {
        const Result<gltf::Scene> refused = read(wrong);
        ASSERT_FALSE(refused) << wrong;
        EXPECT_EQ(refused.error().id, "scene-unknown");
        EXPECT_NE(refused.error().message.find("it has 0 \"First\", 1, 2 \"Room\", 3 \"1\""),
                  std::string::npos)
            << refused.error().message;
    }
    EXPECT_NE(read("Roon").error().message.find("did you mean Room?"), std::string::npos);
    EXPECT_EQ(mustFail(importText(R"({"asset": {"version": "2.0"}, "nodes": [{}]})", {.scene = "0"})).id,
              "scene-unknown");
}

TEST(GltfNodes, DrawsEachNodeOnce) {
    const gltf::Scene scene = mustImport(R"("nodes": [{"children": [1]}, {}],
        "scenes": [{"nodes": [0, 1, 0]}])");
    EXPECT_EQ(scene.nodes.size(), 2U);
    EXPECT_EQ(countWarnings(scene, "scene-node-child"), 1U);
    EXPECT_EQ(countWarnings(scene, "scene-node-repeated"), 1U);
    EXPECT_EQ(mustImport(R"("nodes": [{"children": [1]}, {"children": [2]}, {}],
        "scenes": [{"nodes": [2, 1, 0]}])")
                  .nodes.size(),
              3U);
}

// A listed child keeps its global transform, and nothing else of the nodes above it is drawn.
TEST(GltfNodes, PlaceListedChildrenByTheirAncestors) {
    const gltf::Scene scene = mustImport(R"("nodes": [
            {"name": "root", "translation": [1, 0, 0], "children": [1, 4], "mesh": 0, "camera": 0},
            {"name": "middle", "scale": [2, 2, 2], "children": [2, 3]},
            {"name": "drawn", "translation": [0, 1, 0], "children": [5], "mesh": 0},
            {"name": "drawn, too", "mesh": 0},
            {"name": "not listed", "mesh": 0},
            {"name": "below", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3"}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
        "scenes": [{"nodes": [2, 3]}])");
    std::vector<std::string> names;
    for (const gltf::Node& node : scene.nodes) {
        names.push_back(node.name);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"root", "middle", "drawn", "below", "drawn, too"}));
    expectNear(scene.nodes.at(2).world, {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 2, 0, 1});
    EXPECT_EQ(scene.nodes.at(0).mesh, -1);
    EXPECT_EQ(scene.nodes.at(1).mesh, -1);
    EXPECT_EQ(scene.nodes.at(2).mesh, 0);
    EXPECT_EQ(scene.nodes.at(3).mesh, 0);
    EXPECT_TRUE(scene.cameras.empty());
    EXPECT_EQ(countWarnings(scene, "scene-node-child"), 2U);
    EXPECT_EQ(findWarning(scene, "scene-node-child").message,
              "names /nodes/2, a child of /nodes/1, which the scene does not have; it is drawn with the "
              "transforms of the nodes above it");

    // A hidden ancestor hides what is below it.
    const gltf::Scene hidden = mustImport(R"("extensionsUsed": ["KHR_node_visibility"], "nodes": [
            {"children": [1], "extensions": {"KHR_node_visibility": {"visible": false}}}, {}],
        "scenes": [{"nodes": [1]}])");
    EXPECT_FALSE(hidden.nodes.at(1).shown);
}

TEST(GltfNodes, RefusesGraphsThatAreNoForest) {
    EXPECT_EQ(errorId(R"("nodes": [{"children": [0]}])"), "node-cycle");
    EXPECT_EQ(errorId(R"("nodes": [{"children": [1]}, {"children": [2]}, {"children": [0]}])"), "node-cycle");
    EXPECT_EQ(errorId(R"("nodes": [{"children": [2]}, {"children": [2]}, {}])"), "node-parents");
    EXPECT_EQ(errorId(R"("nodes": [{"children": [1, 1]}, {}])"), "node-parents");
    EXPECT_EQ(errorId(R"("nodes": [{"children": [-1]}])"), "index-range");
    EXPECT_EQ(errorId(R"("nodes": [{"children": [1.5]}])"), "json-type");
    EXPECT_EQ(errorId(R"("nodes": [{"scale": [1e30, 1, 1], "children": [1]}, {"scale": [1e30, 1, 1]}])"),
              "node-transform");
}

TEST(GltfNodes, FollowsDeepHierarchies) {
    constexpr int kDepth = 20000;
    Json nodes = Json::array();
    for (int i = 0; i < kDepth; ++i) {
        nodes.push_back({{"translation", {0, 1, 0}}});
        if (i + 1 < kDepth) {
            nodes.back()["children"] = Json::array({i + 1});
        }
    }
    const gltf::Scene scene = mustImport("\"nodes\": " + nodes.dump());
    ASSERT_EQ(scene.nodes.size(), static_cast<std::size_t>(kDepth));
    EXPECT_EQ(scene.nodes.back().world[13], kDepth);
}

TEST(GltfNodes, NormalizesRotations) {
    const gltf::Scene scene =
        mustImport(R"("nodes": [{"rotation": [0, 0, 0, 2]}, {"rotation": [0, 0, 0, 0]}])");
    expectNear(scene.nodes.at(0).world, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    expectNear(scene.nodes.at(1).world, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    EXPECT_EQ(countWarnings(scene, "node-rotation"), 2U);
}

TEST(GltfCameras, ArePlacedWithoutScale) {
    const gltf::Scene scene = mustImport(R"(
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}},
                    {"name": "flat", "type": "orthographic",
                     "orthographic": {"xmag": 2, "ymag": -3, "znear": 0, "zfar": 10}}],
        "nodes": [{"camera": 0, "scale": [-2, 2, 3], "translation": [1, 2, 3]}, {"camera": 1}, {}])");
    ASSERT_EQ(scene.cameras.size(), 2U);
    EXPECT_EQ(scene.nodes[0].camera, 0);
    EXPECT_EQ(scene.nodes[2].camera, -1);
    EXPECT_FALSE(scene.cameras[0].orthographic);
    EXPECT_EQ(scene.cameras[0].yfov, 0.5);
    EXPECT_EQ(scene.cameras[0].zfar, 0.0);
    expectNear(scene.cameras[0].world, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1});
    EXPECT_TRUE(scene.cameras[1].orthographic);
    EXPECT_EQ(scene.cameras[1].name, "flat");
    EXPECT_EQ(scene.cameras[1].xmag, 2.0);
    EXPECT_EQ(scene.cameras[1].ymag, 3.0);
    EXPECT_EQ(scene.cameras[1].zfar, 10.0);
    EXPECT_EQ(countWarnings(scene, "camera-range"), 1U);
}

TEST(GltfCameras, AreChecked) {
    const auto perspective = [](const std::string& values) {
        return errorId(R"("nodes": [{"camera": 0}], "cameras": [{"type": "perspective", "perspective": )" +
                       values + "}]");
    };
    EXPECT_EQ(perspective(R"({"yfov": 1, "znear": 1, "zfar": 2})"), "imported");
    EXPECT_EQ(perspective(R"({"yfov": 0, "znear": 1})"), "camera-range");
    EXPECT_EQ(perspective(R"({"yfov": 4, "znear": 1})"), "camera-range");
    EXPECT_EQ(perspective(R"({"yfov": 1, "znear": 0})"), "camera-range");
    EXPECT_EQ(perspective(R"({"yfov": 1, "znear": 1, "zfar": 1})"), "camera-range");
    EXPECT_EQ(perspective(R"({"yfov": 1, "znear": 1, "zfar": 0})"), "camera-range");
    EXPECT_EQ(perspective(R"({"yfov": 1})"), "json-missing");
    EXPECT_EQ(errorId(R"("cameras": [{"type": "fisheye"}])"), "camera-type");
    EXPECT_EQ(errorId(R"("cameras": [{"type": "orthographic"}])"), "json-missing");
    EXPECT_EQ(errorId(R"("nodes": [{"camera": 0}], "cameras": [{"type": "orthographic",
        "orthographic": {"xmag": 0, "ymag": 1, "znear": 0, "zfar": 1}}])"),
              "camera-range");
}

TEST(GltfCameras, SurviveZeroScale) {
    const gltf::Scene scene = mustImport(R"(
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
        "nodes": [{"camera": 0, "scale": [0, 0, 0], "translation": [1, 2, 3]}])");
    expectNear(scene.cameras.at(0).world, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1});
    EXPECT_EQ(countWarnings(scene, "pose-degenerate"), 1U);
}

std::string withLight(const std::string& light, const std::string& node = "") {
    return R"("extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [)" +
           light + R"(]}}, "nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}})" + node + "}]";
}

TEST(GltfLights, ArePlaced) {
    const gltf::Scene scene = mustImport(withLight(
        R"({"name": "lamp", "type": "spot", "color": [1, 0.5, 0.25], "intensity": 20, "range": 7,
            "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}})",
        R"(, "translation": [1, 2, 3], "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476],
            "scale": [1, 1, 5])"));
    ASSERT_EQ(scene.lights.size(), 1U);
    const gltf::Light& light = scene.lights[0];
    EXPECT_EQ(scene.nodes.at(0).light, 0);
    EXPECT_EQ(light.name, "lamp");
    EXPECT_EQ(light.type, gltf::LightType::Spot);
    EXPECT_EQ(light.color, (gltf::Float3{1.0F, 0.5F, 0.25F}));
    EXPECT_EQ(light.intensity, 20.0F);
    EXPECT_EQ(light.range, 7.0F);
    EXPECT_EQ(light.innerConeAngle, 0.25F);
    EXPECT_EQ(light.outerConeAngle, 0.5F);
    EXPECT_EQ(light.position, (std::array<double, 3>{1, 2, 3}));
    // A quarter turn about Y takes -Z to -X.
    EXPECT_NEAR(light.direction[0], -1.0F, 1e-6F);
    EXPECT_NEAR(light.direction[1], 0.0F, 1e-6F);
    EXPECT_NEAR(light.direction[2], 0.0F, 1e-6F);
}

TEST(GltfLights, HaveTheExtensionsDefaults) {
    const gltf::Scene scene = mustImport(withLight(R"({"type": "spot"})"));
    const gltf::Light& light = scene.lights.at(0);
    EXPECT_EQ(light.color, (gltf::Float3{1, 1, 1}));
    EXPECT_EQ(light.intensity, 1.0F);
    EXPECT_EQ(light.range, 0.0F);
    EXPECT_EQ(light.innerConeAngle, 0.0F);
    EXPECT_FLOAT_EQ(light.outerConeAngle, std::numbers::pi_v<float> / 4);
    EXPECT_EQ(light.direction, (gltf::Float3{0, 0, -1}));
}

TEST(GltfLights, AreChecked) {
    const gltf::Scene scene = mustImport(withLight(R"({"type": "spot", "intensity": -1, "color": [-1, 0, 0],
        "spot": {"innerConeAngle": 3, "outerConeAngle": 2}})",
                                                   R"(, "scale": [0, 0, 0])"));
    EXPECT_EQ(scene.lights.at(0).intensity, 0.0F);
    EXPECT_LE(scene.lights.at(0).innerConeAngle, scene.lights.at(0).outerConeAngle);
    EXPECT_EQ(countWarnings(scene, "light-range"), 4U);
    EXPECT_EQ(countWarnings(scene, "pose-degenerate"), 1U);
    EXPECT_EQ(scene.lights.at(0).direction, (gltf::Float3{0, 0, -1}));
    EXPECT_EQ(errorId(withLight(R"({"type": "laser"})")), "light-type");
    EXPECT_EQ(errorId(withLight(R"({})")), "json-missing");
    EXPECT_EQ(errorId(withLight("")), "index-range");
}

TEST(GltfLights, WarnOfWhatTheExtensionForbids) {
    const auto lightAndWarnings = [](const std::string& members) {
        const gltf::Scene scene = mustImport(withLight(R"({"type": "spot", )" + members + "}"));
        return std::pair(scene.lights.at(0), countWarnings(scene, "light-range"));
    };
    const auto [unlimited, rangeWarnings] = lightAndWarnings(R"("spot": {}, "range": 0)");
    EXPECT_EQ(unlimited.range, 0.0F);
    EXPECT_EQ(rangeWarnings, 1U);
    EXPECT_EQ(lightAndWarnings(R"("spot": {}, "range": -3)").first.range, 0.0F);
    EXPECT_EQ(lightAndWarnings(R"("spot": {}, "range": 0.5)").second, 0U);
    // The hue is unchanged.
    const auto [bright, colorWarnings] = lightAndWarnings(R"("spot": {}, "color": [1, 2, 4])");
    EXPECT_EQ(bright.color, (gltf::Float3{1, 2, 4}));
    EXPECT_EQ(colorWarnings, 2U);
    const auto [sharp, coneWarnings] =
        lightAndWarnings(R"("spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.5})");
    EXPECT_EQ(sharp.innerConeAngle, sharp.outerConeAngle);
    EXPECT_EQ(coneWarnings, 1U);
    EXPECT_EQ(lightAndWarnings(R"("spot": {"innerConeAngle": 0.4, "outerConeAngle": 0.5})").second, 0U);
}

}  // namespace
}  // namespace glint::test
