// The functions of the claims in the precision GLINT_REAL.
#include "proof_functions.h"

#include "numerics/glsl.h"

#define GLINT_ENERGY_COMPENSATION 1
#define PROOF(name) [[maybe_unused]] void prove##name(const Real* i, Real* o)
namespace glsl {
namespace {
#include "proofs.inc"
}  // namespace
}  // namespace glsl

namespace glint::numerics {

template <>
std::span<const ProbeFunction<GLINT_REAL>> proofFunctions<GLINT_REAL>() {
#define LISTED_PROOF(name) {#name, glsl::prove##name},
    static constexpr ProbeFunction<GLINT_REAL> kProofs[] = {
#include "proof_list.inc"
    };
#undef LISTED_PROOF
    return kProofs;
}

}  // namespace glint::numerics
