// This library is preloaded into a command under test. It makes one of the calls that change files below a
// folder fail, or sends the command a signal there. Environment:
//   GLINT_FAULT_FOLDER  absolute; calls elsewhere are not affected
//   GLINT_FAULT_AT      which call, from 1; 0 for none
//   GLINT_FAULT_KIND    full: ENOSPC for that call and all later ones that take space
//                       error: EIO for that call only
//                       term, kill: SIGTERM, SIGKILL; a write is then half done
//   GLINT_FAULT_COUNT   a file that gets the number of calls seen, if the command ends by itself
#include <climits>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

namespace {

// The purpose of a call. Each kind of fault strikes some of them.
enum class Call {
    Space,   // takes room on the disk: makes, links, writes, closes
    Change,  // renames, permissions, time stamps
    Remove
};
enum class Act { Pass, Fail, Half };

template <typename Function>
Function* next(Function* /*own*/, const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}
#define GLINT_NEXT(function) next(&(function), #function)

std::string_view variable(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? std::string_view() : std::string_view(value);
}

std::atomic<int> seen{0};

bool isBelow(std::string_view path) {
    const std::string_view folder = variable("GLINT_FAULT_FOLDER");
    return !folder.empty() && path.starts_with(folder) &&
           (path.size() == folder.size() || path[folder.size()] == '/');
}

bool isInFolder(int file) {
    char link[64];
    char path[PATH_MAX];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const ssize_t length = readlink(link, path, sizeof path);
    return length > 0 && isBelow({path, static_cast<std::size_t>(length)});
}

bool isInFolder(int folder, const char* path) {
    if (path[0] == '/') {
        return isBelow(path);
    }
    if (folder != AT_FDCWD) {
        return isInFolder(folder);
    }
    char current[PATH_MAX];
    return getcwd(current, sizeof current) != nullptr && isBelow(std::string(current) + "/" + path);
}

// Counts the call and decides what happens to it. Sets errno if it fails.
Act judge(Call call) {
    const std::string_view kind = variable("GLINT_FAULT_KIND");
    const bool isFull = kind == "full";
    const bool isError = kind == "error";
    if ((isFull && call != Call::Space) || (isError && call == Call::Remove)) {
        return Act::Pass;
    }
    const int at = std::atoi(std::string(variable("GLINT_FAULT_AT")).c_str());
    const int number = ++seen;
    if (at == 0 || number < at || (number > at && !isFull)) {
        return Act::Pass;
    }
    if (isFull || isError) {
        errno = isFull ? ENOSPC : EIO;
        return Act::Fail;
    }
    if (kind == "term") {
        kill(getpid(), SIGTERM);
        return Act::Pass;
    }
    return Act::Half;
}

[[noreturn]] void die() {
    kill(getpid(), SIGKILL);
    std::abort();  // not reached
}

// For calls that happen either completely or not at all. Returns false if this one must not happen.
bool allow(Call call) {
    const Act act = judge(call);
    if (act == Act::Half) {
        die();
    }
    return act == Act::Pass;
}

bool allowPath(Call call, int folder, const char* path) {
    return !isInFolder(folder, path) || allow(call);
}

__attribute__((destructor)) void tellCount() {
    const std::string file(variable("GLINT_FAULT_COUNT"));
    if (!file.empty()) {
        const int out = static_cast<int>(GLINT_NEXT(open)(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600));
        const std::string text = std::to_string(seen);
        if (GLINT_NEXT(write)(out, text.data(), text.size()) < 0) {
            std::abort();
        }
    }
}

bool isForWriting(int flags) {
    return (flags & O_ACCMODE) != O_RDONLY || (flags & O_CREAT) != 0;
}

// A file without a name changes nothing that anybody sees.
bool isNameless(int flags) {
    return (flags & O_TMPFILE) == O_TMPFILE;
}

bool isWritten(int file) {
    const int flags = fcntl(file, F_GETFL);
    return isInFolder(file) && isForWriting(flags) && !isNameless(flags);
}

bool isForWriting(const char* mode) {
    return mode[0] != 'r' || std::strchr(mode, '+') != nullptr;
}

}  // namespace

