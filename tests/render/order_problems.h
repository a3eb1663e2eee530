// Hits to order: how many go to each bucket, and in which sequence.
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

// Makes a problem; the same arguments give the same problem. Some hits of bucket 0 are not misses, but have
// shader IDs that no case has.
OrderProblem makeProblem(Spread spread, std::uint32_t bucketCount, std::uint32_t rays);

// Returns the bucket of a hit.
std::uint32_t bucketOf(const OrderProblem& problem, std::size_t hit, std::uint32_t bucketCount);

}  // namespace glint::testing
