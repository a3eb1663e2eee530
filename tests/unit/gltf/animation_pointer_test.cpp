// Tests KHR_animation_pointer: the targets of pointers, the messages about wrong ones, and how planning uses
// the values.
#include "gltf/motion/animatable.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"
#include "support/features.h"
#include "support/must.h"
#include "unit/gltf/gltf_builder.h"

#include <glint/session/scene_view.h>

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace glint::test {
namespace {

// A file with a triangle, a texture, a light and a camera, and an animation whose channels are pointers.
struct Pointed {
    Pointed() {
        builder.addTriangle();
        Json& primitive = builder.root["meshes"][0]["primitives"][0];
        primitive["material"] = 0;
        primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor(std::vector<float>{0, 0, 1, 0, 0, 1}, 2);
        primitive["targets"] = Json::array();
        for (int i = 0; i < 2; ++i) {
            primitive["targets"].push_back(
                {{"POSITION", builder.addAccessor(std::vector<float>(9, 1.0F), 3)}});
        }
        builder.append("images", {{"uri", std::string("data:image/png;base64,") + kPng8}});
        builder.append("textures", {{"source", 0}});
        builder.append("materials", Json::parse(R"({
            "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.75},
            "normalTexture": {"index": 0, "extensions": {"KHR_texture_transform": {}}},
            "extensions": {"KHR_materials_clearcoat": {}, "KHR_materials_transmission": {},
                           "KHR_materials_ior": {}, "KHR_materials_volume": {}}})"));
        builder.append("cameras", Json::parse(R"({"type": "perspective",
            "perspective": {"yfov": 1, "znear": 0.1}})"));
        builder.root["extensions"]["KHR_lights_punctual"]["lights"] =
            Json::parse(R"([{"type": "spot", "intensity": 0, "spot": {}}])");
        builder.root["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
        builder.root["nodes"].push_back(
            Json::parse(R"({"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}})"));
        builder.append("animations", {{"samplers", Json::array()}, {"channels", Json::array()}});
    }

    // Adds a channel with keyframes at 0 and 1 s. Returns its sampler.
    template <typename T>
    Json& drive(const std::string& pointer, const std::vector<T>& values, int components,
                bool normalized = false) {
        Json& animation = builder.root["animations"][0];
        const std::size_t number = animation["samplers"].size();
        animation["samplers"].push_back({{"input", builder.addAccessor(std::vector<float>{0, 1}, 1)},
                                         {"output", builder.addAccessor(values, components, normalized)}});
        animation["channels"].push_back(
            {{"sampler", number},
             {"target",
              {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
        return animation["samplers"][number];
    }

    gltf::Scene import() {
        return must(test::import(builder));
    }

    GltfBuilder builder;
};

// Returns the scene at a time of its first animation.
gltf::Scene posedAt(gltf::Scene scene, double time) {
    constexpr std::array<std::size_t, 1> kFirst{0};
    session::applyPose(session::poseAt(scene, kFirst, time), scene);
    return scene;
}

TEST(AnimationPointers, MaterialValuesAreInterpolated) {
    Pointed pointed;
    pointed.drive<float>("/materials/0/pbrMetallicRoughness/baseColorFactor", {0, 0, 0, 1, 1, 0.5F, 0.25F, 1},
                         4);
    pointed.drive<float>("/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", {0, 1}, 1);
    pointed.drive<float>("/materials/0/normalTexture/scale", {1, -3}, 1);
    pointed.drive<float>("/materials/0/normalTexture/extensions/KHR_texture_transform/offset", {0, 0, 2, 4},
                         2);
    // A value out of range is clamped, as the importer does.
    pointed.drive<float>("/materials/0/pbrMetallicRoughness/roughnessFactor", {0.5F, 2.5F}, 1);
    const gltf::Scene rest = pointed.import();
    EXPECT_EQ(readingWarnings(rest).size(), 1U);
    EXPECT_EQ(countWarnings(rest, "animation-keyframes"), 1U) << "2.5 is no roughness";
    ASSERT_EQ(rest.animatedMaterials.size(), 1U);
    const gltf::Scene scene = posedAt(rest, 0.5);
    const materials::Material& material = scene.materials.at(0);
    EXPECT_EQ(material["baseColorFactor"], (std::array{0.5F, 0.25F, 0.125F, 1.0F}));
    EXPECT_EQ(material["clearcoatFactor"], 0.5F);
    EXPECT_EQ(material["normalScale"], -1.0F);
    EXPECT_EQ(material.texture("normalTexture").transform.offset, (std::array{1.0F, 2.0F}));
    EXPECT_EQ(material["roughnessFactor"], 1.0F);
    EXPECT_EQ(material["transmissionFactor"], 0.0F) << "not animated";
    // The file's values return, however often the scene was posed.
    gltf::Scene again = posedAt(scene, 1.0);
    session::applyPose(session::restPose(again), again);
    EXPECT_EQ(again.materials[0]["baseColorFactor"], rest.materials[0]["baseColorFactor"]);
    EXPECT_EQ(again.materials[0]["roughnessFactor"], 0.75F);
}

// Normalised integers are fractions. Other integers keep their values.
TEST(AnimationPointers, IntegersAreWhatTheyAreMarkedAs) {
    Pointed pointed;
    pointed.drive<std::uint8_t>("/materials/0/extensions/KHR_materials_ior/ior", {1, 3}, 1);
    pointed.drive<std::uint8_t>("/materials/0/pbrMetallicRoughness/roughnessFactor", {255, 51}, 1, true);
    const gltf::Scene scene = posedAt(pointed.import(), 1.0);
    EXPECT_EQ(scene.materials.at(0)["ior"], 3.0F);
    EXPECT_EQ(scene.materials.at(0)["roughnessFactor"], 0.2F);
}

TEST(AnimationPointers, LightsCamerasAndNodesFollow) {
    Pointed pointed;
    pointed.drive<float>("/extensions/KHR_lights_punctual/lights/0/intensity", {0, 8}, 1);
    pointed.drive<float>("/extensions/KHR_lights_punctual/lights/0/color", {1, 1, 1, 0, 1, 0.5F}, 3);
    pointed.drive<float>("/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", {0, 3}, 1);
    pointed.drive<float>("/cameras/0/perspective/yfov", {1, 2}, 1);
    pointed.drive<float>("/nodes/0/translation", {0, 0, 0, 2, 4, 6}, 3);
    pointed.drive<float>("/nodes/0/weights/1", {0, 1}, 1);
    pointed.drive<float>("/meshes/0/weights", {0.5F, 0, 1, 0}, 1);
    pointed.drive<std::uint8_t>("/nodes/0/extensions/KHR_node_visibility/visible", {0, 7},
                                1)["interpolation"] = "STEP";
    const gltf::Scene rest = pointed.import();
    EXPECT_EQ(rest.warnings.size(), 2U);
    EXPECT_EQ(countWarnings(rest, "animation-keyframes"), 1U) << "3 is no angle of a cone";
    EXPECT_EQ(countWarnings(rest, "animation-channel"), 1U) << "two channels drive a weight";
    EXPECT_FALSE(rest.nodes.at(0).shown);
    EXPECT_TRUE(rest.nodes.at(0).canShow);
    EXPECT_FALSE(rest.lights.at(0).shines());
    EXPECT_TRUE(rest.lights.at(0).canShine);
    const gltf::Scene half = posedAt(rest, 0.5);
    EXPECT_FALSE(half.nodes.at(0).shown) << "STEP";
    EXPECT_EQ(half.lights.at(0).intensity, 4.0F);
    EXPECT_EQ(half.lights.at(0).color, (gltf::Float3{0.5F, 1.0F, 0.75F}));
    EXPECT_EQ(half.lights.at(0).innerConeAngle, half.lights.at(0).outerConeAngle)
        << "no wider than the outer one";
    EXPECT_EQ(half.cameras.at(0).yfov, 1.5);
    EXPECT_EQ(half.nodes.at(0).world[13], 2.0);
    EXPECT_EQ(half.nodes.at(0).weights, (std::vector<double>{0.75, 0.0}))
        << "the later channel sets all weights";
    EXPECT_TRUE(posedAt(rest, 1.0).nodes.at(0).shown);
}

// Glint can't change anything there, so a note names the pointer once.
TEST(AnimationPointers, UnknownOnesAreNoted) {
    Pointed pointed;
    pointed.drive<float>("/cameras/0/perspective/aspectRatio", {1, 2}, 1);
    pointed.drive<float>("/materials/0/extensions/KHR_materials_future/glow", {1, 2}, 1);
    pointed.drive<float>("/materials/0/extensions/KHR_materials_future/glow", {1, 2}, 1);
    pointed.drive<float>("/nodes/0/extras/speed", {1, 2}, 1);
    const gltf::Scene scene = pointed.import();
    EXPECT_TRUE(scene.animations.at(0).channels.empty());
    ASSERT_EQ(countWarnings(scene, "animation-pointer"), 3U);
    const Diagnostic note = findWarning(scene, "animation-pointer");
    EXPECT_EQ(note.severity, Severity::Note);
    EXPECT_NE(note.message.find("\"/cameras/0/perspective/aspectRatio\""), std::string::npos) << note.message;
}

TEST(AnimationPointers, WrongOnesAreWarnedOf) {
    for (const char* pointer :
         {"", "materials/0/alphaCutoff", "/materials/9/alphaCutoff", "/materials/x/alphaCutoff",
          "/materials/01/alphaCutoff", "/nodes/0/rotation~2", "/nodes/0/matrix",
          "/cameras/0/perspective/zfar", "/cameras/0/orthographic/xmag",
          "/extensions/KHR_lights_punctual/lights/0/range",
          "/materials/0/extensions/KHR_materials_sheen/sheenColorFactor", "/nodes/0/weights/2",
          "/materials/0/occlusionTexture/strength", "/nodes/1/weights",
          "/nodes/1/extensions/KHR_node_visibility/visible"}) {
        Pointed pointed;
        pointed.drive<float>(pointer, {1, 2}, 1);
        const gltf::Scene scene = pointed.import();
        EXPECT_TRUE(scene.animations.at(0).channels.empty()) << pointer;
        ASSERT_EQ(readingWarnings(scene).size(), 1U) << pointer;
        EXPECT_EQ(scene.warnings[0].id, "animation-pointer") << pointer;
        EXPECT_EQ(scene.warnings[0].severity, Severity::Warning) << pointer;
    }
    // One path lacks the extension, and one pointer is malformed.
    Pointed bare;
    bare.drive<float>("/nodes/0/scale", {1, 1, 1, 2, 2, 2}, 3);
    Json& target = bare.builder.root["animations"][0]["channels"][0]["target"];
    target.erase("extensions");
    EXPECT_EQ(countWarnings(bare.import(), "animation-pointer"), 1U);
    target["extensions"]["KHR_animation_pointer"]["pointer"] = 3;
    EXPECT_EQ(mustFail(import(bare.builder)).id, "json-type");
    target["extensions"]["KHR_animation_pointer"] = Json::object();
    EXPECT_EQ(import(bare.builder).error().id, "json-missing");
}

TEST(AnimationPointers, AccessorsMustFit) {
    const auto refused = [](auto drive) {
        Pointed pointed;
        drive(pointed);
        const gltf::Scene scene = pointed.import();
        return scene.animations.at(0).channels.empty() && countWarnings(scene, "animation-keyframes") == 1;
    };
    const char* const kVisible = "/nodes/0/extensions/KHR_node_visibility/visible";
    EXPECT_TRUE(refused([](Pointed& p) { p.drive<float>("/materials/0/alphaCutoff", {1, 1, 2, 2}, 2); }));
    EXPECT_TRUE(refused([](Pointed& p) {
        p.drive<float>("/materials/0/emissiveFactor", {1, 1, 1, 2, 2, 2}, 1);
    }));
    EXPECT_TRUE(refused([](Pointed& p) { p.drive<float>("/nodes/0/weights", {1, 1, 2, 2}, 2); }));
    EXPECT_TRUE(refused([&](Pointed& p) { p.drive<float>(kVisible, {0, 1}, 1)["interpolation"] = "STEP"; }));
    EXPECT_TRUE(refused([&](Pointed& p) { p.drive<std::uint8_t>(kVisible, {0, 1}, 1); })) << "LINEAR";
    EXPECT_TRUE(refused([&](Pointed& p) {
        p.drive<std::uint8_t>(kVisible, {0, 1}, 1, true)["interpolation"] = "STEP";
    }));
}

// Every property of every slot and extension has its own number, width and setter.
TEST(AnimationPointers, EveryPropertySetsItsOwnValue) {
    // There are 32 factors, and an offset, a rotation and a scale for each of 21 places of textures.
    ASSERT_EQ(gltf::materialPropertyCount(materials::builtinMaterialModel()), 32 + 3 * 21);
    for (int property = 0; property < gltf::materialPropertyCount(materials::builtinMaterialModel());
         ++property) {
        const std::string below = gltf::materialPropertyName(materials::builtinMaterialModel(), property);
        const std::string name = below.starts_with("KHR_") ? "extensions/" + below : below;
        EXPECT_EQ(gltf::findMaterialProperty(materials::builtinMaterialModel(), name), property) << name;
        materials::Material material;
        if (name.find("pbrSpecularGlossiness") != std::string::npos) {
            material.give("KHR_materials_pbrSpecularGlossiness");
        }
        const std::size_t width = gltf::materialPropertyWidth(materials::builtinMaterialModel(), property);
        gltf::setMaterialProperty(material, property, std::vector<double>(width, 0.375));
        for (std::size_t number = 0; number < width; ++number) {
            const double expected = name.ends_with("/ior") || name.ends_with("iridescenceIor") ? 1.0 : 0.375;
            EXPECT_EQ(gltf::materialPropertyValue(material, property, number), expected) << name;
        }
    }
}

materials::FeatureMask keyOf(const gltf::Scene& scene) {
    const gltf::SceneList list(std::span(&scene, 1));
    return compiler::makeKey(list.materials()[0], list.primitives()[0], {});
}

// A feature stays if its value leaves the neutral one at any time, even if it is neutral at rest and in the
// keyframes.
TEST(AnimationPlanning, KeepsWhatAnimationsCallFor) {
    const materials::FeatureMask still = keyOf(Pointed().import());
    EXPECT_EQ(still & (bit("clearcoat") | bit("transmission") | bit("ior") | bit("volume") |
                       bit("textureTransform")),
              0U);
    Pointed pointed;
    pointed.drive<float>("/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", {0, 1}, 1);
    // At each keyframe one of the two is neutral: it is metal at one, and has an index of 1.5 at the other.
    // Between the keyframes neither is.
    pointed.drive<float>("/materials/0/extensions/KHR_materials_ior/ior", {1.5F, 2}, 1);
    pointed.drive<float>("/materials/0/pbrMetallicRoughness/metallicFactor", {0, 1}, 1);
    pointed.drive<float>("/materials/0/normalTexture/extensions/KHR_texture_transform/rotation", {0, 1}, 1);
    const gltf::Scene scene = pointed.import();
    const materials::FeatureMask key = keyOf(scene);
    for (const char* const feature : {"clearcoat", "ior", "textureTransform"}) {
        EXPECT_NE(key & bit(feature), 0U) << feature;
    }
    EXPECT_EQ(key & bit("transmission"), 0U) << "always 0";
    EXPECT_EQ(scene.animatedMaterials.at(0).changes.size(), 4U);
    EXPECT_EQ(scene.animatedMaterials[0].changes[0].substr(0, 35), "pbrMetallicRoughness/metallicFactor");
    // At each time the key contains the whole key of that time's values.
    for (const double time : {0.0, 0.25, 0.5, 1.0}) {
        gltf::Scene plain = posedAt(scene, time);
        plain.animatedMaterials.clear();
        EXPECT_EQ(keyOf(plain) & ~key, 0U) << time;
    }
}

// A frame turns if the transform of its texture may rotate or mirror the UVs at any time.
TEST(AnimationPlanning, TurnsFramesWhereATransformMayTurnThem) {
    const auto turns = [](const char* part, const std::vector<float>& values, int components) {
        Pointed pointed;
        pointed.drive<float>(
            std::string("/materials/0/normalTexture/extensions/KHR_texture_transform/") + part, values,
            components);
        const materials::FeatureMask key = keyOf(pointed.import());
        EXPECT_NE(key & bit("textureTransform"), 0U) << part;
        return (key & bit("turnedFrames")) != 0;
    };
    EXPECT_TRUE(turns("rotation", {0, 1}, 1));
    EXPECT_TRUE(turns("scale", {1, 1, -1, 1}, 2));
    EXPECT_FALSE(turns("scale", {1, 1, 2, 3}, 2));
    EXPECT_FALSE(turns("offset", {0, 0, -1, 1}, 2));
}

// A value that never changes is not animated.
TEST(AnimationPlanning, ConstantKeyframesAreConstants) {
    Pointed pointed;
    pointed.drive<float>("/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", {0, 0}, 1);
    pointed.drive<float>("/materials/0/extensions/KHR_materials_transmission/transmissionFactor", {-1, 0}, 1);
    const gltf::Scene scene = pointed.import();
    EXPECT_EQ(keyOf(scene), keyOf(Pointed().import()));
    EXPECT_TRUE(scene.animatedMaterials.at(0).changes.empty());
}

// A spline may exceed the values of its keyframes.
TEST(AnimationPlanning, SplinesOvershoot) {
    Pointed pointed;
    pointed.drive<float>("/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor",
                         {0, 0, 4, 0, 0, 0}, 1)["interpolation"] = "CUBICSPLINE";
    const gltf::Scene scene = pointed.import();
    EXPECT_GT(posedAt(scene, 0.3).materials.at(0)["clearcoatFactor"], 0.1F);
    EXPECT_NE(keyOf(scene) & bit("clearcoat"), 0U);
}

TEST(AnimationPlanning, TheSmoothestMomentCountsForReflections) {
    Pointed pointed;
    pointed.drive<float>("/materials/0/pbrMetallicRoughness/roughnessFactor", {1, 0.125F}, 1);
    const gltf::Scene scene = pointed.import();
    const gltf::SceneList list(std::span(&scene, 1));
    const materials::EffectDeclaration& reflection = materials::builtinMaterialModel().effects[2];
    EXPECT_TRUE(compiler::sendsRays(reflection, list.materials()[0], list.primitives()[0], 0.125F));
    EXPECT_FALSE(compiler::sendsRays(reflection, list.materials()[0], list.primitives()[0], 0.12F));
}

}  // namespace
}  // namespace glint::test
