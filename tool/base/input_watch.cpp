#include "base/input_watch.h"

#include "base/clock.h"
#include "base/files.h"

#include <algorithm>
#include <chrono>
#include <sys/stat.h>
#include <thread>

namespace glint::base {

std::optional<InputWatch::Look> InputWatch::lookAt(const std::string& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) {
        return std::nullopt;
    }
    constexpr std::int64_t kNanoseconds = 1'000'000'000;
#if defined(__APPLE__)
    const timespec& time = status.st_mtimespec;
#else
    const timespec& time = status.st_mtim;
#endif
    return Look{static_cast<std::int64_t>(time.tv_sec) * kNanoseconds + time.tv_nsec,
                static_cast<std::uint64_t>(status.st_size), static_cast<std::uint64_t>(status.st_ino)};
}

InputWatch::File InputWatch::stateOf(const std::string& path) {
    File file{lookAt(path), {}};
    if (file.look) {
        if (const Result<FileDigest> digest = digestFile(path)) {
            file.hash = digest->hash;
        }
    }
    return file;
}

void InputWatch::watch(std::span<const std::string> paths) {
    std::map<std::string, File> files;
    for (const std::string& path : paths) {
        const auto known = files_.find(path);
        files.try_emplace(path, known != files_.end() ? known->second : stateOf(path));
    }
    files_ = std::move(files);
}

std::vector<std::string> InputWatch::suspects() const {
    std::vector<std::string> paths;
    for (const auto& [path, file] : files_) {
        if (lookAt(path) != file.look) {
            paths.push_back(path);
        }
    }
    return paths;
}

bool InputWatch::looksChanged() const {
    return std::ranges::any_of(files_, [](const auto& entry) {
        const bool isFolder = entry.second.look && !entry.second.hash;
        return !isFolder && lookAt(entry.first) != entry.second.look;
    });
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
    for (bool rests = false; !rests && millisecondsSince(start) < kPatienceMs;) {
        std::this_thread::sleep_for(std::chrono::milliseconds(kRestMs));
        paths = suspects();
        auto now = looks();
        bool missing = false;
        for (const auto& [path, look] : now) {
            missing = missing || (!look && files_[path].look);
        }
        rests = now == before && (!missing || millisecondsSince(start) >= kMissingMs);
        before = std::move(now);
    }
    std::vector<std::string> changed;
    for (const std::string& path : paths) {
        File now = stateOf(path);
        File& known = files_[path];
        const bool isFolder = now.look && !now.hash && !known.hash;
        if (isFolder || now.hash != known.hash) {
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
