#include "base/files.h"
#include "base/parallel.h"
#include "emit/package/compiled_package.h"
#include "emit/package/manifest.h"

#include <glint/result.h>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <iterator>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
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

// Returns `folder` as an absolute path with symbolic links resolved, without a trailing slash. It creates the
// parent folders. Error "output-write".
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

// Returns a name inside `folder` that is never created, so that its siblings lie within `folder`. It is for
// StagingFolder::create() if nothing may be created beside `folder`.
fs::path innerStaging(const fs::path& folder) {
    return folder / folder.filename();
}
// While it lives, other processes that write a package below the same parent wait. On a file system without
// such locks it does nothing.
class OutputLock {
public:
    // Waits for other processes, but not forever. Error "output-busy".
    static Result<OutputLock> acquire(const fs::path& folder) {
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
    OutputLock(OutputLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
    OutputLock& operator=(OutputLock&&) = delete;
    ~OutputLock() {
        if (file_ >= 0) {
            close(file_);
        }
    }

private:
    explicit OutputLock(int file) : file_(file) {}
    int file_;  // file of the parent folder, or -1 for none
};
// Cleans up after killed runs in and beside `folder`: brings back a folder that was moved aside and not yet
// replaced, and removes staging folders. It leaves alone those of processes that still run.
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
// A new folder beside the one that it will replace. The destructor removes it with its contents.
class StagingFolder {
public:
    // Error "output-write".
    static Result<StagingFolder> create(const fs::path& folder) {
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
    StagingFolder(StagingFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
    StagingFolder& operator=(StagingFolder&&) = delete;
    ~StagingFolder() {
        if (!path_.empty()) {
            std::error_code ignored;
            fs::remove_all(path_, ignored);
        }
    }

    const fs::path& path() const {
        return path_;
    }
    // Moves the new folder to the place of `folder`, with the permissions of `folder`, which is removed. On
    // error "output-write" `folder` is as it was.
    Status swapInto(const fs::path& folder) {
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

private:
    explicit StagingFolder(fs::path path) : path_(std::move(path)) {}
    fs::path path_;
};

// --- Files of a folder that must itself stay in place: a working folder, a mount point, or one whose parent
// can't be written ---

Diagnostic placeError(const fs::path& path, const std::string& why) {
    return makeError("output-write", path.string(), "can't be written: " + why,
                     "check the folder, its permissions and the free space; nothing was changed");
}

// tables.bin leaves first and arrives last. The manifest does the opposite, because a later run recognises
// the folder as a package by it.
int rank(const std::string& name) {
    return name == package::kTablesFile ? 0 : name == package::kManifestFile ? 2 : 1;
}

void removeEmptyParents(fs::path file, const fs::path& folder) {
    std::error_code error;
    for (file = file.parent_path(); file != folder && fs::remove(file, error); file = file.parent_path()) {
    }
}

bool isReal(const fs::path& path) {
    std::error_code error;
    return fs::canonical(path, error) == path && !error;
}

// A list of renames. They are undone in reverse order unless they are kept.
class Moves {
public:
    explicit Moves(fs::path folder) : folder_(std::move(folder)) {}
    Moves(const Moves&) = delete;
    Moves& operator=(const Moves&) = delete;
    ~Moves() {
        std::error_code ignored;
        for (auto move = done_.rbegin(); move != done_.rend(); ++move) {
            const auto& [from, to] = *move;
            fs::rename(to, from, ignored);
            removeEmptyParents(to, folder_);
        }
    }

    // Moves a file. `to` must not exist; its parent folders are created. The path must not contain a link,
    // because that could lead out of the folder.
    std::error_code move(const fs::path& from, const fs::path& to) {
        std::error_code error;
        if (fs::exists(fs::symlink_status(to, error))) {
            return std::make_error_code(std::errc::file_exists);
        }
        fs::create_directories(to.parent_path(), error);
        if (!error && !(isReal(from.parent_path()) && isReal(to.parent_path()))) {
            return std::make_error_code(std::errc::too_many_symbolic_link_levels);
        }
        if (!error) {
            fs::rename(from, to, error);
        }
        if (!error) {
            done_.emplace_back(from, to);
        }
        return error;
    }
    void keep() {
        done_.clear();
    }

private:
    fs::path folder_;
    std::vector<std::pair<fs::path, fs::path>> done_;
};

// Removes the files `leaving` (names relative to `folder`) and moves those of `arriving` in. A reader sees
// the earlier tables.bin, none, or the new one with all files that it names. On error "output-write"
// everything is as it was. Files that are not part of a package are never replaced.
Status replaceInPlace(std::span<const PackageFile* const> arriving, const std::vector<std::string>& leaving,
                      const fs::path& folder) {
    Result<StagingFolder> staging = StagingFolder::create(innerStaging(folder));
    if (!staging) {
        Diagnostic error = staging.error();
        error.where = folder.string();
        return error;
    }
    std::vector<const PackageFile*> incoming(arriving.begin(), arriving.end());
    std::ranges::sort(incoming, std::greater<>{}, [](const PackageFile* file) { return rank(file->name); });
    std::vector<std::string> outgoing = leaving;
    std::ranges::sort(outgoing, std::less<>{}, rank);

    // Writing the files comes first, because only that can fail for lack of space.
    const fs::path fresh = staging->path() / "new";
    for (const PackageFile* file : incoming) {
        std::error_code error;
        fs::create_directories((fresh / file->name).parent_path(), error);
        Status written = error ? Status(placeError(folder, error.message())) : okStatus();
        written = written ? base::writeStaged(fresh / file->name, file->bytes) : written;
        if (!written) {
            return placeError(folder / file->name, written.error().message);
        }
    }

    Moves moves(folder);
    for (const std::string& name : outgoing) {
        if (const std::error_code error = moves.move(folder / name, staging->path() / "old" / name)) {
            return placeError(folder / name, error.message());
        }
    }
    for (const PackageFile* file : incoming) {
        if (const std::error_code error = moves.move(fresh / file->name, folder / file->name)) {
            return placeError(folder / file->name, error.message());
        }
    }
    moves.keep();
    for (const std::string& name : outgoing) {
        removeEmptyParents(folder / name, folder);
    }
    return okStatus();
}

// A manifest is small. A larger file of that name was not made by Glint.
constexpr std::uint64_t kMaxManifestBytes = 1ULL << 28;

using Names = WrittenPackage::Names;

// Returns the names of the files of the package in `folder`; empty if it holds none.
Names packageFiles(const fs::path& folder) {
    if (const Result<base::Bytes> bytes =
            base::readFile(folder / package::kManifestFile, kMaxManifestBytes)) {
        return manifestFiles({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    }
    return {};
}

// Returns whether tables.bin has the right beginning. This recognises a package whose manifest is lost.
bool hasTables(const fs::path& folder) {
    const Result<base::Bytes> bytes = base::readFile(folder / package::kTablesFile);
    return bytes && bytes->size() >= sizeof package::kMagic &&
           std::memcmp(bytes->data(), package::kMagic, sizeof package::kMagic) == 0;
}

// Checks what the new package replaces: a missing or empty folder, or a package.
Result<Names> inspectFolder(const fs::path& folder) {
    std::error_code error;
    const fs::file_status status = fs::status(folder, error);
    if (!fs::exists(status)) {
        return Names{};
    }
    if (!fs::is_directory(status)) {
        return makeError("output-not-a-folder", folder.string(), "is not a folder",
                         "choose another output folder");
    }
    const bool empty = fs::is_empty(folder, error);
    if (error) {
        return placeError(folder, error.message());
    }
    Names names = packageFiles(folder);
    if (names.empty() && hasTables(folder)) {
        names = {package::kManifestFile, package::kTablesFile};
    }
    if (names.empty() && !empty) {
        return makeError("output-not-a-package", folder.string(), "holds files that are no package of Glint",
                         "choose an empty folder, or one that an earlier run wrote");
    }
    return names;
}

bool holdsBytes(const fs::path& path, std::span<const std::uint8_t> bytes) {
    std::error_code error;
    if (!fs::is_regular_file(fs::symlink_status(path, error)) || fs::file_size(path, error) != bytes.size() ||
        error) {
        return false;
    }
    const Result<base::Bytes> present = base::readFile(path);
    return present && std::ranges::equal(*present, bytes);
}

// Returns the names of the files that the folder already has.
Names unchangedFiles(const CompiledPackage& package, const fs::path& folder, const WrittenPackage* written) {
    std::vector<std::uint8_t> holds(package.files.size());
    base::runParallel(holds.size(), 0, [&](std::size_t i) {
        const PackageFile& file = package.files[i];
        const bool isKnown = written != nullptr && written->holds(folder, file);
        holds[i] = isKnown || holdsBytes(folder / file.name, file.bytes) ? 1 : 0;
        return true;
    });
    Names kept;
    for (std::size_t i = 0; i < holds.size(); ++i) {
        if (holds[i] != 0) {
            kept.insert(package.files[i].name);
        }
    }
    return kept;
}

bool isCurrent(const CompiledPackage& package, const Names& kept, const Names& earlier,
               const fs::path& folder) {
    std::error_code error;
    return kept.size() == package.files.size() && std::ranges::all_of(earlier, [&](const std::string& name) {
               return kept.contains(name) || !fs::exists(folder / name, error);
           });
}

// Gives the same file a second name, so that it keeps its time stamps. If the file system has no hard links,
// it is copied.
std::error_code keepFile(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::create_hard_link(from, to, error);
    if (!error) {
        return error;
    }
    fs::copy_file(from, to, error);
    if (!error) {
        fs::last_write_time(to, fs::last_write_time(from, error), error);
    }
    return error;
}

Status stagePackage(const CompiledPackage& package, const Names& kept, const fs::path& folder,
                    const fs::path& staging) {
    fs::path parent = staging;
    for (const PackageFile& file : package.files) {
        const fs::path target = staging / file.name;
        std::error_code error;
        if (target.parent_path() != parent) {
            parent = target.parent_path();
            fs::create_directories(parent, error);
        }
        if (error) {
            return placeError(target, error.message());
        }
        if (kept.contains(file.name) && !keepFile(folder / file.name, target)) {
            continue;
        }
        if (Status status = base::writeStaged(target, file.bytes); !status) {
            return placeError(folder / file.name, status.error().message);
        }
    }
    return okStatus();
}

// Files that users keep beside the package, a dependency file for instance, stay.
Status stageForeign(const Names& earlier, const fs::path& folder, const fs::path& staging) {
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const fs::path name = entry->path().lexically_relative(folder);
        const fs::path target = staging / name;
        const fs::file_status status = entry->symlink_status(error);
        std::error_code failure;
        if (fs::is_directory(status)) {
            const bool isParent = std::ranges::any_of(earlier, [&](const std::string& file) {
                return file.starts_with(name.generic_string() + "/");
            });
            if (!isParent) {
                fs::create_directories(target, failure);
            }
        } else if (!earlier.contains(name.generic_string())) {
            fs::create_directories(target.parent_path(), failure);
            if (!failure && fs::is_symlink(status)) {
                fs::copy_symlink(entry->path(), target, failure);
            } else if (!failure && fs::is_regular_file(status)) {
                failure = keepFile(entry->path(), target);
            } else if (!failure) {
                failure = std::make_error_code(std::errc::not_supported);
            }
        }
        if (failure) {
            return makeError("output-write", entry->path().string(),
                             "is in the way of the new package: " + failure.message(),
                             "move it elsewhere; nothing was changed");
        }
    }
    return error ? Status(placeError(folder, error.message())) : okStatus();
}

// Returns whether this process works in `folder` or below it. A shell would otherwise be left in a folder
// that no longer exists.
bool isWorkingFolder(const fs::path& folder) {
    std::error_code error;
    const fs::path current = fs::current_path(error);
    return !error && std::ranges::mismatch(folder, current).in1 == folder.end();
}

// Has the same effect as a swap, but file by file.
Status updateFolder(const CompiledPackage& package, const Names& kept, const Names& earlier,
                    const fs::path& folder) {
    std::vector<const PackageFile*> changed;
    std::vector<std::string> leaving;
    for (const PackageFile& file : package.files) {
        if (!kept.contains(file.name)) {
            changed.push_back(&file);
        }
    }
    std::error_code error;
    std::ranges::copy_if(earlier, std::back_inserter(leaving), [&](const std::string& name) {
        const fs::file_status status = fs::symlink_status(folder / name, error);
        return !kept.contains(name) && fs::exists(status) && !fs::is_directory(status);
    });
    return replaceInPlace(changed, leaving, folder);
}

// A mount point can't be swapped, nor can a folder whose parent can't be written.
Status orInPlace(const CompiledPackage& package, const Names& kept, const Names& earlier,
                 const fs::path& folder, const Diagnostic& swapError) {
    std::error_code error;
    return fs::is_directory(folder, error) ? updateFolder(package, kept, earlier, folder) : Status(swapError);
}

}  // namespace

Status checkPackageFolder(const fs::path& folder) {
    GLINT_TRY([[maybe_unused]] const auto names, inspectFolder(folder));
    const Status possible = base::checkOutputFolder(folder);
    return possible ? possible
                    : Status(makeError("output-write", folder.string(), possible.error().message,
                                       possible.error().hint));
}

namespace {

// Writes to a folder that resolveOutput() returned.
Status writeResolved(const CompiledPackage& package, const fs::path& resolved,
                     const WrittenPackage* written) {
    GLINT_TRY(const auto lock, OutputLock::acquire(resolved));
    recoverInterrupted(resolved);
    Names earlier = written != nullptr ? written->names(resolved) : Names();
    if (earlier.empty()) {
        GLINT_TRY(earlier, inspectFolder(resolved));
    }
    const Names kept = unchangedFiles(package, resolved, written);
    if (isCurrent(package, kept, earlier, resolved)) {
        return okStatus();
    }
    if (isWorkingFolder(resolved)) {
        return updateFolder(package, kept, earlier, resolved);
    }
    Result<StagingFolder> staging = StagingFolder::create(resolved);
    if (!staging) {
        return orInPlace(package, kept, earlier, resolved, staging.error());
    }
    GLINT_TRY_DO(stagePackage(package, kept, resolved, staging->path()));
    std::error_code error;
    if (fs::exists(resolved, error)) {
        GLINT_TRY_DO(stageForeign(earlier, resolved, staging->path()));
    }
    Status swapped = staging->swapInto(resolved);
    return swapped ? swapped : orInPlace(package, kept, earlier, resolved, swapped.error());
}

}  // namespace

std::optional<WrittenPackage::State> WrittenPackage::stateOf(const fs::path& path) {
    struct stat status {};
    if (lstat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) {
        return std::nullopt;
    }
    constexpr std::int64_t kNanoseconds = 1'000'000'000;
    return State{static_cast<std::int64_t>(status.st_mtim.tv_sec) * kNanoseconds + status.st_mtim.tv_nsec,
                 static_cast<std::uint64_t>(status.st_size), static_cast<std::uint64_t>(status.st_ino)};
}

bool WrittenPackage::isUnchanged(const fs::path& folder, std::string_view name) const {
    const auto known = files_.find(name);
    return folder == folder_ && known != files_.end() && known->second.state &&
           stateOf(folder / name) == known->second.state;
}

bool WrittenPackage::holds(const fs::path& folder, const PackageFile& file) const {
    return isUnchanged(folder, file.name) && files_.find(file.name)->second.hash == file.hash;
}

WrittenPackage::Names WrittenPackage::names(const fs::path& folder) const {
    Names names;
    if (isUnchanged(folder, package::kManifestFile)) {
        for (const auto& [name, file] : files_) {
            names.insert(name);
        }
    }
    return names;
}

void WrittenPackage::take(const CompiledPackage& package, const fs::path& folder) {
    std::map<std::string, File, std::less<>> files;
    for (const PackageFile& file : package.files) {
        files.emplace(file.name, File{stateOf(folder / file.name), file.hash});
    }
    folder_ = folder;
    files_ = std::move(files);
}

Status writePackage(const CompiledPackage& package, const fs::path& folder, WrittenPackage* written) {
    GLINT_TRY(const auto resolved, resolveOutput(folder));
    GLINT_TRY_DO(writeResolved(package, resolved, written));
    if (written != nullptr) {
        written->take(package, resolved);
    }
    return okStatus();
}

}  // namespace glint::compiler
