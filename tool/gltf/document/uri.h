// Handles URIs of glTF files: data URIs, percent encoding, and which relative URIs are safe to open.
#pragma once

#include "base/files.h"

#include <optional>
#include <string>
#include <string_view>

namespace glint::gltf {

struct DataUri {
    std::string mimeType;  // may be empty
    base::Bytes bytes;
};

bool isDataUri(std::string_view uri);

// Decodes "data:[type][;base64],…". Returns nothing if the URI is malformed.
std::optional<DataUri> decodeDataUri(std::string_view uri);

// Replaces escapes such as "%20" by their bytes. A '%' without two hexadecimal digits stays as it is.
std::string percentDecode(std::string_view text);

// Returns why the file that a decoded URI names must not be opened, or nothing if it may be. Examines only
// the text.
std::optional<std::string> whyUnsafe(std::string_view uri, std::string_view decoded);

}  // namespace glint::gltf
