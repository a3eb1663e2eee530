// URIs of glTF files: data URIs, percent encoding, and which relative ones are safe to open.
#pragma once

#include "base/files.h"

#include <optional>
#include <string>
#include <string_view>

namespace glint::gltf {

struct DataUri {
    std::string mimeType;  // may be empty
    Bytes bytes;
};

bool isDataUri(std::string_view uri);

// Decodes "data:[type][;base64],…". Nothing where it is malformed.
std::optional<DataUri> decodeDataUri(std::string_view uri);

// Replaces "%20" and the like by their bytes; a '%' without two hexadecimal digits stays as it is.
std::string percentDecode(std::string_view text);

// Why the file that a decoded URI names must not be opened; nothing where it may. Looks at the text only.
std::optional<std::string> whyUnsafe(std::string_view uri, std::string_view decoded);

}  // namespace glint::gltf
