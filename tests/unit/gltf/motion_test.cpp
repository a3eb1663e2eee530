// Tests animations, skins and morph targets: what is read, and the messages about bad ones.
#include "support/must.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glint::test {
namespace {

gltf::Scene importMotion(const GltfBuilder& builder) {
    return must(import(builder));
}

const gltf::Primitive& primitiveOf(const gltf::Scene& scene) {
    return scene.meshes.at(0).primitives.at(0);
}

std::string errorId(const GltfBuilder& builder) {
    const Result<gltf::Scene> scene = import(builder);
    return scene ? "imported" : scene.error().id;
}

// A triangle that an animation with one channel moves.
struct Animated {
    explicit Animated(const std::string& path, const std::vector<float>& times = {0, 1}, int output = -1,
                      int components = 3) {
        builder.addTriangle();
        const int input = builder.addAccessor(times, 1);
        if (output < 0) {
            output = builder.addAccessor(
                std::vector<float>(times.size() * static_cast<std::size_t>(components), 1.0F), components);
        }
        animation = {{"name", "move"},
                     {"samplers", {{{"input", input}, {"output", output}}}},
                     {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}};
    }
    gltf::Scene import() {
        builder.root["animations"] = Json::array({animation});
        return importMotion(builder);
    }
    GltfBuilder builder;
    Json animation;
};

TEST(GltfAnimations, AreRead) {
    Animated animated("translation", {0.5F, 2.0F});
    const gltf::Scene scene = animated.import();
    ASSERT_EQ(scene.animations.size(), 1U);
    const gltf::Animation& animation = scene.animations[0];
    EXPECT_EQ(animation.name, "move");
    EXPECT_EQ(animation.duration, 2.0);
    ASSERT_EQ(animation.channels.size(), 1U);
    EXPECT_EQ(animation.channels[0].path, gltf::AnimationPath::Translation);
    EXPECT_EQ(animation.channels[0].target, 0);
    const gltf::AnimationSampler& sampler = animation.samplers.at(0);
    EXPECT_EQ(sampler.interpolation, gltf::Interpolation::Linear);
    EXPECT_EQ(sampler.width, 3U);
    EXPECT_EQ(sampler.times, (std::vector<float>{0.5F, 2.0F}));
    EXPECT_EQ(sampler.values.size(), 6U);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfAnimations, TakeEveryInterpolationAndIntegers) {
    GltfBuilder builder;
    builder.addTriangle();
    const int input = builder.addAccessor(std::vector<float>{0, 1}, 1);
    const int step = builder.addAccessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, -32768, 0}, 4, true);
    const int spline = builder.addAccessor(std::vector<float>(18, 2.0F), 3);
    builder.root["animations"] = {
        {{"samplers",
          {{{"input", input}, {"output", step}, {"interpolation", "STEP"}},
           {{"input", input}, {"output", spline}, {"interpolation", "CUBICSPLINE"}}}},
         {"channels",
          {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}},
           {{"sampler", 1}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
    const gltf::Scene scene = importMotion(builder);
    const gltf::Animation& animation = scene.animations.at(0);
    ASSERT_EQ(animation.samplers.size(), 2U);
    EXPECT_EQ(animation.samplers[0].interpolation, gltf::Interpolation::Step);
    EXPECT_EQ(animation.samplers[0].values, (std::vector<float>{0, 0, 0, 1, 0, 0, -1, 0}));
    EXPECT_EQ(animation.samplers[1].interpolation, gltf::Interpolation::CubicSpline);
    EXPECT_EQ(animation.samplers[1].values.size(), 18U);
    EXPECT_EQ(animation.channels[1].path, gltf::AnimationPath::Scale);
}

TEST(GltfAnimations, LeaveOutBadKeyframesWithAWarning) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const std::vector<float>& times :
         std::vector<std::vector<float>>{{1, 0}, {1, 1}, {-1, 0}, {0, nan}, {0, INFINITY}}) {
        const gltf::Scene scene = Animated("translation", times).import();
        EXPECT_TRUE(scene.animations.at(0).channels.empty());
        EXPECT_EQ(countWarnings(scene, "animation-keyframes"), 1U) << times[0] << ", " << times[1];
    }
    // There are too few values, values that are not finite, or an unknown interpolation.
    EXPECT_EQ(countWarnings(Animated("rotation").import(), "animation-keyframes"), 1U);
    Animated infinite("translation");
    infinite.animation["samplers"][0]["output"] =
        infinite.builder.addAccessor(std::vector<float>{0, 0, 0, 0, 0, INFINITY}, 3);
    EXPECT_EQ(countWarnings(infinite.import(), "animation-keyframes"), 1U);
    Animated curved("translation");
    curved.animation["samplers"][0]["interpolation"] = "BEZIER";
    EXPECT_EQ(countWarnings(curved.import(), "animation-keyframes"), 1U);
}

