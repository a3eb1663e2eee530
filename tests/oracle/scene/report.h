// Comparisons with the scene renderer, for people and scripts.
#pragma once

#include "oracle/scene/difference.h"

#include <cstdint>
#include <string>

namespace glint::oracle {

// Lines of text; with the `list` worst pixels.
std::string toText(const Difference& difference, std::uint32_t list);

// `rays`: of the truth, a pixel; `samples`: of the device.
std::string toJson(const Difference& difference, std::uint32_t rays, std::uint32_t samples);

}  // namespace glint::oracle
