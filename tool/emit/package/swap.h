// Replaces a folder as a whole: the new contents are staged beside it and moved into place by one rename.
#pragma once

#include <glint/result.h>

#include <filesystem>

namespace glint::compiler {

// Returns `folder` as an absolute path with symbolic links resolved, without a trailing slash. It creates the
// parent folders. Error "output-write".
Result<std::filesystem::path> resolveOutput(const std::filesystem::path& folder);

// Returns a name inside `folder` that is never created, so that its siblings lie within `folder`. It is for
// StagingFolder::create() if nothing may be created beside `folder`.
std::filesystem::path innerStaging(const std::filesystem::path& folder);

// While it lives, other processes that write a package below the same parent wait. On a file system without
// such locks it does nothing.
class OutputLock {
public:
    // Waits for other processes, but not forever. Error "output-busy".
    static Result<OutputLock> acquire(const std::filesystem::path& folder);
    OutputLock(OutputLock&& other) noexcept;
    OutputLock& operator=(OutputLock&&) = delete;
    ~OutputLock();

private:
    explicit OutputLock(int file) : file_(file) {}
    int file_;  // file of the parent folder, or -1 for none
};

// Cleans up after killed runs in and beside `folder`: brings back a folder that was moved aside and not yet
// replaced, and removes staging folders. It leaves alone those of processes that still run.
void recoverInterrupted(const std::filesystem::path& folder);

// A new folder beside the one that it will replace. The destructor removes it with its contents.
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
    // Moves the new folder to the place of `folder`, with the permissions of `folder`, which is removed. On
    // error "output-write" `folder` is as it was.
    Status swapInto(const std::filesystem::path& folder);

private:
    explicit StagingFolder(std::filesystem::path path) : path_(std::move(path)) {}
    std::filesystem::path path_;
};

}  // namespace glint::compiler
