#include "base/files.h"

#include <xxhash.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

namespace glint::base {

namespace fs = std::filesystem;

std::uint64_t hashBytes(std::span<const std::uint8_t> bytes, std::uint64_t seed) {
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

std::uint64_t hashBytes(std::string_view text) {
    return hashBytes(asBytes(text));
}

std::string hexHash(std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

Result<Bytes> readFile(const fs::path& path, std::uint64_t maxBytes) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
        const bool exists = fs::exists(path, error);
        return makeError("file-open", path.string(), exists ? "is not a regular file" : "no such file",
                         "check the path");
    }
    const std::uint64_t size = fs::file_size(path, error);
    if (error) {
        return makeError("file-open", path.string(), error.message());
    }
    if (size > maxBytes) {
        return makeError(
            "file-size", path.string(),
            "is " + std::to_string(size) + " bytes long; the limit is " + std::to_string(maxBytes));
    }
    const File file(std::fopen(path.c_str(), "rb"));
    if (!file) {
        return makeError("file-open", path.string(), std::strerror(errno), "check the file's permissions");
    }
    Bytes bytes(size);
    if (size > 0 && std::fread(bytes.data(), 1, size, file.get()) != size) {
        return makeError("file-read", path.string(), "ended early or could not be read");
    }
    return bytes;
}

Result<FileDigest> digestFile(const fs::path& path) {
    std::error_code error;
    const File file(fs::is_regular_file(path, error) ? std::fopen(path.c_str(), "rb") : nullptr);
    if (!file) {
        return makeError("file-open", path.string(), "can't be opened as a regular file", "check the path");
    }
    struct StateDeleter {
        void operator()(XXH3_state_t* state) const {
            XXH3_freeState(state);
        }
    };
    const std::unique_ptr<XXH3_state_t, StateDeleter> state(XXH3_createState());
    XXH3_64bits_reset(state.get());
    // A piece of this size stays in the cache of a core.
    constexpr std::size_t kPiece = 1U << 17;
    const auto piece = std::make_unique_for_overwrite<std::uint8_t[]>(kPiece);
    // The file's own buffer would only add a copy.
    std::setvbuf(file.get(), nullptr, _IONBF, 0);
    FileDigest digest;
    std::size_t count = kPiece;
    while (count == kPiece) {
        count = std::fread(piece.get(), 1, kPiece, file.get());
        XXH3_64bits_update(state.get(), piece.get(), count);
        digest.bytes += count;
    }
    if (std::ferror(file.get()) != 0) {
        return makeError("file-read", path.string(), "could not be read");
    }
    digest.hash = XXH3_64bits_digest(state.get());
    return digest;
}

Status writeFile(const fs::path& path, std::span<const std::uint8_t> bytes) {
    removeAbandoned(path);
    return writeStaged(path, bytes);
}

Status writeFile(const fs::path& path, std::string_view text) {
    return writeFile(path, asBytes(text));
}

namespace {

// Temporary files are called "scene.lock.glint-tmp-1234", with the number of the process.
constexpr std::string_view kTag = ".glint-tmp-";

Diagnostic writeError(const fs::path& path, const std::string& why) {
    return makeError("file-write", path.string(), "can't be written: " + why,
                     "check the folder, its permissions and the free space");
}

bool holds(const fs::path& path, std::span<const std::uint8_t> bytes) {
    std::error_code error;
    if (fs::file_size(path, error) != bytes.size() || error) {
        return false;
    }
    const Result<Bytes> present = readFile(path);
    return present && std::memcmp(present->data(), bytes.data(), bytes.size()) == 0;
}

// Returns 0, or errno.
int writeNew(const fs::path& path, std::span<const std::uint8_t> bytes) {
    File file(std::fopen(path.c_str(), "wb"));
    if (!file) {
        return errno;
    }
    if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) {
        return errno;
    }
    // The file is closed here because a full disk may show only when the buffers are flushed.
    return std::fclose(file.release()) != 0 ? errno : 0;
}

fs::path folderOf(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : ".";
}

fs::path temporaryOf(const fs::path& path) {
    return path.string() + std::string(kTag) + std::to_string(getpid());
}

// Makes a file without a name in the folder of `path`, so that nothing is left even by a process that is
// killed. Where the file system has none, it is the temporary file of `path`. Returns 0, or errno.
int tryToWrite(const fs::path& path) {
#ifdef O_TMPFILE
    constexpr mode_t kOwner = 0600;
    if (const int file = open(folderOf(path).c_str(), O_TMPFILE | O_WRONLY, kOwner); file >= 0) {
        close(file);
        return 0;
    }
    if (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL) {
        return errno;
    }
#endif
    const fs::path probe = temporaryOf(path);
    const int failure = writeNew(probe, {});
    std::error_code ignored;
    fs::remove(probe, ignored);
    return failure;
}

bool isOfDeadProcess(std::string_view number) {
    long process = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), process);
    return error == std::errc() && end == number.data() + number.size() && process > 0 &&
           kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH;
}

}  // namespace

