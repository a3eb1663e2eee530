// Tests attributes that are not finite or not unit vectors.
#include "support/must.h"
#include "unit/gltf/only_primitive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(GltfRepair, NormalizesNormalsAndReplacesBrokenOnes) {
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    primitive["attributes"]["NORMAL"] = builder.addAccessor<float>({0, 3, 4, 0, 0, 0, kNan, 0, 1}, 3);
    const Result<gltf::Scene> scene = import(builder);
    const gltf::Primitive& read = onlyPrimitive(scene);
    EXPECT_FLOAT_EQ(read.normals[0][1], 0.6F);
    EXPECT_FLOAT_EQ(read.normals[0][2], 0.8F);
    EXPECT_EQ(read.normals[1], (gltf::Float3{0, 0, 1}));
    EXPECT_EQ(read.normals[2], (gltf::Float3{0, 0, 1}));
    EXPECT_EQ(countWarnings(*scene, "normal-invalid"), 1U);
    EXPECT_EQ(findWarning(*scene, "normal-invalid").message.substr(0, 2), "2 ");
}

TEST(GltfRepair, TakesTheTrianglesNormal) {
    GltfBuilder builder;
    Json primitive;
    primitive["attributes"]["POSITION"] =
        builder.addAccessor<float>({0, 0, 0, 0, 1e-20F, 0, 0, 0, 1e-20F}, 3);
    primitive["attributes"]["NORMAL"] = builder.addAccessor<float>(std::vector<float>(9), 3);
    builder.addMesh(primitive);
    EXPECT_EQ(onlyPrimitive(import(builder)).normals[1], (gltf::Float3{1, 0, 0}));
}

TEST(GltfRepair, MakesTangentsUnitAndSigned) {
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    primitive["attributes"]["NORMAL"] = builder.addAccessor<float>({0, 0, 1, 0, 0, 1, 1, 0, 0}, 3);
    primitive["attributes"]["TANGENT"] =
        builder.addAccessor<float>({2, 0, 0, -3, 0, 5, 0, 1, 0, 0, 0, kNan}, 4);
    const Result<gltf::Scene> scene = import(builder);
    const gltf::Primitive& read = onlyPrimitive(scene);
    EXPECT_EQ(read.tangents[0], (gltf::Float4{1, 0, 0, -1}));
    EXPECT_EQ(read.tangents[1], (gltf::Float4{0, 1, 0, 1}));
    const gltf::Float4& made = read.tangents[2];
    EXPECT_FLOAT_EQ(std::hypot(made[0], made[1], made[2]), 1.0F);
    EXPECT_FLOAT_EQ(made[0], 0.0F);  // +X, at right angles to its normal
    EXPECT_EQ(made[3], 1.0F);
    EXPECT_EQ(countWarnings(*scene, "tangent-invalid"), 1U);
}

TEST(GltfRepair, IgnoresTangentsWithoutNormals) {
    GltfBuilder builder;
    builder.addTriangle()["attributes"]["TANGENT"] =
        builder.addAccessor<float>(std::vector<float>(12, 1.0F), 4);
    const Result<gltf::Scene> scene = import(builder);
    EXPECT_TRUE(onlyPrimitive(scene).tangents.empty());
    EXPECT_EQ(countWarnings(*scene, "tangent-without-normal"), 1U);
}

TEST(GltfRepair, DropsTrianglesWithBrokenPositions) {
    GltfBuilder builder;
    const float infinite = std::numeric_limits<float>::infinity();
    Json primitive;
    primitive["attributes"]["POSITION"] =
        builder.addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, infinite, 0, 0}, 3);
    primitive["indices"] = builder.addAccessor<std::uint8_t>({0, 1, 2, 1, 3, 2, 3, 3, 3}, 1);
    builder.addMesh(primitive);
    const Result<gltf::Scene> scene = import(builder);
    EXPECT_EQ(onlyPrimitive(scene).indices, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(onlyPrimitive(scene).positions[3], (gltf::Float3{0, 0, 0}));
    const std::string message = findWarning(*scene, "position-not-finite").message;
    EXPECT_NE(message.find("1 positions"), std::string::npos) << message;
    EXPECT_NE(message.find("2 triangles"), std::string::npos) << message;
}

