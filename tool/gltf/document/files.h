// Reads the files and the data URIs of a scene. Files are named relative to its folder, their total size is
// bounded, and they are recorded.
//
// tinygltf's own functions are not used: it knows seven spellings of data URIs, takes their data to end at
// the first wrong character, and asks for a file's size to be the one announced.
#pragma once

#include "base/files.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::gltf {

using ByteView = std::span<const std::uint8_t>;

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

// The treatment of symbolic links that lead out of the scene's folder.
enum class OuterLinks : std::uint8_t { Follow, Refuse };

class FileSource {
public:
    // `maxBytes` bounds the sum of the sizes of all files.
    FileSource(const std::filesystem::path& scenePath, std::uint64_t maxBytes, OuterLinks links);

    // Reads the scene's own file.
    Result<base::Bytes> readScene();

    // Reads the file that a relative URI of the scene names. The place of errors is `where`: "uri-unsafe",
    // "file-open", "file-size", "file-read".
    Result<base::Bytes> readRelative(std::string_view uri, const std::string& where);

    // Lists each file once, in the order of opening.
    const std::vector<SourceFile>& files() const {
        return files_;
    }

private:
    Result<base::Bytes> read(const std::filesystem::path& path);

    std::filesystem::path scenePath_;
    std::uint64_t bytesLeft_;
    OuterLinks links_;
    std::vector<SourceFile> files_;
};

}  // namespace glint::gltf
