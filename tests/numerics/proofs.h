// The list of claims: each function of shaders/ that needs no device, its documented domain, and the ranges
// in which its results must lie.
#pragma once

#include "verify/prover.h"

#include <glint/result.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint::numerics {

struct Proof {
    std::string_view name;      // in proofs_*.glsl
    std::string_view function;  // for people
    std::string_view bound;     // what is claimed, for people
    verify::Claim claim;
    std::uint64_t boxes = 2'000;  // at least; the nightly run takes more
};

// A function about which nothing is claimed, and why.
struct Unclaimed {
    std::string_view function;
    std::string_view reason;
};

const std::vector<Proof>& allProofs();
const std::vector<Unclaimed>& unclaimedFunctions();

// The programs of claims, in the order of `proofs`: what the compiler makes of their functions. Errors are
// those of compileShader() and executeSymbolically().
Result<std::vector<verify::Program>> compileProofs(const std::vector<Proof>& proofs);

// A claim about code of its own: statements that read i and write o. Errors as above.
Result<verify::Program> compileClaim(std::string_view statements);

// Whether a second on one core proves it: what continuous integration proves.
bool isProvedQuickly(const Proof& proof);

inline constexpr double kLargest = verify::kLargestSingle;

}  // namespace glint::numerics
