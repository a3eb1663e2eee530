#include "cache/store.h"

#include "base/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace fs = std::filesystem;

Packer& Packer::add(std::uint64_t number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    bytes_.append(bytes, sizeof bytes);
    return *this;
}

Packer& Packer::add(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    bytes_ += text;
    return *this;
}

std::optional<std::uint64_t> Unpacker::number() {
    std::uint64_t number = 0;
    failed_ = failed_ || rest_.size() < sizeof number;
    if (failed_) {
        return std::nullopt;
    }
    std::memcpy(&number, rest_.data(), sizeof number);
    rest_.remove_prefix(sizeof number);
    return number;
}

std::optional<std::uint64_t> Unpacker::count(std::size_t leastBytes) {
    const std::optional<std::uint64_t> value = number();
    failed_ = failed_ || *value > rest_.size() / leastBytes;
    return failed_ ? std::nullopt : value;
}

std::optional<std::string_view> Unpacker::text() {
    const std::optional<std::uint64_t> size = count(1);
    if (!size) {
        return std::nullopt;
    }
    const std::string_view text = rest_.substr(0, *size);
    rest_.remove_prefix(*size);
    return text;
}

namespace {

// This number grows when the layout of entries changes, so that versions of glint can share a folder without
// reading each other's entries.
constexpr std::string_view kLayout = "v1";
constexpr std::string_view kEntryMagic = "glint cache entry 1\n";
constexpr std::uint64_t kMaxEntryBytes = 1ULL << 30;
constexpr std::string_view kTemporary = ".tmp";
// A writer that has taken longer than this is assumed dead.
constexpr auto kAbandoned = std::chrono::hours(1);
// Backup tools and `du` recognise the folder as a cache by this file: https://bford.info/cachedir/
constexpr const char* kTagFile = "CACHEDIR.TAG";
constexpr std::string_view kFolderTag =
    "Signature: 8a477f597d28d172789f06886806bc55\n"
    "# Compiled shaders of glint. May be deleted at any time.\n";

std::uint64_t checksum(std::string_view key, std::string_view value) {
    return base::hashBytes({reinterpret_cast<const std::uint8_t*>(value.data()), value.size()},
                           base::hashBytes(key));
}

// Writes all of `bytes` to a file that must not exist yet. Returns 0, or errno.
int writeNew(const fs::path& path, std::string_view bytes) {
    constexpr int kMode = 0666;  // the user's mask removes some of these bits
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
    if (file < 0) {
        return errno;
    }
    int failure = 0;
    while (!bytes.empty() && failure == 0) {
        const ssize_t written = write(file, bytes.data(), bytes.size());
        if (written > 0) {
            bytes.remove_prefix(static_cast<std::size_t>(written));
        } else if (errno != EINTR) {
            failure = errno;
        }
    }
    if (close(file) != 0 && failure == 0) {
        failure = errno;
    }
    return failure;
}

struct Entry {
    fs::path path;
    std::uint64_t bytes = 0;
    fs::file_time_type used;
};

// Entries that other processes remove meanwhile are left out.
std::vector<Entry> listEntries(const fs::path& folder) {
    std::vector<Entry> entries;
    const auto now = fs::file_time_type::clock::now();
    std::error_code error;
    for (fs::recursive_directory_iterator file(folder, error), end; !error && file != end;
         file.increment(error)) {
        std::error_code gone;
        if (!file->is_regular_file(gone) || gone) {
            continue;
        }
        Entry entry{file->path(), file->file_size(gone), file->last_write_time(gone)};
        if (gone) {
            continue;
        }
        if (entry.path.extension().string().starts_with(kTemporary)) {
            if (now - entry.used > kAbandoned) {
                fs::remove(entry.path, gone);
            }
            continue;
        }
        entries.push_back(std::move(entry));
    }
    return entries;
}

}  // namespace

CacheStore::CacheStore(StoreOptions options) : options_(std::move(options)) {
    if (!options_.hash) {
        options_.hash = [](std::string_view key) { return base::hashBytes(key); };
    }
}

fs::path CacheStore::fileOf(std::string_view kind, std::string_view key) const {
    const std::string hash = base::hexHash(options_.hash(key));
    return options_.folder / kLayout / hash.substr(0, 2) / fmt::format("{}.{}", hash.substr(2), kind);
}

std::optional<std::string> CacheStore::find(std::string_view kind, std::string_view key) {
    const fs::path path = fileOf(kind, key);
    const Result<base::Bytes> bytes = base::readFile(path, kMaxEntryBytes);
    if (!bytes || !base::asText(*bytes).starts_with(kEntryMagic)) {
        return std::nullopt;
    }
    Unpacker entry(base::asText(*bytes).substr(kEntryMagic.size()));
    const std::optional<std::uint64_t> sum = entry.number();
    const std::optional<std::string_view> held = entry.text();
    const std::optional<std::string_view> value = entry.text();
    if (!sum || !held || !value || !entry.atEnd() || *held != key || *sum != checksum(*held, *value)) {
        return std::nullopt;
    }
    // If the time stamp can't be set, the entry is only removed sooner.
    std::error_code ignored;
    fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
    return std::string(*value);
}

void CacheStore::put(std::string_view kind, std::string_view key, std::string_view value) {
    const fs::path path = fileOf(kind, key);
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) {
        return report(path.parent_path(), error.message());
    }
    changed_ = true;
    const std::string bytes =
        std::string(kEntryMagic) + Packer().add(checksum(key, value)).add(key).add(value).take();
    const fs::path temporary = fmt::format("{}{}{}-{}", path.string(), kTemporary, getpid(),
                                           std::hash<std::thread::id>()(std::this_thread::get_id()));
    if (const int failure = writeNew(temporary, bytes); failure != 0) {
        if (failure != EEXIST) {
            fs::remove(temporary, error);
        }
        return report(path, std::strerror(failure));
    }
    fs::rename(temporary, path, error);
    if (error) {
        report(path, error.message());
        fs::remove(temporary, error);
    }
}

void CacheStore::trim() {
    if (!changed_.exchange(false)) {
        return;
    }
    std::error_code error;
    if (!fs::exists(options_.folder / kTagFile, error)) {
        // An error is ignored, because nothing depends on this file.
        (void)base::writeFile(options_.folder / kTagFile, kFolderTag);
    }
    std::vector<Entry> entries = listEntries(options_.folder / kLayout);
    std::uint64_t bytes = 0;
    for (const Entry& entry : entries) {
        bytes += entry.bytes;
    }
    if (bytes <= options_.maxBytes) {
        return;
    }
    std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
        return a.used != b.used ? a.used < b.used : a.path < b.path;
    });
    for (const Entry& entry : entries) {
        if (bytes <= options_.maxBytes) {
            break;
        }
        if (fs::remove(entry.path, error) || !error) {
            bytes -= entry.bytes;
        }
    }
}

std::optional<Diagnostic> CacheStore::trouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
}

void CacheStore::report(const fs::path& path, const std::string& why) {
    const std::lock_guard lock(mutex_);
    if (!trouble_) {
        trouble_ = Diagnostic{Severity::Note, "cache-write", path.string(), "can't be written: " + why,
                              "nothing is lost but time; name another folder with --cache, or --cache none"};
    }
}

}  // namespace glint::compiler
