// The compact forms of vertices keep their values within the bounds that vertex_format.h states.
#include "data/vertex_format.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace glint;

using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;

// As octahedralDecode() of shaders/hit/geometry.glsl.
std::array<double, 3> decode(double x, double y) {
    const double z = 1.0 - std::abs(x) - std::abs(y);
    const double t = std::max(-z, 0.0);
    const double dx = x + (x >= 0.0 ? -t : t);
    const double dy = y + (y >= 0.0 ? -t : t);
    const double length = std::sqrt(dx * dx + dy * dy + z * z);
    return {dx / length, dy / length, z / length};
}

double angleBetween(const std::array<double, 3>& a, const Float3& b) {
    const double x = a[1] * b[2] - a[2] * b[1];
    const double y = a[2] * b[0] - a[0] * b[2];
    const double z = a[0] * b[1] - a[1] * b[0];
    return std::atan2(std::sqrt(x * x + y * y + z * z), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

// Directions everywhere, and those in which codes begin and end.
std::vector<Float3> directions() {
    std::vector<Float3> all{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 20000; ++i) {
        std::array<double, 3> v{normal(random), normal(random), normal(random)};
        if (i % 4 == 0) {
            v[i / 4 % 3] = 0.0;
        }
        const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        all.push_back({static_cast<float>(v[0] / length), static_cast<float>(v[1] / length),
                       static_cast<float>(v[2] / length)});
    }
    return all;
}

TEST(VertexFormat, NormalsKeepTheirDirection) {
    const std::vector<Float3> normals = directions();
    const auto words = packNormals(normals);
    ASSERT_TRUE(words && words->size() == normals.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const auto x = static_cast<std::int16_t>((*words)[i] & 0xFFFFU);
        const auto y = static_cast<std::int16_t>((*words)[i] >> 16U);
        worst = std::max(worst, angleBetween(decode(x / 32767.0, y / 32767.0), normals[i]));
    }
    EXPECT_LT(worst, 4.4e-5);
    EXPECT_GT(worst, 4e-5) << "the bound says more than it has to";
}

TEST(VertexFormat, TangentsKeepTheirDirectionAndSide) {
    std::vector<Float4> tangents;
    for (const Float3& v : directions()) {
        tangents.push_back({v[0], v[1], v[2], tangents.size() % 2 == 0 ? 1.0F : -1.0F});
    }
    const auto words = packTangents(tangents);
    ASSERT_TRUE(words && words->size() == tangents.size());
    for (std::size_t i = 0; i < tangents.size(); ++i) {
        const std::uint32_t word = (*words)[i];
        const auto x = static_cast<std::int16_t>(word & 0xFFFFU);
        const std::int32_t y = static_cast<std::int32_t>(word) >> 17;
        const Float4& t = tangents[i];
        EXPECT_LT(angleBetween(decode(x / 32767.0, y / 16383.0), {t[0], t[1], t[2]}), 7.5e-5);
        EXPECT_EQ((word & 0x10000U) != 0, t[3] < 0.0F);
    }
}

TEST(VertexFormat, WhatIsNoUnitVectorStaysAsItIs) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Float3& odd : {Float3{0, 0, 0}, Float3{0, 0, 1.01F}, Float3{0, nan, 1}}) {
        EXPECT_FALSE(packNormals(std::vector<Float3>{{0, 0, 1}, odd}));
        EXPECT_FALSE(packTangents(std::vector<Float4>{{odd[0], odd[1], odd[2], 1.0F}}));
    }
    EXPECT_FALSE(packTangents(std::vector<Float4>{{1, 0, 0, 0.5F}}));
}

std::array<double, 2> texCoordAt(const std::vector<std::uint32_t>& words, std::size_t vertex) {
    const auto number = [&](std::size_t i) { return static_cast<double>(std::bit_cast<float>(words[i])); };
    const std::uint32_t word = words[4 + vertex];
    return {number(0) + number(2) * (word & 0xFFFFU), number(1) + number(3) * (word >> 16U)};
}

TEST(VertexFormat, CoordinatesAreWithinHalfAStep) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-0.25F, 1.5F);
    std::vector<std::array<float, 2>> texCoords;
    for (int i = 0; i < 5000; ++i) {
        texCoords.push_back({place(random), 3.0F});
    }
    const auto words = packTexCoords(texCoords);
    ASSERT_TRUE(words && words->size() == texCoords.size() + 4);
    for (std::size_t i = 0; i < texCoords.size(); ++i) {
        const std::array<double, 2> at = texCoordAt(*words, i);
        EXPECT_NEAR(at[0], texCoords[i][0], 0.51 * 1.75 / 65535.0);
        EXPECT_EQ(at[1], 3.0);
    }
}

TEST(VertexFormat, CoordinatesOf16BitsKeepTheirValues) {
    std::vector<std::array<float, 2>> texCoords;
    for (int i = 0; i < 65536; i += 7) {
        texCoords.push_back({static_cast<float>(i / 65535.0), static_cast<float>((65535 - i) / 65535.0)});
    }
    const auto words = packTexCoords(texCoords);
    ASSERT_TRUE(words);
    for (std::size_t i = 0; i < texCoords.size(); ++i) {
        EXPECT_EQ((*words)[4 + i] & 0xFFFFU, 7 * i);
        EXPECT_NEAR(texCoordAt(*words, i)[0], texCoords[i][0], 1e-7);
    }
}

TEST(VertexFormat, CoordinatesThatRepeatManyTimesStayAsTheyAre) {
    EXPECT_TRUE(packTexCoords(std::vector<std::array<float, 2>>{{0, 0}, {3.9F, 1.1F}}));
    EXPECT_FALSE(packTexCoords(std::vector<std::array<float, 2>>{{0, 0}, {4.1F, 1.1F}}));
    EXPECT_FALSE(packTexCoords(
        std::vector<std::array<float, 2>>{{0, 0}, {std::numeric_limits<float>::infinity(), 1.0F}}));
}

TEST(VertexFormat, ColorsTakeTheBitsThatTheyHave) {
    const auto bytes = packColors(std::vector<Float4>{{0, 51 / 255.0F, 254 / 255.0F, 1}});
    ASSERT_TRUE(bytes);
    EXPECT_EQ(bytes->bits, 8U);
    EXPECT_EQ(bytes->words, std::vector<std::uint32_t>{0xFFFE3300U});
    const auto more = packColors(std::vector<Float4>{{0, 0.5F, 0.25F, 1}});
    ASSERT_TRUE(more);
    EXPECT_EQ(more->bits, 16U);
    ASSERT_EQ(more->words.size(), 2U);
    EXPECT_NEAR((more->words[0] >> 16U) / 65535.0, 0.5, 0.51 / 65535.0);
    EXPECT_EQ(more->words[1] >> 16U, 65535U);
    EXPECT_FALSE(packColors(std::vector<Float4>{{0, 1.5F, 0, 1}}));
}

}  // namespace
