// Tests orders for drivers that halve the leaves they are given: the trees that result, without a device.
#include "data/traversal_order.h"
#include "support/halved_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace glint {
namespace {

using test::halvedTreeCost;

std::vector<std::uint32_t> asTheyCome(std::size_t count) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    return order;
}

LeafBox boxAround(const std::array<float, 3>& centre, float size) {
    LeafBox box;
    box.extend(std::array<float, 3>{centre[0] - size, centre[1] - size, centre[2] - size});
    box.extend(std::array<float, 3>{centre[0] + size, centre[1] + size, centre[2] + size});
    return box;
}

// A hilly square of width x width quads. Its triangles are in the order of the rows.
struct Hills {
    explicit Hills(std::uint32_t width) {
        for (std::uint32_t y = 0; y <= width; ++y) {
            for (std::uint32_t x = 0; x <= width; ++x) {
                const float u = static_cast<float>(x) / static_cast<float>(width);
                const float v = static_cast<float>(y) / static_cast<float>(width);
                positions.push_back({u, 0.1F * std::sin(9.0F * u) * std::cos(7.0F * v), v});
            }
        }
        for (std::uint32_t y = 0; y < width; ++y) {
            for (std::uint32_t x = 0; x < width; ++x) {
                const std::uint32_t corner = y * (width + 1) + x;
                triangles.push_back({corner, corner + width + 1, corner + 1});
                triangles.push_back({corner + 1, corner + width + 1, corner + width + 2});
            }
        }
    }

    void shuffle() {
        std::ranges::shuffle(triangles, std::mt19937(5));
    }
    std::vector<LeafBox> boxes() const {
        std::vector<LeafBox> all;
        for (const auto& corners : triangles) {
            LeafBox& box = all.emplace_back();
            for (const std::uint32_t corner : corners) {
                box.extend(positions[corner]);
            }
        }
        return all;
    }
    PrimitiveView view() const {
        PrimitiveView view;
        view.positions = positions;
        view.indices = {triangles.front().data(), 3 * triangles.size()};
        return view;
    }

    std::vector<std::array<float, 3>> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

TEST(LeafOrder, HasEachLeafOnce) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-1.0F, 1.0F);
    for (std::size_t count = 0; count < 70; ++count) {
        std::vector<LeafBox> leaves;
        for (std::size_t i = 0; i < count; ++i) {
            // Some leaves are at the same place.
            const float x = i % 7 == 0 ? 0.0F : place(random);
            leaves.push_back(boxAround({x, place(random) * x, 0.0F}, 0.01F));
        }
        std::vector<std::uint32_t> order = halvingOrder(leaves, 1);
        std::ranges::sort(order);
        EXPECT_EQ(order, asTheyCome(count));
    }
}

// The cost of the tree decides how long rays take. It must not depend on the order that the leaves had.
TEST(LeafOrder, ShuffledLeavesMakeATreeAsSmall) {
    Hills hills(64);
    const std::vector<LeafBox> leaves = hills.boxes();
    hills.shuffle();
    const std::vector<LeafBox> shuffled = hills.boxes();
    const double rowByRow = halvedTreeCost(leaves, asTheyCome(leaves.size()));
    const double random = halvedTreeCost(shuffled, asTheyCome(shuffled.size()));
    const double ordered = halvedTreeCost(leaves, halvingOrder(leaves, 1));
    const double orderedShuffled = halvedTreeCost(shuffled, halvingOrder(shuffled, 1));
    EXPECT_GT(random, 50.0 * rowByRow) << "the shuffled input is no problem to solve";
    EXPECT_LT(ordered, rowByRow);
    EXPECT_LT(orderedShuffled, 1.02 * ordered);
}

TEST(LeafOrder, DoesNotDependOnThreads) {
    Hills hills(160);
    hills.shuffle();
    const std::vector<LeafBox> leaves = hills.boxes();
    const std::vector<std::uint32_t> alone = halvingOrder(leaves, 1);
    EXPECT_EQ(halvingOrder(leaves, 2), alone);
    EXPECT_EQ(halvingOrder(leaves, 7), alone);
}

// A few triangles of a floor among many small ones are kept apart.
TEST(LeafOrder, LargeLeavesDoNotWidenTheOthers) {
    Hills hills(32);
    std::vector<LeafBox> leaves = hills.boxes();
    const double alone = halvedTreeCost(leaves, halvingOrder(leaves, 1));
    for (int i = 0; i < 8; ++i) {
        leaves.insert(leaves.begin() + 200 * i, boxAround({0.5F, 0.0F, 0.5F}, 0.5F));
    }
    const double together = halvedTreeCost(leaves, halvingOrder(leaves, 1));
    // Every ray meets them and the nodes above them: 8 leaves, 7 nodes and some 8 levels.
    EXPECT_LT(together, alone + 8 + 7 + 10);
}

