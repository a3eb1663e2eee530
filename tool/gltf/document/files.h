// Decodes the URIs of a scene. tinygltf's own functions are not used: it knows seven spellings of data URIs,
// and takes their data to end at the first wrong character.
#pragma once

#include "base/files.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace glint::gltf {

using ByteView = std::span<const std::uint8_t>;

bool isDataUri(std::string_view uri);

// Decodes "data:[type][;base64],…". Returns nothing if the URI is malformed.
std::optional<base::Bytes> decodeDataUri(std::string_view uri);

// Replaces escapes such as "%20" by their bytes. A '%' without two hexadecimal digits stays as it is.
std::string percentDecode(std::string_view text);

}  // namespace glint::gltf
