// Tests boxes of deformed meshes, and the rules that depend on them.
#include "data/motion_bounds.h"
#include "scene/top_level.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace glint {
namespace {

Box box(double x, double y, double z, double size) {
    return {{x, y, z}, {x + size, y + size, z + size}};
}

void expectBox(const Box& actual, const Box& expected) {
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(actual.min[i], expected.min[i], 1e-6) << "axis " << i;
        EXPECT_NEAR(actual.max[i], expected.max[i], 1e-6) << "axis " << i;
    }
}

TEST(MotionBounds, AreThoseOfTheMeshAtRest) {
    const std::vector<std::array<float, 3>> positions{{0, 0, 0}, {1, 2, 3}};
    PrimitiveView view;
    view.positions = positions;
    const MotionBounds bounds(std::span(&view, 1));
    InstanceView instance;
    instance.objectToWorld = {2, 0, 0, 10, 0, 1, 0, 0, 0, 0, -1, 0};
    expectBox(bounds.at(instance), {{10, 0, -3}, {12, 2, 0}});
}

TEST(MotionBounds, HoldMorphedAndSkinnedVertices) {
    const std::vector<std::array<float, 3>> positions{{0, 0, 0}, {1, 0, 0}};
    const std::vector<std::array<float, 3>> differences{{0, 4, 0}, {0, -2, 0}};
    const std::vector<PrimitiveView::MorphTarget> targets{{differences, {}, {}}};
    const std::vector<std::uint16_t> joints{0, 1};
    const std::vector<float> jointWeights{1.0F, 1.0F};
    PrimitiveView view;
    view.positions = positions;
    view.targets = targets;
    const std::vector<float> weights{-0.5F};
    InstanceView instance;
    instance.morphWeights = weights;
    expectBox(MotionBounds(std::span(&view, 1)).at(instance), {{0, -2, 0}, {1, 1, 0}});
    // The second vertex follows a joint that lifts it by 5.
    view.joints = joints;
    view.jointWeights = jointWeights;
    const std::vector<std::array<float, 12>> rows{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                                                  {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5}};
    instance.joints = rows;
    const Box skinned = MotionBounds(std::span(&view, 1)).at(instance);
    expectBox(skinned, {{0, -2, 0}, {1, 1, 5}});
}

TEST(MotionRules, ABottomLevelIsRefittedUntilItIsWorn) {
    BlasHistory history;
    history.apply(BuildAction::Build, 10.0);
    EXPECT_EQ(history.next(false, 10.0), BuildAction::Keep);
    EXPECT_EQ(history.next(true, 20.0), BuildAction::Refit);
    EXPECT_EQ(history.next(true, 20.1), BuildAction::Build) << "its surface has doubled";
    for (std::uint32_t i = 0; i < kMaxRefits; ++i) {
        ASSERT_EQ(history.next(true, 10.0), BuildAction::Refit) << i;
        history.apply(BuildAction::Refit, 10.0);
    }
    EXPECT_EQ(history.next(true, 10.0), BuildAction::Build);
    EXPECT_EQ(history.next(false, 10.0), BuildAction::Keep);
    history.apply(BuildAction::Build, 30.0);
    EXPECT_EQ(history.next(true, 60.0), BuildAction::Refit) << "counts from the last build";
}

// Two instances of a TLAS that may be updated, and is built.
struct TwoPlaced {
    TwoPlaced() {
        move(0, start[0]);
        move(1, start[1]);
        build();
    }
    void move(std::uint32_t geometry, const Box& to) {
        VkAccelerationStructureInstanceKHR placed{};
        placed.instanceCustomIndex = geometry & 0xFFFFFFU;
        placed.transform.matrix[0][3] = static_cast<float>(to.min[0]);
        placed.transform.matrix[1][3] = static_cast<float>(to.min[1]);
        top.set(placed, to);
    }
    BuildAction next(MotionView::Builds builds = MotionView::Builds::ByRule) const {
        return top.next(false, builds);
    }
    void build() {
        top.prepare(BuildAction::Build);
        top.apply(BuildAction::Build);
    }

    // The diagonals are 1.73 and 3.46 m.
    const std::array<Box, 2> start{box(0, 0, 0, 1), box(5, 0, 0, 2)};
    TopLevel top{true, nullptr};
};

TEST(MotionRules, TheTopLevelIsUpdatedUntilAnInstanceLeaves) {
    EXPECT_EQ(TwoPlaced().next(), BuildAction::Keep);
    EXPECT_EQ(TwoPlaced().top.next(true, MotionView::Builds::ByRule), BuildAction::Refit);
    const auto after = [](std::uint32_t instance, const Box& to) {
        TwoPlaced placed;
        placed.move(instance, to);
        return placed.next();
    };
    EXPECT_EQ(after(0, box(0, 0, 0, 1)), BuildAction::Keep);
    EXPECT_EQ(after(0, box(1.7, 0, 0, 1)), BuildAction::Refit);
    EXPECT_EQ(after(0, box(1.8, 0, 0, 1)), BuildAction::Build);
    EXPECT_EQ(after(1, box(5, 3.4, 0, 2)), BuildAction::Refit);
    EXPECT_EQ(after(1, box(5, 3.5, 0, 2)), BuildAction::Build);
    TwoPlaced placed;
    for (std::uint32_t i = 0; i < kMaxRefits; ++i) {
        placed.move(0, box(0.001 * i, 0, 0, 1));
        ASSERT_NE(placed.next(), BuildAction::Build) << i;
        placed.top.apply(BuildAction::Refit);
    }
    placed.move(0, box(0.5, 0, 0, 1));
    EXPECT_EQ(placed.next(), BuildAction::Build);
    EXPECT_EQ(placed.next(MotionView::Builds::Refit), BuildAction::Refit);
    placed.build();
    EXPECT_EQ(placed.next(MotionView::Builds::Rebuild), BuildAction::Keep);
}

TEST(MotionRules, InstancesThatComeOrGoNeedABuild) {
    TwoPlaced placed;
    placed.move(7, box(9, 0, 0, 1));
    EXPECT_EQ(placed.next(MotionView::Builds::Refit), BuildAction::Build);
    placed.build();
    placed.top.remove(0);
    EXPECT_EQ(placed.next(), BuildAction::Build);
    placed.build();
    EXPECT_EQ(placed.top.records().count(), 2U);
    // The last one has its place now, and is still found.
    placed.move(7, box(9.5, 0, 0, 1));
    EXPECT_EQ(placed.top.records().count(), 2U);
    EXPECT_EQ(placed.next(), BuildAction::Refit);
    placed.top.apply(BuildAction::Refit);
    placed.move(7, box(11, 0, 0, 1));
    EXPECT_EQ(placed.next(), BuildAction::Build) << "it is far from its place at the last build";
    placed.build();
    placed.move(7, box(12, 0, 0, 1));
    EXPECT_EQ(placed.next(), BuildAction::Refit) << "of which only its own box was new";
    TopLevel fixed(false, nullptr);
    fixed.set({}, box(0, 0, 0, 1));
    fixed.apply(BuildAction::Build);
    VkAccelerationStructureInstanceKHR moved{};
    moved.transform.matrix[0][3] = 0.01F;
    fixed.set(moved, box(0.01, 0, 0, 1));
    EXPECT_EQ(fixed.next(false, MotionView::Builds::ByRule), BuildAction::Build);
}

}  // namespace
}  // namespace glint
