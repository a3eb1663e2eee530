// Files that are written beside their place and moved into it by one rename.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace glint::base {

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
