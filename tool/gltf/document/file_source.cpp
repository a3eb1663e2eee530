#include "gltf/document/file_source.h"

#include "gltf/document/uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace glint::gltf {

namespace fs = std::filesystem;

namespace {

// Returns whether `path` lies below `folder` after following links.
bool liesWithin(const fs::path& path, const fs::path& folder) {
    std::error_code error;
    const fs::path canonicalFolder = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
    if (error) {
        return false;
    }
    const fs::path canonicalPath = fs::weakly_canonical(path, error);
    if (error) {
        return false;
    }
    const auto [end, ignored] = std::mismatch(canonicalFolder.begin(), canonicalFolder.end(),
                                              canonicalPath.begin(), canonicalPath.end());
    return end == canonicalFolder.end();
}

}  // namespace

FileSource::FileSource(const fs::path& scenePath, std::uint64_t maxBytes, OuterLinks links)
    : scenePath_(scenePath), bytesLeft_(maxBytes), links_(links) {}

Result<base::Bytes> FileSource::read(const fs::path& path) {
    Result<base::Bytes> bytes = base::readFile(path, bytesLeft_);
    if (!bytes) {
        return bytes;
    }
    bytesLeft_ -= std::min<std::uint64_t>(bytesLeft_, bytes->size());
    const std::string name = path.string();
    const bool known =
        std::any_of(files_.begin(), files_.end(), [&](const SourceFile& file) { return file.path == name; });
    if (!known) {
        files_.push_back({name, bytes->size(), base::hashBytes(*bytes)});
    }
    return bytes;
}

Result<base::Bytes> FileSource::readScene() {
    return read(scenePath_);
}

Result<base::Bytes> FileSource::readRelative(std::string_view uri, const std::string& where) {
    const std::string decoded = percentDecode(uri);
    const auto refuse = [&](std::string_view why) {
        return makeError("uri-unsafe", where, fmt::format("the URI \"{}\" {}", uri, why),
                         "put the file into the scene's folder and refer to it by a relative path");
    };
    if (const auto why = whyUnsafe(uri, decoded)) {
        return refuse(*why);
    }
    const fs::path folder = scenePath_.parent_path();
    const fs::path relative = fs::path(decoded).lexically_normal();
    if (relative.is_absolute() || *relative.begin() == "..") {
        return refuse("leaves the scene's folder");
    }
    const fs::path path = folder / relative;
    if (links_ == OuterLinks::Refuse && !liesWithin(path, folder)) {
        return refuse("leaves the scene's folder through a symbolic link, which strict paths forbid");
    }
    Result<base::Bytes> bytes = read(path);
    if (!bytes) {
        const Diagnostic& error = bytes.error();
        return makeError(error.id, where, fmt::format("\"{}\": {}", path.string(), error.message),
                         error.hint.empty() ? "check the file and the URI" : error.hint);
    }
    return bytes;
}

}  // namespace glint::gltf
