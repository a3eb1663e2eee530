#include "base/files.h"

#include "base/staged_file.h"

#include <xxhash.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

namespace glint::base {

namespace fs = std::filesystem;

std::uint64_t hashBytes(std::span<const std::uint8_t> bytes, std::uint64_t seed) {
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

std::uint64_t hashBytes(std::string_view text) {
    return hashBytes(asBytes(text));
}

std::string hexHash(std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

Result<Bytes> readFile(const fs::path& path, std::uint64_t maxBytes) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
        const bool exists = fs::exists(path, error);
        return makeError("file-open", path.string(), exists ? "is not a regular file" : "no such file",
                         "check the path");
    }
    const std::uint64_t size = fs::file_size(path, error);
    if (error) {
        return makeError("file-open", path.string(), error.message());
    }
    if (size > maxBytes) {
        return makeError(
            "file-size", path.string(),
            "is " + std::to_string(size) + " bytes long; the limit is " + std::to_string(maxBytes));
    }
    const File file(std::fopen(path.c_str(), "rb"));
    if (!file) {
        return makeError("file-open", path.string(), std::strerror(errno), "check the file's permissions");
    }
    Bytes bytes(size);
    if (size > 0 && std::fread(bytes.data(), 1, size, file.get()) != size) {
        return makeError("file-read", path.string(), "ended early or could not be read");
    }
    return bytes;
}

Result<FileDigest> digestFile(const fs::path& path) {
    std::error_code error;
    const File file(fs::is_regular_file(path, error) ? std::fopen(path.c_str(), "rb") : nullptr);
    if (!file) {
        return makeError("file-open", path.string(), "can't be opened as a regular file", "check the path");
    }
    struct StateDeleter {
        void operator()(XXH3_state_t* state) const {
            XXH3_freeState(state);
        }
    };
    const std::unique_ptr<XXH3_state_t, StateDeleter> state(XXH3_createState());
    XXH3_64bits_reset(state.get());
    // A piece of this size stays in the cache of a core.
    constexpr std::size_t kPiece = 1U << 17;
    const auto piece = std::make_unique_for_overwrite<std::uint8_t[]>(kPiece);
    // The file's own buffer would only add a copy.
    std::setvbuf(file.get(), nullptr, _IONBF, 0);
    FileDigest digest;
    std::size_t count = kPiece;
    while (count == kPiece) {
        count = std::fread(piece.get(), 1, kPiece, file.get());
        XXH3_64bits_update(state.get(), piece.get(), count);
        digest.bytes += count;
    }
    if (std::ferror(file.get()) != 0) {
        return makeError("file-read", path.string(), "could not be read");
    }
    digest.hash = XXH3_64bits_digest(state.get());
    return digest;
}

Status writeFile(const fs::path& path, std::span<const std::uint8_t> bytes) {
    removeAbandoned(path);
    return writeStaged(path, bytes);
}

Status writeFile(const fs::path& path, std::string_view text) {
    return writeFile(path, asBytes(text));
}

}  // namespace glint::base
