#include "render/order_problems.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace glint::testing {

namespace {

constexpr std::uint32_t kSeed = 5;
constexpr std::uint32_t kMeanRun = 32;

class Buckets {
public:
    Buckets(Spread spread, std::uint32_t count) : spread_(spread), count_(count) {}

    std::uint32_t of(std::uint32_t ray) {
        switch (spread_) {
            case Spread::OneBucket:
                return count_ - 1;
            case Spread::InTurn:
                return (count_ - 1) - ray % count_;
            case Spread::Random:
                return below(count_);
            case Spread::Skewed: {
                const double power = std::pow(static_cast<double>(count_), unit());
                return std::min(static_cast<std::uint32_t>(power) - 1, count_ - 1);
            }
            case Spread::Runs:
                if (below(kMeanRun) == 0 || ray == 0) {
                    run_ = below(count_);
                }
                return run_;
        }
        return 0;
    }
    // The standard library's distributions are not the same everywhere; the bias of the remainder is below
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
    std::uint32_t run_ = 0;
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
        case Spread::Skewed:
            return "skewed";
        case Spread::Runs:
            return "runs";
    }
    return "unknown";
}

OrderProblem makeProblem(Spread spread, std::uint32_t bucketCount, std::uint32_t rays) {
    const std::uint32_t cases = bucketCount - 1;
    OrderProblem problem;
    // Geometries count the other way than buckets, so that neither passes for the other.
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
            // Every fourth, by turns.
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
