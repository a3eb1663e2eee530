// Included before basisu_transcoder.cpp of Basis Universal 2.0, which without XUASTC and UASTC HDR still
// names what only those have: a constant and a function that is then called by nothing.
#pragma once

#include <cstdint>

namespace basist {

namespace arith_fastbits_f32 {
constexpr int TABLE_SIZE = 1;
}

namespace astc_ldr_t {
template <typename Color>
void decode_endpoints(std::uint32_t, const std::uint8_t*, std::uint32_t, Color&, Color&, float* = nullptr) {}
}  // namespace astc_ldr_t

}  // namespace basist
