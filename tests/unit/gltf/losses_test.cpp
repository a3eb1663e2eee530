// Nothing that a file asks for is lost in silence: pictures without a surface, inputs that primitives lack.
#include "plan/plan.h"
#include "support/must.h"
#include "unit/gltf/gltf_builder.h"

#include <glint/session/camera.h>

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace glint::test {
namespace {

gltf::Scene readScene(const GltfBuilder& builder, const gltf::ImportOptions& options = {}) {
    return must(import(builder, options));
}

void expectContains(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << "\nlacks: " << part;
}

// Returns the message and the hint of the warning that a picture of the scene has no surface.
std::pair<std::string, std::string> nothingDrawn(const GltfBuilder& builder,
                                                 const gltf::ImportOptions& options = {}) {
    const gltf::Scene scene = readScene(builder, options);
    EXPECT_EQ(countWarnings(scene, "nothing-drawn"), 1U);
    const Diagnostic warning = findWarning(scene, "nothing-drawn");
    return {warning.message, warning.hint};
}

TEST(GltfLosses, SayWhyNothingIsDrawn) {
    GltfBuilder triangle;
    triangle.addTriangle();
    EXPECT_EQ(countWarnings(readScene(triangle), "nothing-drawn"), 0U);

    expectContains(nothingDrawn({}).first, "it has no nodes");
    GltfBuilder bare;
    bare.append("nodes", {{"name", "a"}});
    bare.append("nodes", {{"name", "b"}});
    expectContains(nothingDrawn(bare).first, "none of its 2 nodes has a mesh");

    GltfBuilder hidden = triangle;
    hidden.root["extensionsUsed"] = {"KHR_node_visibility"};
    hidden.root["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
    expectContains(nothingDrawn(hidden).first, "hidden at all times");

    // What was dropped is named with its reason, and long lists are cut.
    GltfBuilder lines;
    for (int i = 0; i < 5; ++i) {
        lines.addTriangle()["mode"] = 1;
    }
    const std::string dropped = nothingDrawn(lines).first;
    expectContains(dropped, "/meshes/0/primitives/0: points and lines have no surface");
    expectContains(dropped, "; and 2 more");
    GltfBuilder broken;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    broken.addMesh(
        {{"attributes", {{"POSITION", broken.addAccessor<float>({0, 0, nan, 1, 0, 0, 0, 1, 0}, 3)}}}});
    expectContains(nothingDrawn(broken).first, "/meshes/0/primitives/0: has no triangle");
}

TEST(GltfLosses, NameTheSceneThatHasMeshes) {
    GltfBuilder builder;
    builder.addTriangle();
    builder.append("nodes", Json::object());
    builder.append("scenes", {{"nodes", {1}}});
    builder.append("scenes", {{"nodes", Json::array()}});
    builder.append("scenes", {{"name", "Room"}, {"nodes", {0}}});
    builder.root["scene"] = 0;
    expectContains(nothingDrawn(builder).second, "2 \"Room\" by --scene 2");
    expectContains(nothingDrawn(builder, {.scene = "1"}).first, "it has no nodes");
    EXPECT_EQ(countWarnings(readScene(builder, {.scene = "Room"}), "nothing-drawn"), 0U);
}

// A material with each texture on a primitive without what it reads.
struct Lacking {
    explicit Lacking(const Json& material) {
        builder.append("images", {{"uri", std::string("data:image/png;base64,") + kPng8}});
        builder.append("textures", {{"source", 0}});
        builder.append("materials", material);
        primitive = &builder.addTriangle();
        (*primitive)["material"] = 0;
    }
    void add(const std::string& attribute, const std::vector<float>& values) {
        const int accessor = builder.addAccessor<float>(values, static_cast<int>(values.size()) / 3);
        (*primitive)["attributes"][attribute] = accessor;
    }
    // The warning's message, or an empty text. Expects that planning gives the same reason.
    std::string lost() const {
        const gltf::Scene scene = readScene(builder);
        EXPECT_LE(countWarnings(scene, "input-missing"), 1U);
        const std::string message = findWarning(scene, "input-missing").message;
        std::vector<std::pair<std::string, std::string>> drops;
        compiler::makeKey(scene.materials.at(0), gltf::inputsOf(scene, 0, 0), {}, &drops);
        bool isDropped = message.empty();
        for (const auto& [feature, reason] : drops) {
            isDropped = isDropped || (message.starts_with(feature + " ") && message.ends_with(": " + reason));
        }
        EXPECT_TRUE(isDropped) << message;
        return message;
    }
    GltfBuilder builder;
    Json* primitive;
};

const std::vector<float> kUvs{0, 0, 1, 0, 0, 1};
const std::vector<float> kNormals{0, 0, 1, 0, 0, 1, 0, 0, 1};

TEST(GltfLosses, WarnOfTexturesWithoutTheirUvs) {
    const Json base = Json::parse(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})");
    Lacking without(base);
    EXPECT_EQ(without.lost(),
              "baseColorTexture is left out on /meshes/0/primitives/0: the primitive has no TEXCOORD_0");
    Lacking other(base);
    other.add("TEXCOORD_1", kUvs);
    EXPECT_EQ(other.lost(), without.lost());
    Lacking with(base);
    with.add("TEXCOORD_0", kUvs);
    EXPECT_EQ(with.lost(), "");

    Json second = base;
    second["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1;
    Lacking first(second);
    first.add("TEXCOORD_0", kUvs);
    expectContains(first.lost(), "the primitive has no TEXCOORD_1");

    // Further primitives are counted.
    Lacking many(base);
    for (int i = 0; i < 2; ++i) {
        many.builder.addTriangle()["material"] = 0;
    }
    EXPECT_EQ(
        many.lost(),
        "baseColorTexture is left out on /meshes/0/primitives/0 and 2 more: the primitive has no TEXCOORD_0");
}

TEST(GltfLosses, WarnOfLobesWithoutTheirInputs) {
    const Json grooved = Json::parse(R"({"pbrMetallicRoughness": {"roughnessFactor": 0.5},
        "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.5}}})");
    const auto lacking = [](const Json& material) {
        Lacking made(material);
        made.builder.root["extensionsUsed"] = {"KHR_materials_anisotropy"};
        made.add("NORMAL", kNormals);
        return made;
    };
    EXPECT_EQ(lacking(grooved).lost(),
              "anisotropy is left out on /meshes/0/primitives/0: the primitive has "
              "neither TANGENT nor texture coordinates");
    Lacking with = lacking(grooved);
    with.add("TEXCOORD_0", kUvs);
    EXPECT_EQ(with.lost(), "");
}

// Nobody asks for what changes nothing.
TEST(GltfLosses, AreNoneWhereNothingWouldChange) {
    for (
        const char* const material :
        {R"({"extensions": {"KHR_materials_unlit": {}}, "normalTexture": {"index": 0}})",
         R"({"emissiveFactor": [0, 0, 0], "emissiveTexture": {"index": 0}})",
         R"({"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0, "clearcoatTexture": {"index": 0}}}})",
         R"({"extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0}}})"}) {
        Lacking made(Json::parse(material));
        made.builder.root["extensionsUsed"] = {"KHR_materials_unlit", "KHR_materials_clearcoat",
                                               "KHR_materials_anisotropy"};
        EXPECT_EQ(made.lost(), "") << material;
    }
}

