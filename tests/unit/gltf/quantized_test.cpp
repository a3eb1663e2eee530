// Tests KHR_mesh_quantization: every component type of every attribute, normalised or not.
#include "unit/gltf/only_primitive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace glint::test {
namespace {

GltfBuilder quantizedScene() {
    GltfBuilder builder;
    builder.root["extensionsUsed"] = builder.root["extensionsRequired"] =
        Json::array({"KHR_mesh_quantization"});
    return builder;
}

template <typename T>
class GltfQuantization : public testing::Test {};

using ComponentTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t>;
TYPED_TEST_SUITE(GltfQuantization, ComponentTypes, );

TYPED_TEST(GltfQuantization, PositionsAndTexCoords) {
    using T = TypeParam;
    constexpr T kLargest = std::numeric_limits<T>::max();
    constexpr T kLeast = std::numeric_limits<T>::lowest();
    for (const bool normalized : {false, true}) {
        const float unit = normalized ? static_cast<float>(kLargest) : 1.0F;
        // In glTF this is max(c / largest, -1) for signed types.
        const float least = normalized ? std::max(kLeast / unit, -1.0F) : static_cast<float>(kLeast);
        GltfBuilder builder = quantizedScene();
        Json primitive;
        primitive["attributes"]["POSITION"] =
            builder.addAccessor<T>({kLargest, 0, 1, 0, kLeast, 0, 3, 0, 0}, 3, normalized);
        for (const char* name : {"TEXCOORD_0", "TEXCOORD_1"}) {
            primitive["attributes"][name] =
                builder.addAccessor<T>({kLargest, 5, kLeast, 0, 1, 2}, 2, normalized);
        }
        builder.addMesh(primitive);
        const Result<gltf::Scene> scene = import(builder);
        const gltf::Primitive& read = onlyPrimitive(scene);
        ASSERT_EQ(read.positions.size(), 3U);
        EXPECT_EQ(read.positions[0], (gltf::Float3{kLargest / unit, 0.0F, 1.0F / unit}));
        EXPECT_EQ(read.positions[1], (gltf::Float3{0.0F, least, 0.0F}));
        for (const auto* texCoords : {&read.texCoords0, &read.texCoords1}) {
            EXPECT_EQ(texCoords->at(0), (gltf::Float2{kLargest / unit, 5.0F / unit}));
            EXPECT_EQ(texCoords->at(1), (gltf::Float2{least, 0.0F}));
        }
    }
}

template <typename T>
class GltfQuantizedFrames : public testing::Test {};

using SignedTypes = testing::Types<std::int8_t, std::int16_t>;
TYPED_TEST_SUITE(GltfQuantizedFrames, SignedTypes, );

TYPED_TEST(GltfQuantizedFrames, NormalsAndTangentsAreUnit) {
    using T = TypeParam;
    constexpr T kLargest = std::numeric_limits<T>::max();
    GltfBuilder builder = quantizedScene();
    Json& primitive = builder.addTriangle();
    primitive["attributes"]["NORMAL"] = builder.addAccessor<T>({0, 0, kLargest, 0, 0, 1, 0, 3, 4}, 3, true);
    primitive["attributes"]["TANGENT"] = builder.addAccessor<T>(
        {kLargest, 0, 0, kLargest, kLargest, 0, 0, static_cast<T>(-kLargest), 4, 3, 0, kLargest}, 4, true);
    const Result<gltf::Scene> scene = import(builder);
    const gltf::Primitive& read = onlyPrimitive(scene);
    ASSERT_EQ(read.normals.size(), 3U);
    EXPECT_EQ(read.normals[0], (gltf::Float3{0, 0, 1}));
    EXPECT_EQ(read.normals[1], (gltf::Float3{0, 0, 1}));
    EXPECT_FLOAT_EQ(read.normals[2][1], 0.6F);
    EXPECT_EQ(read.tangents[0], (gltf::Float4{1, 0, 0, 1}));
    EXPECT_EQ(read.tangents[1], (gltf::Float4{1, 0, 0, -1}));
    EXPECT_FLOAT_EQ(read.tangents[2][0], 0.8F);
    EXPECT_EQ(scene->warnings.size(), 1U);
    EXPECT_EQ(countWarnings(*scene, "accessor-layout"), 1U) << "normals are not at multiples of 4 bytes";
}

// UVs that are not normalised have a transform that scales them back.
TEST(GltfQuantizedTextures, KeepTheirTransform) {
    GltfBuilder builder = quantizedScene();
    builder.root["extensionsUsed"].push_back("KHR_texture_transform");
    builder.append("images", {{"uri", std::string("data:image/png;base64,") + kPng8}});
    builder.append("textures", {{"source", 0}});
    builder.append("materials", Json::parse(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0,
        "extensions": {"KHR_texture_transform": {"offset": [0.25, 0.5], "scale": [0.000244140625, 0.00048828125]}}}}})"));
    Json& primitive = builder.addTriangle();
    primitive["material"] = 0;
    primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor<std::uint16_t>({0, 0, 4096, 0, 0, 2048}, 2);
    const Result<gltf::Scene> scene = import(builder);
    const gltf::Primitive& read = onlyPrimitive(scene);
    const materials::TextureInfo& info = scene->materials.at(0).texture("baseColorTexture");
    EXPECT_TRUE(info.hasTransform);
    EXPECT_EQ(read.texCoords0.at(1)[0] * info.transform.scale[0] + info.transform.offset[0], 1.25F);
    EXPECT_EQ(read.texCoords0.at(2)[1] * info.transform.scale[1] + info.transform.offset[1], 1.5F);
}

}  // namespace
}  // namespace glint::test
