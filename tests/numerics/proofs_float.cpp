// The functions of the claims in single precision.
#include "proof_functions.h"

#define GLINT_REAL float
#include "numerics/glsl.h"

#define GLINT_ENERGY_COMPENSATION 1
#define PROOF(name) [[maybe_unused]] void prove##name(const Real* i, Real* o)
namespace glsl {
namespace {
#include "proofs.inc"
}  // namespace
}  // namespace glsl

namespace glint::numerics {

std::span<const ProbeFunction<float>> floatProofs() {
#define LISTED_PROOF(name) {#name, glsl::prove##name},
    static constexpr ProbeFunction<float> kProofs[] = {
#include "proof_list.inc"
    };
#undef LISTED_PROOF
    return kProofs;
}

}  // namespace glint::numerics
