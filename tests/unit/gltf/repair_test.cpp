// Attributes that are not finite or not unit.
#include "unit/gltf/only_primitive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glint::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(GltfRepair, NormalizesNormalsAndReplacesBrokenOnes) {
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    primitive["attributes"]["NORMAL"] = builder.addAccessor<float>({0, 3, 4, 0, 0, 0, kNan, 0, 1}, 3);
    const Result<Scene> scene = import(builder);
    const Primitive& read = onlyPrimitive(scene);
    EXPECT_FLOAT_EQ(read.normals[0][1], 0.6F);
    EXPECT_FLOAT_EQ(read.normals[0][2], 0.8F);
    EXPECT_EQ(read.normals[1], (Float3{0, 0, 1}));
    EXPECT_EQ(read.normals[2], (Float3{0, 0, 1}));
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
    EXPECT_EQ(onlyPrimitive(import(builder)).normals[1], (Float3{1, 0, 0}));
}

TEST(GltfRepair, MakesTangentsUnitAndSigned) {
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    primitive["attributes"]["NORMAL"] = builder.addAccessor<float>({0, 0, 1, 0, 0, 1, 1, 0, 0}, 3);
    primitive["attributes"]["TANGENT"] =
        builder.addAccessor<float>({2, 0, 0, -3, 0, 5, 0, 1, 0, 0, 0, kNan}, 4);
    const Result<Scene> scene = import(builder);
    const Primitive& read = onlyPrimitive(scene);
    EXPECT_EQ(read.tangents[0], (Float4{1, 0, 0, -1}));
    EXPECT_EQ(read.tangents[1], (Float4{0, 1, 0, 1}));
    const Float4& made = read.tangents[2];
    EXPECT_FLOAT_EQ(std::hypot(made[0], made[1], made[2]), 1.0F);
    EXPECT_FLOAT_EQ(made[0], 0.0F);  // at right angles to its normal, +X
    EXPECT_EQ(made[3], 1.0F);
    EXPECT_EQ(countWarnings(*scene, "tangent-invalid"), 1U);
}

TEST(GltfRepair, IgnoresTangentsWithoutNormals) {
    GltfBuilder builder;
    builder.addTriangle()["attributes"]["TANGENT"] =
        builder.addAccessor<float>(std::vector<float>(12, 1.0F), 4);
    const Result<Scene> scene = import(builder);
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
    const Result<Scene> scene = import(builder);
    EXPECT_EQ(onlyPrimitive(scene).indices, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(onlyPrimitive(scene).positions[3], (Float3{0, 0, 0}));
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
    const Result<Scene> scene = import(builder);
    EXPECT_EQ(onlyPrimitive(scene).texCoords0[0], (Float2{0, 0}));
    EXPECT_EQ(onlyPrimitive(scene).colors[0], (Float4{1, 1, 1, 1}));
    EXPECT_EQ(countWarnings(*scene, "attribute-not-finite"), 2U);
}

}  // namespace
}  // namespace glint::test
