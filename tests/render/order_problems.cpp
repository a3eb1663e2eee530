#include "render/order_problems.h"

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace glint::testing {

namespace {

constexpr std::uint32_t kSeed = 5;
// Sizes of pictures in pixels: a row, a tile's edge, and the distance between the centres of regions.
constexpr std::uint32_t kWidth = 4096;
constexpr std::uint32_t kTile = 8;
constexpr std::uint32_t kRegion = 40;

// Returns 32 bits that are unrelated to those of neighbouring values: the finaliser of MurmurHash3.
std::uint32_t scramble(std::uint32_t value) {
    value = (value ^ value >> 16U) * 0x85EBCA6BU;
    value = (value ^ value >> 13U) * 0xC2B2AE35U;
    return value ^ value >> 16U;
}

// Returns the number of a pixel's region, which belongs to the nearest centre; each cell of a grid has one
// centre (Worley 1996).
std::uint32_t regionOf(std::uint32_t x, std::uint32_t y) {
    std::uint32_t nearest = 0;
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (std::uint32_t cell = 0; cell < 9; ++cell) {
        // The cell is counted from one, so that no neighbour is below 0.
        const std::uint32_t cellX = x / kRegion + cell % 3;
        const std::uint32_t cellY = y / kRegion + cell / 3;
        const std::uint32_t region = scramble(cellX + 0x10001U * cellY);
        const std::int64_t dx = std::int64_t{cellX} * kRegion + region % kRegion - (x + kRegion);
        const std::int64_t dy = std::int64_t{cellY} * kRegion + (region >> 8U) % kRegion - (y + kRegion);
        if (const std::int64_t distance = dx * dx + dy * dy; distance < least) {
            least = distance;
            nearest = region;
        }
    }
    return nearest;
}

std::uint32_t regionOfRay(std::uint32_t ray) {
    const std::uint32_t tile = ray / (kTile * kTile);
    constexpr std::uint32_t kTilesOfRow = kWidth / kTile;
    return regionOf(tile % kTilesOfRow * kTile + ray % kTile,
                    tile / kTilesOfRow * kTile + ray % (kTile * kTile) / kTile);
}

class Buckets {
public:
    Buckets(Spread spread, std::uint32_t count) : spread_(spread), count_(count) {
        double sum = 0.0;
        for (std::uint32_t bucket = 0; bucket < count; ++bucket) {
            sum += 1.0 / (bucket + 1);
            sums_.push_back(sum);
        }
    }

    std::uint32_t of(std::uint32_t ray) {
        switch (spread_) {
            case Spread::OneBucket:
                return count_ - 1;
            case Spread::InTurn:
                return (count_ - 1) - ray % count_;
            case Spread::Random:
                return below(count_);
            case Spread::Zipf: {
                const auto found = std::ranges::upper_bound(sums_, unit() * sums_.back());
                return std::min(static_cast<std::uint32_t>(found - sums_.begin()), count_ - 1);
            }
            case Spread::Picture:
                return regionOfRay(ray) % count_;
        }
        return 0;
    }
    // The standard library's distributions differ between implementations. The bias of the remainder is below
    // 2^-50.
    std::uint32_t below(std::uint32_t limit) {
        return static_cast<std::uint32_t>(random_() % limit);
    }

private:
    double unit() {
        return static_cast<double>(random_() >> 11U) * 0x1p-53;
    }

    Spread spread_;
    std::uint32_t count_;
    std::vector<double> sums_;  // of shares, by bucket
    std::mt19937_64 random_{kSeed};
};

}  // namespace

const char* nameOf(Spread spread) {
    switch (spread) {
        case Spread::OneBucket:
            return "one bucket";
        case Spread::InTurn:
            return "in turn";
        case Spread::Random:
            return "random";
        case Spread::Zipf:
            return "Zipf";
        case Spread::Picture:
            return "picture";
    }
    return "unknown";
}

OrderProblem makeProblem(Spread spread, std::uint32_t bucketCount, std::uint32_t rays) {
    const std::uint32_t cases = bucketCount - 1;
    OrderProblem problem;
    // Geometries count in the opposite direction to buckets, so that neither can be mistaken for the other.
    for (std::uint32_t i = 0; i < cases; ++i) {
        problem.shaderIds.push_back(cases - 1 - i);
    }
    problem.shaderIds.push_back(cases);
    problem.shaderIds.push_back(0xFFFFFFFF);
    Buckets buckets(spread, bucketCount);
    for (std::uint32_t ray = 0; ray < rays; ++ray) {
        const std::uint32_t bucket = buckets.of(ray);
        if (bucket > 0) {
            problem.hits.push_back(cases - bucket);
        } else {
            // Every fourth ray gets one of the two in turn.
            problem.hits.push_back(ray % 4 == 0 ? cases + ray / 4 % 2 : gpu::kMissGeometry);
        }
    }
    return problem;
}

std::uint32_t bucketOf(const OrderProblem& problem, std::size_t hit, std::uint32_t bucketCount) {
    const std::uint32_t geometry = problem.hits[hit];
    if (geometry == gpu::kMissGeometry) {
        return 0;
    }
    const std::uint32_t shaderId = problem.shaderIds[geometry];
    return shaderId < bucketCount - 1 ? shaderId + 1 : 0;
}

}  // namespace glint::testing
