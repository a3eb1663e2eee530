// A folder of results by key: bounded, shared by processes, and never trusted more than its checks allow.
#pragma once

#include <glint/result.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace glint {

struct StoreOptions {
    std::filesystem::path folder;
    std::uint64_t maxBytes = 512ULL << 20;
    // Names the file of a key; tests put in one that collides.
    std::function<std::uint64_t(std::string_view key)> hash;
};

// One file an entry, which holds the whole key: an entry counts only if its key has the same bytes and its
// checksum is right. Files appear by a rename, so that readers and writers of other processes need no lock;
// what vanishes or is torn is no entry. Thread-safe. Nothing here fails the caller: see trouble().
class CacheStore {
public:
    explicit CacheStore(StoreOptions options);

    // The value of `key` among the entries of `kind`, which is part of the file's name. Marks it as used.
    std::optional<std::string> find(std::string_view kind, std::string_view key);
    // Replaces what is there. The value can be lost at any time.
    void put(std::string_view kind, std::string_view key, std::string_view value);
    // If anything was put: removes the entries that were not used for longest, until at most maxBytes are
    // left, and what writers that were killed left behind.
    void trim();
    // The first reason why something could not be stored.
    std::optional<Diagnostic> trouble() const;
    const std::filesystem::path& folder() const {
        return options_.folder;
    }

private:
    std::filesystem::path fileOf(std::string_view kind, std::string_view key) const;
    void report(const std::filesystem::path& path, const std::string& why);

    StoreOptions options_;
    std::atomic<bool> changed_{false};
    mutable std::mutex mutex_;
    std::optional<Diagnostic> trouble_;
};

}  // namespace glint
