// The probes in double precision.
#include "evaluate.h"

#define GLINT_REAL double
#include "numerics/glsl.h"

#define GLINT_ENERGY_COMPENSATION 1
#define PROBE(name) [[maybe_unused]] void probe##name(const Real* i, Real* o)
namespace glsl {
namespace {
#include "probes.inc"
}  // namespace
}  // namespace glsl

namespace glint::numerics {

std::span<const ProbeFunction<double>> doubleProbes() {
#define LISTED_PROBE(name) {#name, glsl::probe##name},
    static constexpr ProbeFunction<double> kProbes[] = {
#include "probe_list.inc"
    };
#undef LISTED_PROBE
    return kProbes;
}

}  // namespace glint::numerics
