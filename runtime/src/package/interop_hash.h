// The layouts that this runtime was built with, as text and hash.
#pragma once

#include <cstdint>
#include <string_view>

namespace glint {

// Returns the interop headers of the build, one after the other.
std::string_view interopText();

// Returns the PackageHeader::interopHash of packages whose shaders share these layouts.
std::uint32_t interopHash();

}  // namespace glint
