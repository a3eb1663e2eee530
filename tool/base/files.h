// Files and hashes: whole-file reads with limits, writes that never leave a half-written file.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

using Bytes = std::vector<std::uint8_t>;

// XXH3, 64 bits.
std::uint64_t hashBytes(std::span<const std::uint8_t> bytes, std::uint64_t seed = 0);
std::uint64_t hashBytes(std::string_view text);
// 16 lower-case hexadecimal digits.
std::string hexHash(std::uint64_t hash);

// Reads a whole file. Errors: "file-open", "file-size" (above maxBytes), "file-read".
Result<Bytes> readFile(const std::filesystem::path& path, std::uint64_t maxBytes = 1ULL << 32);

struct FileDigest {
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0;  // as hashBytes()
};
// Of a file of any size, a piece at a time. Errors "file-open", "file-read".
Result<FileDigest> digestFile(const std::filesystem::path& path);

// Writes through a temporary file beside `path` and a rename; keeps the old file, with its time stamp, where
// the contents are the same already. Errors: "file-write".
Status writeFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
Status writeFile(const std::filesystem::path& path, std::string_view text);

}  // namespace glint
