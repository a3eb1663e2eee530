// Which layouts this runtime was built with.
#pragma once

#include <cstdint>
#include <string_view>

namespace glint {

// The interop headers of the build, one after the other.
std::string_view interopText();

// What PackageHeader::interopHash is for packages whose shaders share these layouts.
std::uint32_t interopHash();

}  // namespace glint