TEST(LeafOrder, PairsOfFewAreTheSmallest) {
    const auto at = [](float x) { return boxAround({x, 0.0F, 0.0F}, 0.1F); };
    const std::vector<LeafBox> three{at(0.0F), at(9.0F), at(0.3F)};
    const std::vector<std::uint32_t> pair = halvingOrder(three, 1);
    EXPECT_EQ(pair.back(), 1U);
    const std::vector<LeafBox> four{at(0.0F), at(9.0F), at(0.3F), at(8.0F)};
    const std::vector<std::uint32_t> pairs = halvingOrder(four, 1);
    EXPECT_EQ(std::min(pairs[0], pairs[1]) + std::max(pairs[0], pairs[1]), 2U);
}

// The driver merges the boxes of two halves by comparisons in which a NaN on the right wins, so a NaN must
// not get there.
TEST(LeafOrder, WhatIsNotFiniteComesFirst) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (const std::size_t count : {std::size_t{2}, std::size_t{3}, std::size_t{4}, std::size_t{1000}}) {
        Hills hills(32);
        std::vector<LeafBox> leaves = hills.boxes();
        leaves.resize(count);
        LeafBox infinite = leaves.back();
        infinite.extend(std::array<float, 3>{0.0F, kInfinity, 0.0F});
        leaves.back() = infinite;
        leaves[count / 2] = {};
        const std::size_t voids = count / 2 == count - 1 ? 1 : 2;
        const std::vector<std::uint32_t> order = halvingOrder(leaves, 1);
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_EQ(leaves[order[i]].isVoid(), i < voids) << count << " leaves, place " << i;
        }
    }
    Hills hills(8);
    hills.positions[3][1] = kNan;
    const std::vector<std::vector<std::uint32_t>> ordered =
        orderedTriangles(std::array{hills.view()}, {1U << 20U, 1}, halvingOrder);
    // Three triangles of a row have that corner.
    for (std::size_t i = 0; i < ordered[0].size(); i += 3) {
        const bool has = std::ranges::count(std::span(ordered[0]).subspan(i, 3), 3U) > 0;
        EXPECT_EQ(has, i < 9) << i;
    }
}

// Corners keep their order, which barycentrics and facing depend on, and each piece of a primitive is halved
// by itself.
TEST(TraversalOrder, PermutesWholeTriangles) {
    Hills hills(24);
    hills.shuffle();
    const std::array<PrimitiveView, 2> primitives{hills.view(), PrimitiveView{}};
    constexpr std::uint64_t kPiece = 500;
    for (const std::uint64_t capacity : {std::uint64_t{1} << 24U, kPiece}) {
        const std::vector<std::vector<std::uint32_t>> ordered =
            orderedTriangles(primitives, {capacity, 1}, halvingOrder);
        ASSERT_EQ(ordered.size(), 2U);
        EXPECT_TRUE(ordered[1].empty());
        std::vector<std::array<std::uint32_t, 3>> found;
        for (std::size_t i = 0; i < ordered[0].size(); i += 3) {
            found.push_back({ordered[0][i], ordered[0][i + 1], ordered[0][i + 2]});
        }
        Hills piece = hills;
        piece.triangles.assign(found.begin(), found.begin() + kPiece);
        const std::vector<LeafBox> leaves = piece.boxes();
        const double cost = halvedTreeCost(leaves, asTheyCome(kPiece));
        if (capacity == kPiece) {
            EXPECT_LT(cost, 1.02 * halvedTreeCost(leaves, halvingOrder(leaves, 1)));
        }
        std::ranges::sort(found);
        std::vector<std::array<std::uint32_t, 3>> given = hills.triangles;
        std::ranges::sort(given);
        EXPECT_EQ(found, given);
    }
}

// A primitive that shares an array of vertices is placed only by the vertices that it uses.
TEST(TraversalOrder, BoxesLeaveOtherVerticesOut) {
    Hills hills(2);
    hills.positions.push_back({1e6F, 1e6F, 1e6F});
    const PrimitiveView view = hills.view();
    const Box box = boxOf(view, view.indices);
    EXPECT_FALSE(box.isEmpty());
    EXPECT_LT(box.max[0], 10.0);
    hills.positions[0][1] = NAN;
    EXPECT_TRUE(boxOf(hills.view(), view.indices).isEmpty());
}

}  // namespace
}  // namespace glint
