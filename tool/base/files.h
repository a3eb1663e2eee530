// Reads whole files with size limits, writes files so that none is ever left half-written, and hashes bytes.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::base {

using Bytes = std::vector<std::uint8_t>;

inline std::string_view asText(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

struct FileCloser {
    void operator()(std::FILE* file) const {
        std::fclose(file);
    }
};
// An open file, which closes itself; it ignores an error of closing, such as a full disk.
using File = std::unique_ptr<std::FILE, FileCloser>;

// Returns the 64-bit XXH3 hash.
std::uint64_t hashBytes(std::span<const std::uint8_t> bytes, std::uint64_t seed = 0);
std::uint64_t hashBytes(std::string_view text);
// Returns the hash as 16 lower-case hexadecimal digits.
std::string hexHash(std::uint64_t hash);

// Reads a whole file. Errors: "file-open", "file-size" (above maxBytes), "file-read".
Result<Bytes> readFile(const std::filesystem::path& path, std::uint64_t maxBytes = 1ULL << 32);

struct FileDigest {
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0;  // as from hashBytes()
};
// Hashes a file of any size, one piece at a time. Errors "file-open", "file-read".
Result<FileDigest> digestFile(const std::filesystem::path& path);

// Writes a temporary file beside `path` and renames it. If the file has the same contents already, it is kept
// with its time stamp. Errors: "file-write".
Status writeFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
Status writeFile(const std::filesystem::path& path, std::string_view text);

}  // namespace glint::base
