// Files that are written beside their place, and take it by one rename.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace glint {

// New contents of a file, all on disk but not yet in their place: what can fail for want of space has not
// failed. Goes, unless committed, when the object does.
class StagedFile {
public:
    // Where the file holds `bytes` already there is nothing to do, and it keeps its time stamp. Error
    // "file-write".
    static Result<StagedFile> create(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
    StagedFile(StagedFile&& other) noexcept;
    StagedFile& operator=(StagedFile&&) = delete;
    ~StagedFile();

    // Error "file-write"; the file is as it was then.
    Status commit();

private:
    StagedFile(std::filesystem::path path, std::filesystem::path temporary);

    std::filesystem::path path_;
    std::filesystem::path temporary_;  // empty: nothing to do
};

std::span<const std::uint8_t> asBytes(std::string_view text);

// Both in one, for a folder in which nothing else is written to `path`. Error "file-write".
Status writeStaged(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

// Removes what runs that were killed left beside `path` while they wrote it; writeFile() does so by itself.
void removeAbandoned(const std::filesystem::path& path);

}  // namespace glint
