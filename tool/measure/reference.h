// Renders the picture against which a bench measures errors.
#pragma once

#include <glint/measure/bed.h>
#include <glint/measure/observer.h>
#include <glint/measure/report.h>

#include <cstdint>

namespace glint::compiler {
class CacheStore;
}  // namespace glint::compiler

namespace glint::measure {

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

}  // namespace glint::measure
