// Reads the files of a scene. They are named relative to its folder, their total size is bounded, and they
// are recorded.
#pragma once

#include "base/files.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glint::gltf {

// What to do with symbolic links that lead out of the scene's folder.
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
