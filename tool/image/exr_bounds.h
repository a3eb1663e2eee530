// Checks that everything the headers of an OpenEXR file announce lies in the file, because the library
// allocates by the headers before it reads.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace glint::image {

// Returns the first element that does not fit. Returns an empty text if everything fits, or if the library
// would not read the file any further.
std::string findExrExcess(std::span<const std::uint8_t> bytes);

}  // namespace glint::image
