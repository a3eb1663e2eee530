// Positions of 16 bits: grids that keep what a file has, and grids over the box of a mesh.
#include "data/vertex_format.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace glint;

using Float3 = std::array<float, 3>;

PrimitiveView viewOf(const std::vector<Float3>& positions, std::uint32_t mesh = 0) {
    PrimitiveView view;
    view.mesh = mesh;
    view.positions = positions;
    return view;
}

std::vector<Float3> randomPositions(int count, float least, float most) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> number(least, most);
    std::vector<Float3> positions;
    for (int i = 0; i < count; ++i) {
        positions.push_back({number(random), number(random), number(random)});
    }
    return positions;
}

// As packedPosition() of shaders/host/geometry.glsl.
Float3 decode(const std::vector<std::uint32_t>& words, std::uint32_t vertex) {
    const std::uint32_t place = 6 + (3 * vertex >> 1U);
    const std::uint32_t first = words[place];
    const std::uint32_t second = words[place + 1];
    const std::array<std::uint32_t, 3> code =
        (vertex & 1U) != 0 ? std::array<std::uint32_t, 3>{first >> 16U, second & 0xFFFFU, second >> 16U}
                           : std::array<std::uint32_t, 3>{first & 0xFFFFU, first >> 16U, second & 0xFFFFU};
    Float3 position{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Stores keep compilers from rounding only once.
        const volatile float offset = std::bit_cast<float>(words[3 + axis]) * static_cast<float>(code[axis]);
        position[axis] = std::bit_cast<float>(words[axis]) + offset;
    }
    return position;
}

TEST(PositionGrid, ShadersReadTheValuesOfTheHost) {
    for (const int count : {1, 2, 7, 1000}) {
        const std::vector<Float3> positions = randomPositions(count, -3.7F, 11.3F);
        const PrimitiveView view = viewOf(positions);
        const std::optional<PositionGrid> grid = coverByGrid({&view, 1});
        ASSERT_TRUE(grid);
        const GridPositions placed = placeOnGrid(positions, *grid);
        ASSERT_EQ(placed.values.size(), positions.size());
        for (std::uint32_t i = 0; i < positions.size(); ++i) {
            ASSERT_EQ(decode(placed.words, i), placed.values[i]) << i;
        }
    }
}

TEST(PositionGrid, AGridOverTheBoxMovesByHalfAStep) {
    const std::vector<Float3> positions = randomPositions(5000, 100.0F, 104.0F);
    const PrimitiveView view = viewOf(positions);
    EXPECT_FALSE(findGrid({&view, 1})) << "no file has such numbers in 16 bits";
    const std::optional<PositionGrid> grid = coverByGrid({&view, 1});
    ASSERT_TRUE(grid);
    const GridPositions placed = placeOnGrid(positions, *grid);
    double most = 0.0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            most = std::max(most, std::abs(static_cast<double>(placed.values[i][axis]) - positions[i][axis]));
        }
    }
    // Half a step, and the rounding of the sum.
    EXPECT_LE(most, 4.0 / 131070.0 + 104.0 * std::numeric_limits<float>::epsilon());
    EXPECT_GT(most, 1e-5) << "the bound would prove nothing";
}

