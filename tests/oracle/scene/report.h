// Formats comparisons with the scene renderer, for people and scripts.
#pragma once

#include "oracle/scene/difference.h"

#include <cstdint>
#include <string>

namespace glint::oracle {

// Returns lines of text, including the `list` worst pixels.
std::string toText(const Difference& difference, std::uint32_t list);

// `rays` is the number of the truth's rays for each pixel; `samples` is that of the device's samples.
std::string toJson(const Difference& difference, std::uint32_t rays, std::uint32_t samples);

}  // namespace glint::oracle
