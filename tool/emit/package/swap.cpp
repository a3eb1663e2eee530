#include "emit/package/swap.h"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <string>
#include <string_view>
#include <sys/file.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace fs = std::filesystem;

namespace {

// The siblings of "out" are called ".out.glint-new-PID-N" while staging, and ".out.glint-old-PID-N" between
// two renames.
constexpr std::string_view kNewTag = ".glint-new-";
constexpr std::string_view kOldTag = ".glint-old-";

Diagnostic swapError(const fs::path& path, const std::string& why) {
    return makeError("output-write", path.string(), "can't be written: " + why,
                     "check the folder, that of its parent, and their permissions; nothing was changed");
}

std::string siblingPrefix(const fs::path& folder, std::string_view tag) {
    return fmt::format(".{}{}", folder.filename().string(), tag);
}

// Returns a name that does not exist yet.
fs::path newSibling(const fs::path& folder, std::string_view tag) {
    std::error_code error;
    for (int i = 0;; ++i) {
        fs::path path =
            folder.parent_path() / fmt::format("{}{}-{}", siblingPrefix(folder, tag), getpid(), i);
        if (fs::symlink_status(path, error).type() == fs::file_type::not_found) {
            return path;
        }
    }
}

// Returns whether the process that made a sibling has ended. Its number is in the sibling's name.
bool isAbandoned(std::string_view afterTag) {
    long process = 0;
    const auto [end, error] = std::from_chars(afterTag.data(), afterTag.data() + afterTag.size(), process);
    const bool parsed = error == std::errc() && end != afterTag.data() + afterTag.size() && *end == '-';
    return parsed && process > 0 && kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH;
}

std::vector<fs::path> abandonedSiblings(const fs::path& folder, std::string_view tag) {
    const std::string prefix = siblingPrefix(folder, tag);
    std::vector<fs::path> found;
    std::error_code error;
    for (fs::directory_iterator entry(folder.parent_path(), error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.starts_with(prefix) && isAbandoned(std::string_view(name).substr(prefix.size()))) {
            found.push_back(entry->path());
        }
    }
    return found;
}

// Exchanges two folders in one step, if kernel and file system support it.
bool exchange(const fs::path& first, const fs::path& second) {
#if defined(__linux__) && defined(RENAME_EXCHANGE)
    return renameat2(AT_FDCWD, first.c_str(), AT_FDCWD, second.c_str(), RENAME_EXCHANGE) == 0;
#else
    static_cast<void>(first);
    static_cast<void>(second);
    return false;
#endif
}

}  // namespace

Result<fs::path> resolveOutput(const fs::path& folder) {
    std::error_code error;
    if (folder.empty()) {
        return makeError("output-write", {}, "the name of the output folder is empty", "name a folder");
    }
    fs::path path = fs::weakly_canonical(fs::absolute(folder, error), error);
    if (error) {
        return swapError(folder, error.message());
    }
    if (!path.has_filename()) {
        path = path.parent_path();
    }
    if (!path.has_filename()) {
        return swapError(folder, "a package can't take the place of the root folder");
    }
    if (fs::is_symlink(fs::symlink_status(path, error))) {
        return swapError(folder, "it is a link that leads nowhere");
    }
    fs::create_directories(path.parent_path(), error);
    if (error) {
        return swapError(folder, error.message());
    }
    return path;
}

fs::path innerStaging(const fs::path& folder) {
    return folder / folder.filename();
}

Result<OutputLock> OutputLock::acquire(const fs::path& folder) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::seconds kPatience(30);  // Writing a package takes well below a second.
    constexpr std::chrono::milliseconds kPause(20);
    const int file = open(folder.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const Clock::time_point start = Clock::now();
    while (file >= 0 && flock(file, LOCK_EX | LOCK_NB) != 0 && (errno == EWOULDBLOCK || errno == EINTR)) {
        if (Clock::now() - start > kPatience) {
            close(file);
            return makeError("output-busy", folder.string(),
                             "another process is writing below its parent folder",
                             "wait for it, or choose an output folder elsewhere; nothing was changed");
        }
        std::this_thread::sleep_for(kPause);
    }
    return OutputLock(file);
}

OutputLock::OutputLock(OutputLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

OutputLock::~OutputLock() {
    if (file_ >= 0) {
        close(file_);
    }
}

void recoverInterrupted(const fs::path& folder) {
    std::error_code error;
    for (const fs::path& old : abandonedSiblings(folder, kOldTag)) {
        if (!fs::exists(folder, error)) {
            fs::rename(old, folder, error);
        } else {
            fs::remove_all(old, error);
        }
    }
    for (const fs::path& beside : {folder, innerStaging(folder)}) {
        for (const fs::path& staging : abandonedSiblings(beside, kNewTag)) {
            fs::remove_all(staging, error);
        }
    }
}

Result<StagingFolder> StagingFolder::create(const fs::path& folder) {
    // Another thread may take the name between the check and the creation.
    constexpr int kAttempts = 100;
    std::error_code error;
    for (int i = 0; i < kAttempts; ++i) {
        const fs::path path = newSibling(folder, kNewTag);
        if (fs::create_directory(path, error)) {
            return StagingFolder(path);
        }
        if (error) {
            break;
        }
    }
    return swapError(folder, error ? error.message() : "no free name for a folder beside it");
}

StagingFolder::StagingFolder(StagingFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}

StagingFolder::~StagingFolder() {
    if (!path_.empty()) {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
}

Status StagingFolder::swapInto(const fs::path& folder) {
    std::error_code error;
    if (!fs::exists(folder, error)) {
        fs::rename(path_, folder, error);
        return error ? Status(swapError(folder, error.message())) : okStatus();
    }
    fs::permissions(path_, fs::status(folder, error).permissions(), error);
    if (exchange(path_, folder)) {
        return okStatus();  // The destructor removes path_, which is now the old folder.
    }
    const fs::path old = newSibling(folder, kOldTag);
    fs::rename(folder, old, error);
    if (error) {
        return swapError(folder, error.message());
    }
    fs::rename(path_, folder, error);
    if (error) {
        std::error_code ignored;
        fs::rename(old, folder, ignored);
        return swapError(folder, error.message());
    }
    path_ = old;
    return okStatus();
}

}  // namespace glint::compiler
