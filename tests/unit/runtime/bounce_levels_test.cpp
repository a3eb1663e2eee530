// Tests which bounces of a frame are recorded, and that leaving out the others loses no light in the mean.
#include "frame/bounce_levels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace {

using namespace glint;

constexpr std::uint32_t kBounces = 64;
using Depths = std::array<std::uint32_t, BounceLevels::kSlots>;

// Notes a recording of `count` bounces and completes it with paths as deep as `reached`.
void complete(BounceLevels& levels, std::uint64_t recording, std::uint32_t count, std::uint32_t reached) {
    Depths depths{};
    depths[BounceLevels::slotOf(recording)] = reached;
    levels.recorded(recording, count);
    levels.completed(recording, depths);
}

// The weight of a bounce times the probability that it is recorded is 1. All outcomes of the draws are tried.
TEST(BounceLevels, NoBounceLosesLightInTheMean) {
    constexpr std::uint32_t kOutcomes = 16;
    for (std::uint32_t certain = 1; certain <= kBounces; ++certain) {
        std::array<std::uint32_t, kBounces + 1> recorded{};
        for (std::uint32_t random = 0; random < kOutcomes; ++random) {
            const RecordedBounces drawn = drawBounces(certain, kBounces, random);
            EXPECT_EQ(drawn.certain, certain);
            ASSERT_GE(drawn.count, certain);
            ASSERT_LE(drawn.count, kBounces);
            for (std::uint32_t bounce = 1; bounce <= drawn.count; ++bounce) {
                ++recorded[bounce];
            }
        }
        double weight = 1.0;
        for (std::uint32_t bounce = 1; bounce <= kBounces; ++bounce) {
            EXPECT_EQ(weight * recorded[bounce] / kOutcomes, 1.0) << bounce << " of " << certain;
            weight *= weightBehind(bounce, certain);
        }
    }
}

// A draft follows no paths, so it says nothing about their depth.
TEST(BounceLevels, NothingIsLearnedOfADraft) {
    BounceLevels levels;
    levels.skipped(1);
    levels.skipped(2);
    levels.completed(2, Depths{});
    EXPECT_EQ(levels.certainBounces(kBounces), kBounces);
    complete(levels, 3, kBounces, 5);
    EXPECT_EQ(levels.certainBounces(kBounces), 6U);
}

TEST(BounceLevels, DrawsAreEven) {
    constexpr std::uint32_t kDraws = 1U << 16U;
    std::array<std::uint32_t, 4> ones{};
    std::uint32_t allOnes = 0;
    for (std::uint32_t sample = 0; sample < kDraws; ++sample) {
        const std::uint32_t bits = bounceBits(sample % 256, sample / 256);
        for (std::uint32_t bit = 0; bit < ones.size(); ++bit) {
            ones[bit] += bits >> bit & 1U;
        }
        allOnes += (bits & 15U) == 15U ? 1 : 0;
    }
    // Five standard deviations.
    for (const std::uint32_t count : ones) {
        EXPECT_NEAR(count, 0.5 * kDraws, 5 * std::sqrt(0.25 * kDraws));
    }
    EXPECT_NEAR(allOnes, kDraws / 16.0, 5 * std::sqrt(kDraws / 16.0));
}

TEST(BounceLevels, FollowsTheDeepestPaths) {
    BounceLevels levels;
    EXPECT_EQ(levels.certainBounces(kBounces), kBounces) << "nothing is known yet";
    complete(levels, 1, kBounces, 5);
    EXPECT_EQ(levels.certainBounces(kBounces), 6U);
    EXPECT_EQ(levels.certainBounces(BounceLevels::kFewBounces), BounceLevels::kFewBounces);
    complete(levels, 2, 6, 3);
    EXPECT_EQ(levels.certainBounces(kBounces), 6U) << "the deepest of the last recordings counts";
    complete(levels, 3, 8, 8);
    EXPECT_EQ(levels.certainBounces(kBounces), 16U) << "these paths may have gone on";
    complete(levels, 4, kBounces, kBounces);
    EXPECT_EQ(levels.certainBounces(kBounces), kBounces);
    for (std::uint64_t recording = 5; recording < 5 + BounceLevels::kRemembered; ++recording) {
        complete(levels, recording, kBounces, 0);
    }
    EXPECT_EQ(levels.certainBounces(kBounces), 1U) << "no recording that is remembered sent rays";
    levels.reset();
    EXPECT_EQ(levels.certainBounces(kBounces), kBounces);
}

// Completed recordings are read late, and some not before their slot was taken.
TEST(BounceLevels, ReadsTheSlotsOfCompletedRecordings) {
    BounceLevels levels;
    Depths depths{};
    for (std::uint64_t recording = 1; recording <= 3; ++recording) {
        levels.recorded(recording, kBounces);
        depths[BounceLevels::slotOf(recording)] = static_cast<std::uint32_t>(10 * recording);
    }
    levels.completed(2, depths);
    EXPECT_EQ(levels.certainBounces(kBounces), 21U) << "the third is in flight";
    levels.completed(3, depths);
    EXPECT_EQ(levels.certainBounces(kBounces), 31U);

    BounceLevels late;
    for (std::uint64_t recording = 1; recording <= BounceLevels::kSlots + 2; ++recording) {
        late.recorded(recording, kBounces);
        depths[BounceLevels::slotOf(recording)] = recording <= 2 ? 40 : 4;
    }
    depths[BounceLevels::slotOf(1)] = 50;  // that of a later recording, which is in flight
    late.completed(2, depths);
    EXPECT_EQ(late.certainBounces(kBounces), kBounces) << "their slots are others' now";
    late.completed(3, depths);
    EXPECT_EQ(late.certainBounces(kBounces), 5U);
}

}  // namespace
