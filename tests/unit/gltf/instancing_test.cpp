// Tests EXT_mesh_gpu_instancing and KHR_node_visibility: what is read, and how planning sees it.
#include "gltf/motion/transform.h"
#include "support/must.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glint::test {
namespace {

// A triangle whose placements the attributes give.
struct Instanced {
    Instanced() {
        builder.addTriangle();
        builder.root["extensionsUsed"] = Json::array({"EXT_mesh_gpu_instancing"});
        builder.root["extensionsRequired"] = builder.root["extensionsUsed"];
    }
    Json& attributes() {
        return builder.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    }
    gltf::Scene import() {
        return must(test::import(builder));
    }
    std::string errorId() {
        const Result<gltf::Scene> scene = test::import(builder);
        return scene ? "imported" : scene.error().id;
    }
    GltfBuilder builder;
};

TEST(GltfInstancing, ComposesTranslationRotationAndScale) {
    Instanced instanced;
    instanced.attributes()["TRANSLATION"] =
        instanced.builder.addAccessor(std::vector<float>{1, 2, 3, 4, 5, 6}, 3);
    // One rotation is a quarter turn about Z in 16 bits, and the other is none.
    instanced.attributes()["ROTATION"] =
        instanced.builder.addAccessor(std::vector<std::int16_t>{0, 0, 23170, 23170, 0, 0, 0, 32767}, 4, true);
    instanced.attributes()["SCALE"] = instanced.builder.addAccessor(std::vector<float>{2, 3, 4, 1, 1, 1}, 3);
    const gltf::Scene scene = instanced.import();
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.instancings.size(), 1U);
    EXPECT_EQ(scene.nodes.at(0).instancing, 0);
    const gltf::Instancing& instancing = scene.instancings[0];
    ASSERT_EQ(instancing.count, 2U);
    const gltf::Matrix4 first = gltf::instanceTransform(instancing, 0);
    const gltf::Matrix4 expected{0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_NEAR(first[i], expected[i], 1e-4) << i;
    }
    EXPECT_EQ(gltf::instanceTransform(instancing, 1)[13], 5.0);
}

TEST(GltfInstancing, WhatIsLeftOutIsNeutral) {
    Instanced instanced;
    instanced.attributes()["ROTATION"] =
        instanced.builder.addAccessor(std::vector<std::int8_t>{0, 0, 0, 127, 127, 0, 0, 0}, 4, true);
    const gltf::Scene scene = instanced.import();
    ASSERT_EQ(scene.instancings.at(0).count, 2U);
    EXPECT_EQ(gltf::instanceTransform(scene.instancings[0], 0), gltf::identity());
    EXPECT_NEAR(gltf::instanceTransform(scene.instancings[0], 1)[5], -1.0, 1e-6) << "half a turn about X";
}

TEST(GltfInstancing, NotesAttributesOfApplications) {
    Instanced instanced;
    instanced.attributes()["TRANSLATION"] = instanced.builder.addAccessor(std::vector<float>{1, 2, 3}, 3);
    instanced.attributes()["_ID"] = 0;
    instanced.attributes()["_COLOR_0"] = 99;
    const gltf::Scene scene = instanced.import();
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_EQ(scene.warnings[0].severity, Severity::Note);
    EXPECT_EQ(scene.warnings[0].id, "node-instances");
    EXPECT_NE(scene.warnings[0].message.find("_COLOR_0, _ID"), std::string::npos)
        << scene.warnings[0].message;
}

TEST(GltfInstancing, IsChecked) {
    Instanced counts;
    counts.attributes()["TRANSLATION"] = counts.builder.addAccessor(std::vector<float>{1, 2, 3, 4, 5, 6}, 3);
    counts.attributes()["SCALE"] = counts.builder.addAccessor(std::vector<float>{1, 1, 1}, 3);
    EXPECT_EQ(counts.errorId(), "attribute-count");
    Instanced type;
    type.attributes()["TRANSLATION"] = type.builder.addAccessor(std::vector<float>{1, 2}, 2);
    EXPECT_EQ(type.errorId(), "attribute-type");
    Instanced range;
    range.attributes()["TRANSLATION"] = 99;
    EXPECT_EQ(range.errorId(), "index-range");
    Instanced missing;
    missing.builder.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = Json::object();
    EXPECT_EQ(missing.errorId(), "json-missing");
    Instanced far;
    far.attributes()["SCALE"] = far.builder.addAccessor(std::vector<float>{1e38F, 1, 1}, 3);
    far.builder.root["nodes"][0]["scale"] = {1e10, 1, 1};
    EXPECT_EQ(far.errorId(), "node-transform");
    Instanced infinite;
    infinite.attributes()["TRANSLATION"] =
        infinite.builder.addAccessor(std::vector<float>{1, 2, std::numeric_limits<float>::infinity()}, 3);
    EXPECT_EQ(countWarnings(infinite.import(), "attribute-not-finite"), 1U);
}

// 4000 small instances count fully in the shares of hits, although only some of them are examined.
TEST(GltfInstancing, CountsForExpectedHits) {
    Instanced instanced;
    std::vector<float> places;
    for (int i = 0; i < 4000; ++i) {
        places.insert(places.end(), {static_cast<float>(i), 0.0F, 0.0F});
    }
    instanced.attributes()["TRANSLATION"] = instanced.builder.addAccessor(places, 3);
    const double many = planningInputs(instanced.import()).at(0).expectedHits;
    GltfBuilder single;
    single.addTriangle();
    const gltf::Scene one = must(import(single));
    EXPECT_NEAR(many / planningInputs(one).at(0).expectedHits, 4000.0, 1e-6);
}

TEST(GltfVisibility, HidesANodeAndAllBelow) {
    GltfBuilder builder;
    builder.addTriangle();
    builder.root["extensionsUsed"] = Json::array({"KHR_node_visibility", "KHR_lights_punctual"});
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type": "point"}])");
    builder.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    builder.root["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = true;
    builder.root["nodes"].push_back(
        Json::parse(R"({"children": [0], "extensions": {"KHR_node_visibility": {"visible": false}}})"));
    const gltf::Scene scene = must(import(builder));
    EXPECT_TRUE(readingWarnings(scene).empty());
    const gltf::Node& below = scene.nodes.at(1);
    EXPECT_TRUE(below.visible);
    EXPECT_FALSE(below.shown);
    EXPECT_FALSE(below.canShow);
    EXPECT_FALSE(scene.lights.at(0).shines());
    EXPECT_FALSE(scene.lights.at(0).canShine);
    // The default is visible. A value of another type is an error.
    builder.root["nodes"][1]["extensions"]["KHR_node_visibility"] = Json::object();
    EXPECT_TRUE(import(builder)->nodes.at(1).shown);
    builder.root["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = 0;
    EXPECT_EQ(import(builder).error().id, "json-type");
}

}  // namespace
}  // namespace glint::test
