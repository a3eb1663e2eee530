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

// A text file that is compiled into a library (cmake/GlintEmbed.cmake).
struct BuiltinFile {
    // Relative to the folder that was embedded: "interop/scene.h", "uber.comp.mustache".
    std::string_view name;
    std::string_view text;
};

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

// The new contents of a file, complete on disk but not yet in place, so that a full disk can no longer make
// it fail. The destructor removes them unless they were committed.
class StagedFile {
public:
    // If the file holds `bytes` already, nothing is written and it keeps its time stamp. Error "file-write".
    static Result<StagedFile> create(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
    StagedFile(StagedFile&& other) noexcept;
    StagedFile& operator=(StagedFile&&) = delete;
    ~StagedFile();

    // Moves the contents into place. On error "file-write" the file is as it was.
    Status commit();

private:
    StagedFile(std::filesystem::path path, std::filesystem::path temporary);

    std::filesystem::path path_;
    std::filesystem::path temporary_;  // empty if there is nothing to do
};

std::span<const std::uint8_t> asBytes(std::string_view text);

// Calls create() and commit(), for a folder in which no other process writes to `path`. Error "file-write".
Status writeStaged(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

// Returns an error unless a file can be written at `path` later, whether or not there is one: "output-folder"
// if its folder does not exist or if it is a folder itself, "file-write" if the folder takes no file. A
// temporary file is made and removed, because permissions alone do not tell.
Status checkOutputFile(const std::filesystem::path& path);
// Does the same for files in a folder that is made, with its parents, if it does not exist. Error
// "file-write".
Status checkOutputFolder(const std::filesystem::path& folder);

// Removes temporary files beside `path` that killed runs left; writeFile() does so by itself.
void removeAbandoned(const std::filesystem::path& path);

}  // namespace glint::base