// The command and the C++ standard library change files through these calls of the C library.
extern "C" {

int open(const char* path, int flags, ...) {
    va_list list;
    va_start(list, flags);
    const mode_t mode = (flags & O_CREAT) != 0 || isNameless(flags) ? va_arg(list, mode_t) : 0;
    va_end(list);
    return !isForWriting(flags) || isNameless(flags) || allowPath(Call::Space, AT_FDCWD, path)
               ? GLINT_NEXT(open)(path, flags, mode)
               : -1;
}

FILE* fopen(const char* path, const char* mode) {
    return !isForWriting(mode) || allowPath(Call::Space, AT_FDCWD, path) ? GLINT_NEXT(fopen)(path, mode)
                                                                         : nullptr;
}

FILE* fopen64(const char* path, const char* mode) {
    return !isForWriting(mode) || allowPath(Call::Space, AT_FDCWD, path) ? GLINT_NEXT(fopen64)(path, mode)
                                                                         : nullptr;
}

ssize_t write(int file, const void* data, size_t size) {
    const Act act = isInFolder(file) ? judge(Call::Space) : Act::Pass;
    if (act == Act::Pass) {
        return GLINT_NEXT(write)(file, data, size);
    }
    const int error = errno;
    const ssize_t written = GLINT_NEXT(write)(file, data, size / 2);
    if (act == Act::Half) {
        die();
    }
    errno = error;
    // Writes as much as fits. The next call then fails.
    return written > 0 ? written : -1;
}

size_t fwrite(const void* data, size_t size, size_t count, FILE* file) {
    const Act act = isInFolder(fileno(file)) ? judge(Call::Space) : Act::Pass;
    if (act == Act::Pass) {
        return GLINT_NEXT(fwrite)(data, size, count, file);
    }
    const int error = errno;
    const size_t written = GLINT_NEXT(fwrite)(data, size, count / 2, file);
    if (act == Act::Half) {
        fflush(file);
        die();
    }
    errno = error;
    return written;
}

int fclose(FILE* file) {
    const bool isDone = !isWritten(fileno(file)) || allow(Call::Space);
    const int error = errno;
    const int result = GLINT_NEXT(fclose)(file);
    if (!isDone) {
        errno = error;
    }
    return isDone ? result : EOF;
}

int close(int file) {
    const bool isDone = !isWritten(file) || allow(Call::Space);
    const int error = errno;
    const int result = GLINT_NEXT(close)(file);
    if (!isDone) {
        errno = error;
    }
    return isDone ? result : -1;
}

int mkdir(const char* path, mode_t mode) {
    return allowPath(Call::Space, AT_FDCWD, path) ? GLINT_NEXT(mkdir)(path, mode) : -1;
}

int link(const char* from, const char* to) {
    return allowPath(Call::Space, AT_FDCWD, to) ? GLINT_NEXT(link)(from, to) : -1;
}

int symlink(const char* target, const char* path) {
    return allowPath(Call::Space, AT_FDCWD, path) ? GLINT_NEXT(symlink)(target, path) : -1;
}

ssize_t sendfile(int to, int from, off_t* offset, size_t size) {
    return !isInFolder(to) || allow(Call::Space) ? GLINT_NEXT(sendfile)(to, from, offset, size) : -1;
}

int rename(const char* from, const char* to) {
    return allowPath(Call::Change, AT_FDCWD, to) ? GLINT_NEXT(rename)(from, to) : -1;
}

int renameat2(int fromFolder, const char* from, int toFolder, const char* to, unsigned flags) {
    return allowPath(Call::Change, toFolder, to)
               ? GLINT_NEXT(renameat2)(fromFolder, from, toFolder, to, flags)
               : -1;
}

int fchmodat(int folder, const char* path, mode_t mode, int flags) {
    return allowPath(Call::Change, folder, path) ? GLINT_NEXT(fchmodat)(folder, path, mode, flags) : -1;
}

int utimensat(int folder, const char* path, const struct timespec times[2], int flags) {
    return allowPath(Call::Change, folder, path) ? GLINT_NEXT(utimensat)(folder, path, times, flags) : -1;
}

int unlinkat(int folder, const char* path, int flags) {
    return allowPath(Call::Remove, folder, path) ? GLINT_NEXT(unlinkat)(folder, path, flags) : -1;
}

int remove(const char* path) {
    return allowPath(Call::Remove, AT_FDCWD, path) ? GLINT_NEXT(remove)(path) : -1;
}
}
