#include "base/input_watch.h"

#include "base/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <sys/stat.h>
#include <thread>

#if defined(__linux__)
#include <cerrno>
#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>
#endif

namespace glint::base {

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // in nanoseconds

// Returns how long a file system may give changes the same time. The kernel's clock for files ticks every 1
// to 10 ms. Some file systems store whole seconds, FAT even ones.
std::int64_t longestTick(std::int64_t time) {
    constexpr std::int64_t kKernelTick = 20'000'000;
    return time % kSecond == 0 ? 2 * kSecond : kKernelTick;
}

std::int64_t systemTime() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

}  // namespace

#if defined(__linux__)

FolderEvents::FolderEvents() : queue_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {}

FolderEvents::~FolderEvents() {
    if (queue_ >= 0) {
        close(queue_);
    }
}

bool FolderEvents::watch(const std::set<std::string>& folders) {
    std::erase_if(watches_, [&](const auto& known) {
        const bool leaves = !folders.contains(known.first);
        if (leaves) {
            inotify_rm_watch(queue_, known.second);
        }
        return leaves;
    });
    constexpr std::uint32_t kEvents = IN_CREATE | IN_DELETE | IN_MOVE | IN_MODIFY | IN_CLOSE_WRITE |
                                      IN_ATTRIB | IN_DELETE_SELF | IN_MOVE_SELF;
    for (const std::string& folder : folders) {
        // A folder that was removed and made again is another one: adding it once more finds that out.
        const int watch = queue_ < 0 ? -1 : inotify_add_watch(queue_, folder.c_str(), kEvents);
        if (watch >= 0) {
            watches_[folder] = watch;
        } else if (queue_ < 0 || errno != ENOENT) {
            return false;
        }
    }
    return true;
}

bool FolderEvents::wait(std::chrono::milliseconds longest) {
    if (queue_ < 0) {
        std::this_thread::sleep_for(longest);
        return false;
    }
    pollfd asked{queue_, POLLIN, 0};
    if (poll(&asked, 1, static_cast<int>(longest.count())) <= 0) {
        return false;
    }
    // Others find out about the changes themselves.
    alignas(inotify_event) char events[1 << 14];
    while (read(queue_, events, sizeof events) > 0) {
    }
    return true;
}

#else

FolderEvents::FolderEvents() = default;
FolderEvents::~FolderEvents() = default;

bool FolderEvents::watch(const std::set<std::string>& /*folders*/) {
    return false;
}

bool FolderEvents::wait(std::chrono::milliseconds longest) {
    std::this_thread::sleep_for(longest);
    return false;
}

#endif

std::optional<InputWatch::Look> InputWatch::lookAt(const std::string& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) {
        return std::nullopt;
    }
#if defined(__APPLE__)
    const timespec& time = status.st_mtimespec;
#else
    const timespec& time = status.st_mtim;
#endif
    return Look{static_cast<std::int64_t>(time.tv_sec) * kSecond + time.tv_nsec,
                static_cast<std::uint64_t>(status.st_size), static_cast<std::uint64_t>(status.st_ino),
                S_ISDIR(status.st_mode)};
}

// Returns the names in a folder in their order, each with its state by one call to the system.
std::string InputWatch::listingOf(const std::string& folder) {
    std::map<std::string, Look> entries;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        entries.emplace(entry.path().filename().string(), lookAt(entry.path().string()).value_or(Look{}));
    }
    std::string text;
    for (const auto& [name, look] : entries) {
        text += fmt::format("{} {} {} {}\n", name, look.time, look.bytes, look.number);
    }
    return text;
}

InputWatch::File InputWatch::stateOf(const std::string& path) {
    const std::int64_t now = systemTime();
    File file{lookAt(path), {}, {}};
    if (file.look) {
        const std::int64_t settles = file.look->time + longestTick(file.look->time);
        if (settles > now) {
            file.settles = settles;
        }
        if (file.look->isFolder) {
            file.hash = hashBytes(listingOf(path));
        } else if (const Result<FileDigest> digest = digestFile(path)) {
            file.hash = digest->hash;
        }
    }
    return file;
}

void InputWatch::watch(std::span<const InputFile> inputs, std::set<std::string> folders) {
    std::map<std::string, File> files;
    for (const InputFile& input : inputs) {
        const auto known = files_.find(input.path);
        const auto [file, isNew] =
            files.try_emplace(input.path, known != files_.end() ? known->second : stateOf(input.path));
        if (isNew && known == files_.end() && input.hash && input.hash != file->second.hash) {
            file->second = File{std::nullopt, input.hash, {}};
        }
    }
    files_ = std::move(files);
    for (const auto& [path, file] : files_) {
        const std::string folder = std::filesystem::path(path).parent_path().string();
        folders.insert(folder.empty() ? "." : folder);
        if (file.look && file.look->isFolder) {
            folders.insert(path);
        }
    }
    hearsAll_ = events_.watch(folders);
    heard_ = Clock::now();
}

bool InputWatch::wait(std::chrono::milliseconds longest) {
    const bool heard = events_.wait(longest);
    const Clock::time_point now = Clock::now();
    heard_ = heard ? now : heard_;
    const bool isTime = heard || !hearsAll_ || millisecondsBetween(heard_, now) < restlessMs_ ||
                        millisecondsBetween(looked_, now) >= kLookMs;
    looked_ = isTime ? now : looked_;
    return isTime;
}

bool InputWatch::isSuspect(const std::string& path, const File& known) {
    return lookAt(path) != known.look || (known.settles && systemTime() >= *known.settles);
}

std::vector<std::string> InputWatch::suspects() const {
    std::vector<std::string> paths;
    for (const auto& [path, file] : files_) {
        if (isSuspect(path, file)) {
            paths.push_back(path);
        }
    }
    return paths;
}

std::vector<std::string> InputWatch::changed() {
    const Clock::time_point start = Clock::now();
    std::vector<std::string> paths = suspects();
    if (paths.empty()) {
        return {};
    }
    const auto looks = [&] {
        std::map<std::string, std::optional<Look>> all;
        for (const std::string& path : paths) {
            all.emplace(path, lookAt(path));
        }
        return all;
    };
    auto before = looks();
    for (bool rests = false; !rests && millisecondsSince(start) < std::max(kPatienceMs, missingMs_);) {
        std::this_thread::sleep_for(std::chrono::milliseconds(kRestMs));
        paths = suspects();
        auto now = looks();
        bool missing = false;
        for (const auto& [path, look] : now) {
            missing = missing || (!look && files_[path].look);
        }
        rests = now == before && (!missing || millisecondsSince(start) >= missingMs_);
        before = std::move(now);
    }
    std::vector<std::string> changed;
    for (const std::string& path : paths) {
        File now = stateOf(path);
        File& known = files_[path];
        if (now.hash != known.hash) {
            changed.push_back(path);
        }
        known = now;
    }
    return changed;
}

void InputWatch::accept(const std::string& path) {
    if (const auto known = files_.find(path); known != files_.end()) {
        known->second = stateOf(path);
    }
}

}  // namespace glint::base
