// Whether what the headers of an OpenEXR file say lies in it: the library allocates by them before it reads.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace glint {

// Why not; empty where all is well, or where the file is none that the library would read further.
std::string findExrExcess(std::span<const std::uint8_t> bytes);

}  // namespace glint