TEST(GltfLosses, ExplainUvSetsBeyondTheSecond) {
    Lacking made(
        Json::parse(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 3}}})"));
    made.add("TEXCOORD_0", kUvs);
    const gltf::Scene scene = readScene(made.builder);
    std::vector<std::pair<std::string, std::string>> drops;
    compiler::makeKey(scene.materials.at(0), gltf::inputsOf(scene, 0, 0), {}, &drops);
    ASSERT_EQ(drops.size(), 1U);
    EXPECT_EQ(drops[0].second, "it reads TEXCOORD_3; Glint reads sets 0 and 1");
    EXPECT_EQ(countWarnings(scene, "texture-uv-set"), 1U);
    EXPECT_EQ(countWarnings(scene, "input-missing"), 0U);
}

// What a camera at (0, 0, 5) that looks along -Z says of a triangle, which faces +Z.
std::string unseen(const GltfBuilder& builder, session::CameraChoice camera = {}, bool isCertain = false) {
    const gltf::Scene scene = readScene(builder);
    const session::SceneViewData data = session::makeSceneView(scene);
    camera.view.position = {0, 0, 5};
    camera.name = camera.name.empty() ? "7" : camera.name;
    const std::optional<Diagnostic> warning = session::nothingSeen(scene, data, camera, isCertain);
    return warning ? warning->message + "; " + warning->hint : "";
}

