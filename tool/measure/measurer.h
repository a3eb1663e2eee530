// Measures the reference of a bench and its points, in rounds.
#pragma once

#include <glint/measure/bed.h>
#include <glint/measure/observer.h>
#include <glint/measure/point.h>
#include <glint/measure/report.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace glint::compiler {
class CacheStore;
}  // namespace glint::compiler

namespace glint::measure {

// The time for which a GPU renders before a round, and before each measured time. Its clocks fall while the
// host works between rounds, and take a while to rise again.
inline constexpr std::chrono::milliseconds kRoundWarmUp{250};
inline constexpr std::chrono::milliseconds kWarmUp{10};

// Returns a permutation of [0, count), the order of a round, so that no configuration always follows the same
// other one. The result depends only on the state of `random`, with every standard library.
inline std::vector<std::size_t> shuffled(std::size_t count, std::mt19937_64& random) {
    // The shuffle of Fisher and Yates, because std::shuffle differs between libraries.
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i) {
        std::swap(order[i - 1], order[random() % i]);
    }
    return order;
}

struct ReferenceOptions {
    // The target for the reference's own relative error: 0.003 is 0.3 % of a pixel's light. Rendering stops
    // at maxSamples even if the target is not reached.
    double target = 0.003;
    std::uint32_t maxSamples = 16384;
};

// Renders blocks of samples with independent random numbers; their spread gives the uncertainty of their
// mean. If `store` has the samples of an earlier run of the same program with the same scene, view and
// device, it continues from them. With a null `store` nothing is kept.
Result<Reference> makeReference(const Observer& observer, BenchBed& bed, const compiler::BenchFacts& facts,
                                const ReferenceOptions& options, compiler::CacheStore* store);

struct MeasureOptions {
    std::uint32_t rounds = 9;
    std::uint32_t seed = 1;   // of the order; round r renders with random numbers of its own, seed + r
    std::uint32_t batch = 8;  // configurations that are mounted at a time, besides the default
    const FilterMaker* filter = nullptr;  // of points with filteredFrames
    ErrorMetric metric = ErrorMetric::RelMse;
};

// The picture against which errors are measured.
struct Truth {
    const LinearImage& image;
    double exposure = 0.0;  // stops
};

// Measures in batches, each of which has the default in every round. Ratios are relative to the default in
// the same round, so a machine that slows down or a clock that drifts does not distort them. Before its
// rounds a configuration renders once, so that its pipelines are ready. On a GPU it also renders for a few
// milliseconds before each picture, so that clocks are up.
class Measurer {
public:
    // `base` is the default. Every batch adds times to it, and the first batch adds its errors. All arguments
    // must outlive the result. Has the errors of BenchBed::mount().
    static Result<Measurer> create(const Observer& observer, BenchBed& bed, const MeasureOptions& options,
                                   const Truth& truth, BenchPoint& base);

    // Fills in the measurements of `points`. A point that can't be mounted is reported as the warning
    // "bench-point" and has no measurements.
    Status measure(std::span<BenchPoint> points);

private:
    Measurer(const Observer& observer, BenchBed& bed, const MeasureOptions& options, const Truth& truth)
        : observer_(observer), bed_(bed), options_(options), truth_(truth) {}

    // A configuration on the device, and its picture of the current round.
    struct Entry {
        BenchPoint* point = nullptr;
        Mount mount;
        Exposure exposure;
        LinearImage mean;  // of its pictures so far
    };
    Result<Entry> mount(BenchPoint& point) const;
    Status measureBatch(std::span<Entry> entries, std::uint64_t seed);
    Status warmUp(const Entry& entry, std::chrono::milliseconds time) const;
    Status expose(Entry& entry, std::uint32_t seed) const;
    void keep(std::span<Entry*> entries, std::uint32_t round);

    const Observer& observer_;
    BenchBed& bed_;
    MeasureOptions options_;
    const Truth& truth_;
    std::vector<Entry> baseEntry_;  // the one of the default
    bool baseIsKnown_ = false;      // its errors
    std::uint64_t batches_ = 0;
};

}  // namespace glint::measure
