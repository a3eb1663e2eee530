// Hits to put in order: how many go to which bucket, and in which sequence.
#pragma once

#include "render/order_kernel.h"

#include <cstdint>

namespace glint::testing {

enum class Spread {
    OneBucket,  // every hit in the last
    InTurn,     // each bucket once, then again: no two neighbours share one
    Random,
    Zipf,     // the n-th bucket has 1 / n of the hits of the first
    Picture,  // regions of some 40 pixels' width, in tiles of 8 x 8 pixels: as rays of a picture come
};
inline constexpr Spread kSpreads[] = {Spread::OneBucket, Spread::InTurn, Spread::Random, Spread::Zipf,
                                      Spread::Picture};

const char* nameOf(Spread spread);

// Some hits of bucket 0 are no misses, but have shader IDs that no case has. The same for the same arguments.
OrderProblem makeProblem(Spread spread, std::uint32_t bucketCount, std::uint32_t rays);

// Where a hit belongs.
std::uint32_t bucketOf(const OrderProblem& problem, std::size_t hit, std::uint32_t bucketCount);

}  // namespace glint::testing