TEST(GltfRepair, ReplacesOtherValuesThatAreNotFinite) {
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor<float>({0.5F, kNan, 1, 1, 2, 2}, 2);
    primitive["attributes"]["COLOR_0"] =
        builder.addAccessor<float>({kNan, 0, 0, 0.5F, 0.5F, 0.5F, 0, 0, 0}, 3);
    const Result<gltf::Scene> scene = import(builder);
    EXPECT_EQ(onlyPrimitive(scene).texCoords0[0], (gltf::Float2{0, 0}));
    EXPECT_EQ(onlyPrimitive(scene).colors[0], (gltf::Float4{1, 1, 1, 1}));
    EXPECT_EQ(countWarnings(*scene, "attribute-not-finite"), 2U);
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kDenormal = std::numeric_limits<float>::denorm_min();
constexpr float kHuge = 3e38F;

bool isSound(const gltf::Primitive& primitive) {
    const auto finite = [](const auto& values) {
        return std::all_of(values.begin(), values.end(), [](const auto& value) {
            return std::all_of(value.begin(), value.end(), [](float x) { return std::isfinite(x); });
        });
    };
    const auto unit = [](const auto& values) {
        return std::all_of(values.begin(), values.end(), [](const auto& v) {
            return std::abs(std::hypot(v[0], v[1], v[2]) - 1.0F) < 1e-5F;
        });
    };
    return finite(primitive.positions) && finite(primitive.texCoords0) && finite(primitive.texCoords1) &&
           finite(primitive.colors) && unit(primitive.normals) && unit(primitive.tangents);
}

// Puts a value of each difficult kind at each place of each attribute.
TEST(GltfRepair, NoValueSpreads) {
    const std::vector<std::pair<const char*, int>> attributes{
        {"POSITION", 3}, {"NORMAL", 3}, {"TANGENT", 4}, {"TEXCOORD_0", 2}, {"TEXCOORD_1", 2}, {"COLOR_0", 4}};
    for (const auto& [broken, brokenComponents] : attributes) {
        for (const float value : {kNan, kInfinity, -kInfinity, kDenormal, kHuge, -kHuge}) {
            for (std::size_t place = 0; place < 3U * static_cast<std::size_t>(brokenComponents); ++place) {
                GltfBuilder builder;
                Json primitive;
                for (const auto& [name, components] : attributes) {
                    std::vector<float> values(static_cast<std::size_t>(3 * components), 0.5F);
                    if (std::string_view(name) == "POSITION") {
                        values = {0, 0, 0, 1, 0, 0, 0, 1, 0};
                    }
                    for (std::size_t w = 3; std::string_view(name) == "TANGENT" && w < values.size();
                         w += 4) {
                        values[w] = 1.0F;
                    }
                    if (std::string_view(name) == broken) {
                        values[place] = value;
                    }
                    primitive["attributes"][name] = builder.addAccessor<float>(values, components);
                }
                // A second triangle does not use the first vertex, so that one triangle remains.
                primitive["indices"] =
                    builder.addAccessor<std::uint8_t>({0, 1, 2, 0, 0, 0, 1, 1, 1, 2, 2, 2}, 1);
                builder.addMesh(primitive);
                const Result<gltf::Scene> scene = import(builder);
                const gltf::Primitive& read = onlyPrimitive(scene);
                EXPECT_TRUE(isSound(read)) << broken << "[" << place << "] = " << value;
                // A value that a float can hold is no damage, but the sign of a tangent must be 1 or -1.
                const bool isSign = std::string_view(broken) == "TANGENT" && place % 4 == 3;
                const bool isDamage = !std::isfinite(value) || isSign;
                EXPECT_EQ(scene->warnings.size(), isDamage ? 1U : 0U)
                    << broken << "[" << place << "] = " << value;
            }
        }
    }
}

TEST(GltfRepair, VectorsOfAnyLengthBecomeUnit) {
    for (const float length : {kDenormal, 1e-30F, 1e30F, kHuge}) {
        GltfBuilder builder;
        Json& primitive = builder.addTriangle();
        primitive["attributes"]["NORMAL"] =
            builder.addAccessor<float>({length, length, 0, 0, 0, -length, length, length, length}, 3);
        primitive["attributes"]["TANGENT"] =
            builder.addAccessor<float>({0, 0, length, 1, length, 0, 0, -1, length, -length, 0, 1}, 4);
        const Result<gltf::Scene> scene = import(builder);
        const gltf::Primitive& read = onlyPrimitive(scene);
        EXPECT_TRUE(scene->warnings.empty()) << length;
        EXPECT_FLOAT_EQ(read.normals.at(0)[0], std::sqrt(0.5F));
        EXPECT_EQ(read.normals[1], (gltf::Float3{0, 0, -1}));
        EXPECT_FLOAT_EQ(read.normals[2][2], std::sqrt(1.0F / 3.0F));
        EXPECT_EQ(read.tangents[0], (gltf::Float4{0, 0, 1, 1}));
        EXPECT_EQ(read.tangents[1], (gltf::Float4{1, 0, 0, -1}));
    }
}

// Tests the geometric normal of the largest triangle that floats allow, and of the smallest.
TEST(GltfRepair, SubstitutesAreUnitAtEveryScale) {
    for (const float size : {1e-38F, 1e38F, kHuge}) {
        GltfBuilder builder;
        Json primitive;
        primitive["attributes"]["POSITION"] =
            builder.addAccessor<float>({-size, -size, 0, size, -size, 0, 0, size, 0}, 3);
        primitive["attributes"]["NORMAL"] = builder.addAccessor<float>(std::vector<float>(9, kNan), 3);
        builder.addMesh(primitive);
        EXPECT_EQ(onlyPrimitive(import(builder)).normals.at(0), (gltf::Float3{0, 0, 1})) << size;
    }
}

TEST(GltfRepair, SparseValuesAreRepairedToo) {
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    const int normals = builder.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    primitive["attributes"]["NORMAL"] = normals;
    const std::uint16_t targets[] = {0, 1, 2};
    const float values[] = {kNan, 0, 1, kInfinity, 0, 0, 0, kDenormal, 0};
    const int indexView = builder.addView(targets, sizeof targets);
    const int valueView = builder.addView(values, sizeof values);
    builder.root["accessors"][static_cast<std::size_t>(normals)]["sparse"] = {
        {"count", 3},
        {"indices", {{"bufferView", indexView}, {"componentType", 5123}}},
        {"values", {{"bufferView", valueView}}}};
    const Result<gltf::Scene> scene = import(builder);
    EXPECT_TRUE(isSound(onlyPrimitive(scene)));
    EXPECT_EQ(onlyPrimitive(scene).normals.at(2), (gltf::Float3{0, 1, 0}));
    EXPECT_EQ(findWarning(*scene, "normal-invalid").message.substr(0, 2), "2 ");
}

// JSON has no NaN. Its largest numbers become infinite, or overflow when transforms are multiplied.
TEST(GltfRepair, TransformsThatOverflowAreRefused) {
    const auto idOf = [](const char* node) {
        GltfBuilder builder;
        builder.addTriangle();
        builder.root["nodes"] = Json::array({Json::parse(node)});
        builder.root["nodes"].push_back(Json::parse(R"({"children": [0], "scale": [1e30, 1e30, 1e30]})"));
        const Result<gltf::Scene> scene = import(builder);
        return scene ? std::string("imported") : scene.error().id;
    };
    EXPECT_EQ(idOf(R"({"mesh": 0, "scale": [1e30, 1, 1]})"), "node-transform");
    EXPECT_EQ(idOf(R"({"mesh": 0, "translation": [1e300, 0, 0]})"), "json-range");
    EXPECT_EQ(idOf(R"({"mesh": 0, "rotation": [1e39, 0, 0, 1]})"), "json-range");
    EXPECT_EQ(idOf(R"({"mesh": 0, "matrix": [1e39,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})"), "json-range");
    EXPECT_EQ(idOf(R"({"mesh": 0, "scale": [1e-45, 1e-30, 0]})"), "imported");
    EXPECT_EQ(idOf(R"({"mesh": 0, "rotation": [1e38, 1e38, 1e38, 1e38]})"), "imported");
    const Diagnostic tooLarge =
        mustFail(importText(R"({"asset": {"version": "2.0"}, "nodes": [{"translation": [1e400, 0, 0]}]})"));
    EXPECT_EQ(tooLarge.id, "json-range");
    EXPECT_TRUE(tooLarge.where.ends_with("scene.gltf#/nodes/0/translation/0"));
    EXPECT_NE(tooLarge.message.find("1e400"), std::string::npos);
}

}  // namespace
}  // namespace glint::test
