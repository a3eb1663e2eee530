#include "base/folder_events.h"

#include <thread>

#if defined(__linux__)
#include <cerrno>
#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>
#endif

namespace glint::base {

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
    // What has changed is for others to find out.
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

}  // namespace glint::base
