// Notices changes of files by asking for their states again and again.
#pragma once

#include "base/clock.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace glint::base {

// A file that somebody has read, or is about to.
struct InputFile {
    std::string path;
    std::optional<std::uint64_t> hash;  // of the contents that were read (digestFile()), where they are known
};

// Folders that the system watches (inotify). It tells of entries that come and go, and of files in them that
// are written, but not of all: not of writes through a map of memory, to the target of a link, or by another
// machine. Where there is no such service, or it has no room for more folders, it hears nothing.
class FolderEvents {
public:
    FolderEvents();
    FolderEvents(const FolderEvents&) = delete;
    FolderEvents& operator=(const FolderEvents&) = delete;
    ~FolderEvents();

    // Replaces the folders, and returns whether it hears of all of them. Those that don't exist count as
    // heard.
    bool watch(const std::set<std::string>& folders);

    // Waits until something has changed since the last call, but not longer than that. Returns whether it
    // has.
    bool wait(std::chrono::milliseconds longest);

private:
    int queue_ = -1;  // file of the system's queue; -1: there is no such service
    std::map<std::string, int> watches_;
};

// Polling works on every file system; it costs one or two microseconds of processor time for each file and
// poll. wait() spares most polls where the system tells of changes.
class InputWatch {
public:
    // A file that is missing for less than `missingMs` has not changed. For `restlessMs` after a change in a
    // folder, wait() is for nothing but a pause.
    explicit InputWatch(int missingMs = kMissingMs, int restlessMs = kRestlessMs)
        : missingMs_(missingMs), restlessMs_(restlessMs) {}

    // Replaces the watched files. Files that were watched before keep the state in which the last changed()
    // or accept() saw them, so that no change is lost while somebody works on them. A new file whose contents
    // are no longer those that were read has changed. A folder is watched for files that come and go.
    // Changes in `folders` end wait(), too.
    void watch(std::span<const InputFile> inputs, std::set<std::string> folders = {});

    // Waits for a change in the folders of the files, but not longer than that. Returns whether to look for
    // changes: not if the system tells of them, and has told of none for a while. Even then it is time to
    // look each kLookMs, because the system does not tell of all (FolderEvents).
    bool wait(std::chrono::milliseconds longest);

    // Returns the files whose contents changed since the last call. A file that was only touched has not
    // changed. A missing file has changed only if it stays away for a while: editors replace files by
    // renaming others, or remove and write them. Waits until the files that changed have been at rest for
    // kRestMs, as programs write large files piece by piece, but at most kPatienceMs.
    std::vector<std::string> changed();

    // Takes the present contents of a file as known: the program itself has written it.
    void accept(const std::string& path);

    static constexpr int kRestMs = 10;
    static constexpr int kPatienceMs = 500;
    static constexpr int kMissingMs = 250;
    static constexpr int kRestlessMs = 5000;  // longer than the clocks of file systems take for a tick
    static constexpr int kLookMs = 1000;

private:
    // The state of a file by one call to the system.
    struct Look {
        std::int64_t time = 0;  // of the last change, in nanoseconds of the file system's clock
        std::uint64_t bytes = 0;
        std::uint64_t number = 0;  // of the file, which a rename changes
        bool isFolder = false;

        friend bool operator==(const Look&, const Look&) = default;
    };
    struct File {
        std::optional<Look> look;  // no value: missing
        // The hash covers the contents of a file, or the names and looks of a folder's files. A missing file
        // has no hash.
        std::optional<std::uint64_t> hash;
        // The time at which the file system's clock has certainly moved on since the last change. If a file
        // was looked at earlier, it may have changed since and look the same.
        std::optional<std::int64_t> settles;
    };

    static std::optional<Look> lookAt(const std::string& path);
    static std::string listingOf(const std::string& folder);
    static File stateOf(const std::string& path);
    // Returns whether a file looks other than known, or may have changed although it does not.
    static bool isSuspect(const std::string& path, const File& known);
    std::vector<std::string> suspects() const;

    int missingMs_;
    int restlessMs_;
    std::map<std::string, File> files_;
    FolderEvents events_;
    bool hearsAll_ = false;
    Clock::time_point heard_ = Clock::now();  // of a change in a folder, or began to watch it
    Clock::time_point looked_ = Clock::now();
};

}  // namespace glint::base