TEST(GltfAnimations, LeaveOutChannelsThatDriveNothing) {
    EXPECT_EQ(countWarnings(Animated("colour").import(), "animation-channel"), 1U);
    EXPECT_EQ(countWarnings(Animated("weights").import(), "animation-channel"), 1U) << "no targets";
    Animated beyond("translation");
    beyond.animation["channels"][0]["sampler"] = 1;
    EXPECT_EQ(countWarnings(beyond.import(), "animation-channel"), 1U);
    Animated matrix("translation");
    matrix.builder.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    EXPECT_EQ(countWarnings(matrix.import(), "animation-channel"), 1U);
    // Channels of a node outside of the scene, or of no node, cause no warning.
    Animated outside("translation");
    outside.builder.root["nodes"].push_back({{"name", "apart"}});
    outside.animation["channels"][0]["target"]["node"] = 1;
    outside.builder.root["scenes"] = {{{"nodes", {0}}}};
    const gltf::Scene scene = outside.import();
    EXPECT_TRUE(scene.animations.at(0).channels.empty());
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfAnimations, AreChecked) {
    Animated missing("translation");
    missing.animation["samplers"][0]["input"] = 99;
    missing.builder.root["animations"] = Json::array({missing.animation});
    EXPECT_EQ(errorId(missing.builder), "index-range");
    Animated typed("translation");
    typed.animation["channels"][0]["target"] = 3;
    typed.builder.root["animations"] = Json::array({typed.animation});
    EXPECT_EQ(errorId(typed.builder), "json-type");
}

// Returns a triangle that follows two joints, with as many sets of influences as there are weights.
GltfBuilder skinned(const std::vector<std::vector<float>>& weights) {
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    for (std::size_t set = 0; set < weights.size(); ++set) {
        primitive["attributes"]["JOINTS_" + std::to_string(set)] =
            builder.addAccessor(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, 4);
        primitive["attributes"]["WEIGHTS_" + std::to_string(set)] = builder.addAccessor(weights[set], 4);
    }
    std::vector<float> matrices(32, 0.0F);
    for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            matrices[16 * i + 5 * k] = 1.0F;
        }
        matrices[16 * i + 12] = static_cast<float>(i);
    }
    const int binds = builder.addAccessor(matrices, 16);
    builder.root["nodes"].push_back({{"name", "a"}});
    builder.root["nodes"].push_back({{"name", "b"}});
    builder.root["nodes"][0]["skin"] = 0;
    builder.root["skins"] = {{{"name", "two"}, {"joints", {1, 2}}, {"inverseBindMatrices", binds}}};
    return builder;
}

const std::vector<float> kHalfWeights{0.5F, 0.5F, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};

TEST(GltfSkins, AreRead) {
    const gltf::Scene scene = importMotion(skinned({kHalfWeights}));
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.skins.size(), 1U);
    EXPECT_EQ(scene.nodes.at(0).skin, 0);
    EXPECT_EQ(scene.skins[0].name, "two");
    EXPECT_EQ(scene.skins[0].joints, (std::vector<int>{1, 2}));
    EXPECT_EQ(scene.skins[0].inverseBinds.at(1)[12], 1.0);
    const gltf::SkinInfluences& influences = primitiveOf(scene).influences;
    EXPECT_EQ(influences.count, 2U) << "more joints than any vertex has are not kept";
    EXPECT_EQ(influences.joints, (std::vector<std::uint16_t>{0, 1, 0, 0, 1, 1}));
    EXPECT_EQ(influences.weights, (std::vector<float>{0.5F, 0.5F, 1, 0, 1, 0}));
}

