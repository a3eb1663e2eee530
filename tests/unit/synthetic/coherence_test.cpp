// Tests the measure of coherence at its extremes, and that it orders scenes as intended.
#include "synthetic/cases_scene.h"

#include <gtest/gtest.h>

namespace glint::synthetic {
namespace {

double shareOf(int cases, synthetic::Coherence coherence, std::uint32_t width = 512,
               synthetic::Shares shares = synthetic::Shares::Uniform) {
    return coherentShareOf({cases, synthetic::Cost::Cheap, coherence, shares}, width, width / 2);
}

TEST(CoherentShare, IsOneWhereThereIsOneCase) {
    EXPECT_EQ(shareOf(1, synthetic::Coherence::Coherent), 1.0);
    EXPECT_EQ(shareOf(1, synthetic::Coherence::Incoherent), 1.0);
}

TEST(CoherentShare, IsNoneWhereChanceDecides) {
    for (const int cases : {2, 4, 64, 256}) {
        EXPECT_NEAR(shareOf(cases, synthetic::Coherence::Incoherent), 0.0, 0.02) << cases;
        EXPECT_NEAR(shareOf(cases, synthetic::Coherence::Incoherent, 512, synthetic::Shares::Zipf), 0.0, 0.02)
            << cases;
    }
}

TEST(CoherentShare, GrowsWithThePicture) {
    // There are blocks of 8 x 4 pixels in a grid of 2 x 2 cases, so almost no block crosses its lines.
    EXPECT_GT(shareOf(4, synthetic::Coherence::Coherent, 1024), 0.95);
    EXPECT_GT(shareOf(256, synthetic::Coherence::Coherent, 4096), 0.9);
    EXPECT_LT(shareOf(256, synthetic::Coherence::Coherent, 64),
              shareOf(256, synthetic::Coherence::Coherent, 512));
    // A case is 16 x 8 blocks of a picture of 128 x 64 blocks, and its edges are edges of blocks.
    EXPECT_EQ(shareOf(64, synthetic::Coherence::Coherent, 1024), 1.0);
}

}  // namespace
}  // namespace glint::synthetic