std::span<const std::uint8_t> asBytes(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

Result<StagedFile> StagedFile::create(const fs::path& path, std::span<const std::uint8_t> bytes) {
    if (holds(path, bytes)) {
        return StagedFile(path, {});
    }
    StagedFile staged(path, temporaryOf(path));
    if (const int failure = writeNew(staged.temporary_, bytes); failure != 0) {
        return writeError(path, std::strerror(failure));
    }
    return staged;
}

StagedFile::StagedFile(fs::path path, fs::path temporary)
    : path_(std::move(path)), temporary_(std::move(temporary)) {}

StagedFile::StagedFile(StagedFile&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, fs::path())) {}

StagedFile::~StagedFile() {
    if (!temporary_.empty()) {
        std::error_code ignored;
        fs::remove(temporary_, ignored);
    }
}

Status StagedFile::commit() {
    if (temporary_.empty()) {
        return okStatus();
    }
    std::error_code error;
    fs::rename(temporary_, path_, error);
    if (error) {
        return writeError(path_, error.message());
    }
    temporary_.clear();
    return okStatus();
}

Status writeStaged(const fs::path& path, std::span<const std::uint8_t> bytes) {
    Result<StagedFile> staged = StagedFile::create(path, bytes);
    return staged ? staged->commit() : Status(staged.error());
}

Status checkOutputFile(const fs::path& path) {
    std::error_code error;
    const fs::path parent = folderOf(path);
    if (!fs::is_directory(parent, error)) {
        return makeError("output-folder", path.string(),
                         "can't be written, because its folder does not exist",
                         "make the folder " + parent.string() + " first");
    }
    if (fs::is_directory(path, error)) {
        return makeError("output-folder", path.string(), "is a folder", "name a file within it");
    }
    const int failure = tryToWrite(path);
    return failure == 0 ? okStatus() : Status(writeError(path, std::strerror(failure)));
}

Status checkOutputFolder(const fs::path& folder) {
    std::error_code error;
    fs::path present = fs::absolute(folder.empty() ? fs::path(".") : folder, error);
    while (!fs::exists(present, error) && present.has_relative_path()) {
        present = present.parent_path();
    }
    if (!fs::is_directory(present, error)) {
        return writeError(folder, present.string() + " is no folder");
    }
    const int failure = tryToWrite(present / "output");
    return failure == 0 ? okStatus() : Status(writeError(folder, std::strerror(failure)));
}

void removeAbandoned(const fs::path& path) {
    const std::string prefix = path.filename().string() + std::string(kTag);
    std::vector<fs::path> found;
    std::error_code error;
    for (fs::directory_iterator entry(folderOf(path), error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.starts_with(prefix) && isOfDeadProcess(std::string_view(name).substr(prefix.size()))) {
            found.push_back(entry->path());
        }
    }
    for (const fs::path& file : found) {
        fs::remove(file, error);
    }
}

}  // namespace glint::base