GltfBuilder triangleAt(const Json& node) {
    GltfBuilder builder;
    builder.addTriangle();
    builder.root["nodes"][0].update(node);
    return builder;
}

TEST(NothingSeen, SaysWhy) {
    EXPECT_EQ(unseen(triangleAt(Json::object())), "");
    const std::pair<const char*, const char*> cases[] = {
        {R"({"translation": [0, 0, 6]})", "1 instance is behind the camera (/nodes/0)"},
        {R"({"translation": [0, 0, 4.995]})",
         "1 instance is nearer than its near plane at 0.01 m (/nodes/0)"},
        {R"({"translation": [9, 0, 0]})", "1 instance is outside of its view (/nodes/0)"},
        {R"({"translation": [0, -9, 0]})", "1 instance is outside of its view (/nodes/0)"},
        {R"({"rotation": [0, 1, 0, 0]})", "1 instance is one-sided and seen from behind (/nodes/0)"},
        {R"({"scale": [0, 1, 1]})", "1 instance is without an area (/nodes/0)"}};
    for (const auto& [node, why] : cases) {
        const std::string text = unseen(triangleAt(Json::parse(node)));
        expectContains(text, "the camera 7 sees no surface: " + std::string(why));
        expectContains(text, "use --camera auto");
    }
    // A mirrored instance shows its front, and a double-sided material its back.
    EXPECT_EQ(unseen(triangleAt(Json::parse(R"({"scale": [-1, 1, 1]})"))), "");
    GltfBuilder turned = triangleAt(Json::parse(R"({"rotation": [0, 1, 0, 0]})"));
    turned.append("materials", {{"doubleSided", true}});
    turned.root["meshes"][0]["primitives"][0]["material"] = 0;
    EXPECT_EQ(unseen(turned), "");

    session::CameraChoice near;
    near.view.far = 3.0F;
    expectContains(unseen(triangleAt(Json::object()), near), "1 instance is beyond its far plane at 3 m");
    session::CameraChoice flat;
    flat.view.orthographic = true;
    EXPECT_EQ(unseen(triangleAt(Json::object()), flat), "");
    expectContains(unseen(triangleAt(Json::parse(R"({"translation": [0.5, 0, 0]})")), flat),
                   "outside of its view");
    session::CameraChoice framing;
    framing.name = "auto";
    expectContains(unseen(triangleAt(Json::parse(R"({"translation": [0, 0, 6]})")), framing),
                   "place a camera");
    // The picture itself may show that nothing is seen.
    expectContains(unseen(triangleAt(Json::object()), {}, true), "smaller than a pixel, or cut out by alpha");
}

TEST(NothingSeen, CountsInstancesAndFollowsTheirPose) {
    GltfBuilder builder = triangleAt(Json::parse(R"({"translation": [0, 0, 6]})"));
    builder.append("nodes", {{"mesh", 0}, {"translation", {9, 0, 0}}});
    builder.append("nodes", {{"mesh", 0}, {"translation", {0, 9, 0}}});
    expectContains(unseen(builder),
                   "1 instance is behind the camera (/nodes/0); "
                   "2 instances are outside of its view (/nodes/1, /nodes/2)");
    // One that is seen is enough.
    builder.append("nodes", {{"mesh", 0}});
    EXPECT_EQ(unseen(builder), "");

    // Morph targets move a triangle behind the camera.
    GltfBuilder morphed = triangleAt(Json::object());
    Json& primitive = morphed.root["meshes"][0]["primitives"][0];
    const int difference = morphed.addAccessor<float>({0, 0, 6, 0, 0, 6, 0, 0, 6}, 3);
    primitive["targets"] = Json::array({{{"POSITION", difference}}});
    EXPECT_EQ(unseen(morphed), "");
    morphed.root["meshes"][0]["weights"] = {1};
    expectContains(unseen(morphed), "1 instance is behind the camera");
}

}  // namespace
}  // namespace glint::test
