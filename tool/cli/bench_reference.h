// The picture against which a bench measures errors: it has no approximation, and as many samples as its
// accuracy needs.
#pragma once

#include "cache/store.h"
#include "cli/bench_bed.h"
#include "image/error.h"

#include <cstdint>

namespace glint {

struct ReferenceOptions {
    // The target for the reference's own relative error: 0.003 is 0.3 % of a pixel's light. Rendering stops
    // at maxSamples even if the target is not reached.
    double target = 0.003;
    std::uint32_t maxSamples = 16384;
};

struct Reference {
    LinearImage image;
    bench::Configuration configuration;  // over the base
    std::uint32_t samples = 0;           // a pixel
    double exposure = 0.0;               // stops: automatic, for every measure and picture of the bench
    ImageErrors noise;                   // of the reference itself
    // The root of noise.trimmed. A light that few rays find leaves outliers after any number of samples, and
    // these would otherwise dominate the error.
    double relativeError = 0.0;
    double target = 0.0;   // that was asked for
    bool reached = false;  // the target
    bool cached = false;   // samples were taken from the cache, all or some
    double seconds = 0.0;  // wall clock
};

// Renders blocks of samples with independent random numbers; their spread gives the uncertainty of their
// mean. If `store` has the samples of an earlier run of the same program with the same scene, view and
// device, it continues from them. With a null `store` nothing is kept.
Result<Reference> makeReference(const Console& console, BenchBed& bed, const bench::Facts& facts,
                                const ReferenceOptions& options, CacheStore* store);

}  // namespace glint
