// Detects that `glint compile --watch` has written a new package.
#pragma once

#include <glint/package.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

namespace glint {

namespace package {

// The stamp of a package is a file beside its folder: "room.glint.stamp" of "room.glint". It has one line: a
// decimal counter, a space and the hash of tables.bin as 16 hexadecimal digits. The compiler increments the
// counter after a package with other contents is in place, and replaces the file by a rename.
inline constexpr std::string_view kStampSuffix = ".stamp";

// Returns the stamp's file of a package's folder.
std::filesystem::path stampFile(const std::filesystem::path& folder);

// Returns the counter of the stamp in `file`, or no value if there is none.
std::optional<std::uint64_t> readStamp(const std::filesystem::path& file);

}  // namespace package

// Watches one package. It needs no Vulkan device and starts no thread.
class PackageWatch {
public:
    // Begins with the package that the folder has now: poll() returns the next one.
    explicit PackageWatch(const std::filesystem::path& folder);

    // Returns the package if it was written since the last call, else null. Without a new package this opens
    // and reads one small file, which takes some microseconds; with one it loads the package, in the time of
    // Package::load(). Packages that were written in between are skipped.
    //
    // If the folder is just being replaced once more, loading fails; then this returns null and tries again
    // in the next calls. After kTries calls with the same stamp it returns the error, once. Errors: those of
    // Package::load().
    Result<std::shared_ptr<const Package>> poll();

    // Returns the counter of the last package that poll() returned, or of the start.
    std::uint64_t counter() const {
        return counter_;
    }

    static constexpr int kTries = 10;

private:
    std::filesystem::path folder_;
    std::filesystem::path stamp_;
    std::uint64_t counter_ = 0;
    int failures_ = 0;
};

}  // namespace glint
