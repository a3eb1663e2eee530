// The picture that a bench measures errors against: no approximation, and samples until it is certain.
#pragma once

#include "cache/store.h"
#include "cli/bench_bed.h"
#include "image/error.h"

#include <cstdint>

namespace glint {

struct ReferenceOptions {
    // The reference's own relative error at most: 0.003 is 0.3 % of a pixel's light. Work ends at maxSamples
    // whatever it is then.
    double target = 0.003;
    std::uint32_t maxSamples = 16384;
};

struct Reference {
    LinearImage image;
    bench::Configuration configuration;  // over the base
    std::uint32_t samples = 0;           // a pixel
    double exposure = 0.0;               // stops: automatic, for every measure and picture of the bench
    ImageErrors noise;                   // of the reference itself
    // Root of noise.trimmed: a light that few rays find leaves outliers after any number of samples, which
    // would decide alone.
    double relativeError = 0.0;
    double target = 0.0;   // that was asked for
    bool reached = false;  // the target
    bool cached = false;   // samples were taken from the cache, all or some
    double seconds = 0.0;  // wall clock
};

// Renders blocks of samples with random numbers of their own, whose spread says how certain their mean is.
// What `store` keeps of an earlier run of the same program on the same scene, view and device is continued;
// null: nothing is kept.
Result<Reference> makeReference(const Console& console, BenchBed& bed, const bench::Facts& facts,
                                const ReferenceOptions& options, CacheStore* store);

}  // namespace glint