TEST(GltfSkins, JoinSetsAndNormaliseWeights) {
    const std::vector<float> quarters(12, 0.125F);
    const gltf::Scene joined = importMotion(skinned({quarters, quarters}));
    EXPECT_EQ(primitiveOf(joined).influences.count, 8U);
    EXPECT_EQ(countWarnings(joined, "skin-weights"), 1U) << "both sets have the same joints";
    const gltf::Scene scaled = importMotion(skinned({{0.5F, 0.5F, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0}}));
    EXPECT_EQ(primitiveOf(scaled).influences.weights, (std::vector<float>{0.5F, 0.5F, 1, 0, 1, 0}));
    EXPECT_EQ(countWarnings(scaled, "skin-weights"), 1U);
    const gltf::Scene broken = importMotion(skinned({{NAN, 1, 0, 0, -1, 1, 0, 0, INFINITY, 1, 0, 0}}));
    EXPECT_EQ(primitiveOf(broken).influences.count, 1U);
    EXPECT_EQ(primitiveOf(broken).influences.joints, (std::vector<std::uint16_t>{1, 1, 1}));
}

TEST(GltfSkins, ReadNormalisedWeightsOf16Bits) {
    GltfBuilder builder = skinned({kHalfWeights});
    Json& attributes = builder.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["WEIGHTS_0"] = builder.addAccessor(
        std::vector<std::uint16_t>{32768, 32767, 0, 0, 65535, 0, 0, 0, 0, 65535, 0, 0}, 4, true);
    attributes["JOINTS_0"] =
        builder.addAccessor(std::vector<std::uint16_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, 4);
    const gltf::Scene scene = importMotion(builder);
    EXPECT_NEAR(primitiveOf(scene).influences.weights.at(0), 32768.0F / 65535.0F, 1e-7F);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfSkins, AreChecked) {
    GltfBuilder builder = skinned({kHalfWeights});
    builder.root["skins"][0]["joints"] = {1};
    EXPECT_EQ(errorId(builder), "skin-joint-range");
    builder = skinned({kHalfWeights});
    builder.root["skins"][0]["joints"] = Json::array();
    EXPECT_EQ(errorId(builder), "skin-joints");
    builder = skinned({kHalfWeights});
    builder.root["skins"][0]["joints"] = {1, 2, 1};
    EXPECT_EQ(errorId(builder), "skin-matrices");
    builder = skinned({kHalfWeights});
    builder.root["skins"][0]["joints"] = {1, 9};
    EXPECT_EQ(errorId(builder), "index-range");
    builder = skinned({kHalfWeights});
    builder.root["nodes"][0]["skin"] = 1;
    EXPECT_EQ(errorId(builder), "index-range");
    builder = skinned({kHalfWeights});
    builder.root["skins"][0]["inverseBindMatrices"] = 0;
    EXPECT_EQ(errorId(builder), "accessor-type");
    builder = skinned({kHalfWeights});
    builder.root["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0");
    EXPECT_EQ(errorId(builder), "skin-attribute");
    builder = skinned({kHalfWeights});
    Json& attributes = builder.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = builder.addAccessor(std::vector<float>(12, 0.0F), 4);
    EXPECT_EQ(errorId(builder), "attribute-type");
}

TEST(GltfSkins, AreLeftOutWhereAJointIsNotInTheScene) {
    GltfBuilder builder = skinned({kHalfWeights});
    builder.root["scenes"] = {{{"nodes", {0, 1}}}};
    const gltf::Scene scene = importMotion(builder);
    EXPECT_EQ(countWarnings(scene, "skin-joint-outside"), 1U);
    EXPECT_EQ(scene.nodes.at(0).skin, -1);
    EXPECT_TRUE(scene.skins.empty());
}

TEST(GltfSkins, WarnOfMoreSetsThanAreRead) {
    const std::vector<std::vector<float>> sets(5, std::vector<float>(12, 0.05F));
    const gltf::Scene scene = importMotion(skinned(sets));
    EXPECT_EQ(countWarnings(scene, "skin-influences"), 1U);
    EXPECT_EQ(primitiveOf(scene).influences.count, 16U);
}

