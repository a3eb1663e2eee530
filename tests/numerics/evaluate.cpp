// The probes in the precision GLINT_REAL.
#include "evaluate.h"

#include "numerics/glsl.h"

#define GLINT_ENERGY_COMPENSATION 1
#define PROBE(name) [[maybe_unused]] void probe##name(const Real* i, Real* o)
namespace glsl {
namespace {
#include "probes.inc"
}  // namespace
}  // namespace glsl

namespace glint::numerics {

template <>
std::span<const ProbeFunction<GLINT_REAL>> probeFunctions<GLINT_REAL>() {
#define LISTED_PROBE(name) {#name, glsl::probe##name},
    static constexpr ProbeFunction<GLINT_REAL> kProbes[] = {
#include "probe_list.inc"
    };
#undef LISTED_PROBE
    return kProbes;
}

}  // namespace glint::numerics