TEST(PositionGrid, KeepsIntegersOfFiles) {
    std::mt19937 random(5);
    // Most of a type of KHR_mesh_quantization, and whether it has negative values.
    const struct {
        int least;
        int most;
        float divisor;
    } types[] = {{0, 65535, 1.0F},          {-32768, 32767, 1.0F}, {0, 255, 1.0F},     {0, 65535, 65535.0F},
                 {-32767, 32767, 32767.0F}, {0, 255, 255.0F},      {-127, 127, 127.0F}};
    for (const auto& type : types) {
        std::uniform_int_distribution<int> number(type.least, type.most);
        std::vector<Float3> positions;
        const auto value = [&](int integer) { return static_cast<float>(integer) / type.divisor; };
        positions.push_back({value(type.least), value(type.least), value(type.most)});
        positions.push_back({value(type.most), value(type.most), value(type.least)});
        for (int i = 0; i < 3000; ++i) {
            positions.push_back({value(number(random)), value(number(random)), value(number(random))});
        }
        const PrimitiveView view = viewOf(positions);
        const std::optional<PositionGrid> grid = findGrid({&view, 1});
        ASSERT_TRUE(grid) << type.most << " / " << type.divisor;
        const float tolerance =
            value(type.most) * (type.divisor == 1.0F ? 0.0F : 2.0F * std::numeric_limits<float>::epsilon());
        const GridPositions placed = placeOnGrid(positions, *grid);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                ASSERT_NEAR(placed.values[i][axis], positions[i][axis], tolerance)
                    << type.most << " / " << type.divisor;
            }
        }
    }
}

TEST(PositionGrid, KeepsMultiplesOfAPowerOfTwo) {
    const std::vector<Float3> positions{{-0.5F, 0, 3}, {0.375F, 7, 3}, {1024, -7.25F, 3}, {0, 0, 3}};
    const PrimitiveView view = viewOf(positions);
    const std::optional<PositionGrid> grid = findGrid({&view, 1});
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->step, (Float3{0.125F, 0.25F, 0.0F})) << "all z are equal";
    EXPECT_EQ(placeOnGrid(positions, *grid).values, positions);
}

TEST(PositionGrid, PrimitivesOfAMeshShareTheirGrid) {
    std::vector<Float3> left = randomPositions(100, -1.0F, 0.0F);
    std::vector<Float3> right = randomPositions(100, 0.5F, 90.0F);
    const Float3 shared{0.1234567F, 0.7654321F, -0.3333333F};
    left.push_back(shared);
    right.push_back(shared);
    const std::vector<Float3> other = randomPositions(9, 0.0F, 1.0F);
    const PrimitiveView views[] = {viewOf(left, 3), viewOf(right, 3), viewOf(other, 4)};
    const std::vector<GridPositions> packed = packPositions(views, SceneView::VertexForm::Quantized);
    ASSERT_EQ(packed.size(), 3U);
    EXPECT_EQ(packed[0].values.back(), packed[1].values.back());
    EXPECT_NE(packed[2].words[0], packed[0].words[0]) << "another mesh has another grid";
    for (const GridPositions& primitive : packPositions(views, SceneView::VertexForm::Compact)) {
        EXPECT_TRUE(primitive.words.empty()) << "compact keeps what 16 bits would change";
    }
    const std::vector<PrimitiveView> placed = withPositions(views, packed);
    EXPECT_EQ(placed[0].positions.data(), packed[0].values.data());
}

TEST(PositionGrid, WhatMovesOrIsNotFiniteStaysAsItIs) {
    const std::vector<Float3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    std::vector<Float3> broken = positions;
    broken[1][2] = std::numeric_limits<float>::quiet_NaN();
    const PrimitiveView infinite = viewOf(broken);
    EXPECT_FALSE(coverByGrid({&infinite, 1}));
    std::vector<PrimitiveView> views{viewOf(positions), viewOf(positions)};
    const PrimitiveView::MorphTarget target{positions, {}, {}};
    views[1].targets = {&target, 1};
    for (const GridPositions& primitive : packPositions(views, SceneView::VertexForm::Quantized)) {
        EXPECT_TRUE(primitive.words.empty()) << "a seam would open where only one primitive moves";
    }
    views[1].targets = {};
    for (const GridPositions& primitive : packPositions(views, SceneView::VertexForm::Compact)) {
        EXPECT_EQ(primitive.values, positions);
    }
    for (const GridPositions& primitive : packPositions(views, SceneView::VertexForm::Full)) {
        EXPECT_TRUE(primitive.words.empty());
    }
}

}  // namespace