TEST(GltfMorphs, AreReadWithTheirWeights) {
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    const int lift = builder.addAccessor(std::vector<float>{0, 0, 1, 0, 0, 2, 0, 0, 3}, 3);
    const int shift = builder.addAccessor(std::vector<std::int8_t>{127, 0, 0, 0, 0, 0, 0, 0, 0}, 3, true);
    primitive["targets"] = {{{"POSITION", lift}}, {{"POSITION", shift}}};
    builder.root["meshes"][0]["weights"] = {0.25, 1};
    builder.root["nodes"].push_back({{"mesh", 0}, {"weights", {0, 0.5}}});
    const gltf::Scene scene = importMotion(builder);
    EXPECT_EQ(countWarnings(scene, "accessor-form"), 1U) << "bytes";
    EXPECT_EQ(countWarnings(scene, "accessor-layout"), 1U) << "of three bytes a vertex";
    EXPECT_EQ(scene.warnings.size(), 2U);
    const gltf::Primitive& read = scene.meshes.at(0).primitives.at(0);
    ASSERT_EQ(read.targets.size(), 2U);
    EXPECT_EQ(read.targets[0].positions, (std::vector<gltf::Float3>{{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}));
    EXPECT_EQ(read.targets[1].positions.at(0), (gltf::Float3{1, 0, 0}));
    EXPECT_EQ(scene.meshes[0].weights, (std::vector<double>{0.25, 1}));
    EXPECT_EQ(scene.nodes.at(0).weights, (std::vector<double>{0.25, 1}));
    EXPECT_EQ(scene.nodes.at(1).weights, (std::vector<double>{0, 0.5}));
}

TEST(GltfMorphs, ReadSparseDifferences) {
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    const std::uint16_t index = 2;
    const float value[] = {7, 8, 9};
    const int indices = builder.addView(&index, sizeof(index));
    const int values = builder.addView(value, sizeof(value));
    const int accessor =
        builder.append("accessors", {{"componentType", 5126},
                                     {"count", 3},
                                     {"type", "VEC3"},
                                     {"sparse",
                                      {{"count", 1},
                                       {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                       {"values", {{"bufferView", values}}}}}});
    primitive["targets"] = {{{"POSITION", accessor}}};
    const gltf::Scene scene = importMotion(builder);
    EXPECT_EQ(primitiveOf(scene).targets.at(0).positions,
              (std::vector<gltf::Float3>{{0, 0, 0}, {0, 0, 0}, {7, 8, 9}}));
}

TEST(GltfMorphs, AreChecked) {
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    primitive["targets"] = {{{"POSITION", builder.addAccessor(std::vector<float>(6, 0.0F), 3)}}};
    EXPECT_EQ(errorId(builder), "attribute-count");
    primitive["targets"] = {{{"POSITION", builder.addAccessor(std::vector<float>(6, 0.0F), 2)}}};
    EXPECT_EQ(errorId(builder), "attribute-type");
    primitive["targets"] = {{{"POSITION", 99}}};
    EXPECT_EQ(errorId(builder), "index-range");
    primitive["targets"] = {{{"POSITION", builder.addAccessor(std::vector<float>(9, NAN), 3)}}};
    builder.root["meshes"][0]["weights"] = {1, 2, 3};
    const gltf::Scene scene = importMotion(builder);
    EXPECT_EQ(countWarnings(scene, "attribute-not-finite"), 1U);
    EXPECT_EQ(primitiveOf(scene).targets.at(0).positions.at(0), gltf::Float3{});
    EXPECT_EQ(countWarnings(scene, "morph-weights"), 1U);
    EXPECT_EQ(scene.nodes.at(0).weights, std::vector<double>{1});
    primitive["targets"] = {{{"NORMAL", builder.addAccessor(std::vector<float>(9, 0.0F), 3)}}};
    EXPECT_EQ(countWarnings(importMotion(builder), "morph-attribute"), 1U);
}

// Each node has weights of its own: a file of 60 KB could ask for gigabytes.
TEST(GltfMorph, RefusesTheProductOfManyNodesAndManyTargets) {
    constexpr std::size_t kTargets = 4096;
    const auto sceneOf = [](std::size_t nodes) {
        GltfBuilder builder;
        builder.addTriangle();
        builder.root["meshes"][0]["primitives"][0]["targets"] = Json(kTargets, Json::object());
        builder.root["nodes"] = Json(nodes, {{"mesh", 0}});
        builder.root["scenes"] = Json::array();
        return builder;
    };
    EXPECT_EQ(errorId(sceneOf(1025)), "morph-limit");
    EXPECT_EQ(errorId(sceneOf(2)), "imported");
}

}  // namespace
}  // namespace glint::test
