// Hears from the system that something in a folder changes.
#pragma once

#include <chrono>
#include <map>
#include <set>
#include <string>

namespace glint::base {

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

}  // namespace glint::base
