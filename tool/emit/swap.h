// Replacing a folder as a whole: the new contents are staged beside it and put in its place by one rename.
#pragma once

#include <glint/result.h>

#include <filesystem>

namespace glint {

// `folder` with symbolic links resolved, absolute, without a trailing slash; makes its parents. Error
// "output-write".
Result<std::filesystem::path> resolveOutput(const std::filesystem::path& folder);

// The folder inside `folder`, never made, whose siblings lie within: for StagingFolder::create() where
// nothing may be made beside it.
std::filesystem::path innerStaging(const std::filesystem::path& folder);

// Keeps other processes that write a package below the same parent waiting while it lives; where the file
// system has no such locks, it does nothing.
class OutputLock {
public:
    // Waits for others, up to a time. Error "output-busy".
    static Result<OutputLock> acquire(const std::filesystem::path& folder);
    OutputLock(OutputLock&& other) noexcept;
    OutputLock& operator=(OutputLock&&) = delete;
    ~OutputLock();

private:
    explicit OutputLock(int file) : file_(file) {}
    int file_;  // of the parent folder; -1: none
};

// Puts right what runs that were killed left beside and in `folder`: brings back a folder that was moved
// aside and not yet replaced, and removes staging folders. Leaves alone those of processes that still run.
void recoverInterrupted(const std::filesystem::path& folder);

// A new folder beside the one that it will replace; goes, with its contents, when the object does.
class StagingFolder {
public:
    // Error "output-write".
    static Result<StagingFolder> create(const std::filesystem::path& folder);
    StagingFolder(StagingFolder&& other) noexcept;
    StagingFolder& operator=(StagingFolder&&) = delete;
    ~StagingFolder();

    const std::filesystem::path& path() const {
        return path_;
    }
    // Takes the place, and the permissions, of `folder`, which goes. On error "output-write" `folder` is as
    // it was.
    Status swapInto(const std::filesystem::path& folder);

private:
    explicit StagingFolder(std::filesystem::path path) : path_(std::move(path)) {}
    std::filesystem::path path_;
};

}  // namespace glint
