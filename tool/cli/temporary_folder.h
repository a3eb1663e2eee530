// A temporary folder that its owner removes on destruction.
#pragma once

#include <glint/result.h>

#include <filesystem>

namespace glint {

class TemporaryFolder {
public:
    // Creates a new, empty, private folder below the system's folder for temporary files. Error
    // "temporary-folder".
    static Result<TemporaryFolder> create();

    TemporaryFolder(TemporaryFolder&& other) noexcept;
    TemporaryFolder& operator=(TemporaryFolder&&) = delete;
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    const std::filesystem::path& path() const {
        return path_;
    }

private:
    explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}
    std::filesystem::path path_;  // empty: moved from
};

}  // namespace glint
