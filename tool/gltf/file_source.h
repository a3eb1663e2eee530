// The files of a scene: named relative to its folder, bounded in total, recorded.
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

// Symbolic links that lead out of the scene's folder.
enum class OuterLinks : std::uint8_t { Follow, Refuse };

class FileSource {
public:
    // `maxBytes` bounds the sum over all files.
    FileSource(const std::filesystem::path& scenePath, std::uint64_t maxBytes, OuterLinks links);

    // Reads the scene's own file.
    Result<Bytes> readScene();

    // Reads what a relative URI of the scene names. Errors have `where` as their place: "uri-unsafe",
    // "file-open", "file-size", "file-read".
    Result<Bytes> readRelative(std::string_view uri, const std::string& where);

    // In the order of opening, each file once.
    const std::vector<SourceFile>& files() const {
        return files_;
    }

private:
    Result<Bytes> read(const std::filesystem::path& path);

    std::filesystem::path scenePath_;
    std::uint64_t bytesLeft_;
    OuterLinks links_;
    std::vector<SourceFile> files_;
};

}  // namespace glint::gltf
