// A folder of results by key. Its size is bounded, processes share it, and its contents are checked before
// use.
#pragma once

#include "base/memo.h"

#include <glint/result.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace glint::compiler {

class Packer {
public:
    Packer& add(std::uint64_t number);
    Packer& add(std::string_view text);
    std::string take() {
        return std::move(bytes_);
    }

private:
    std::string bytes_;
};

// Unpacks the values of a Packer, in the same order. From the first mismatch on it returns nothing.
class Unpacker {
public:
    explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

    std::optional<std::uint64_t> number();
    // A number of things that take at least `leastBytes` each, so that the remaining bytes can hold them.
    std::optional<std::uint64_t> count(std::size_t leastBytes);
    // Valid as long as the bytes.
    std::optional<std::string_view> text();
    bool atEnd() const {
        return !failed_ && rest_.empty();
    }

private:
    bool failed_ = false;
    std::string_view rest_;
};

struct StoreOptions {
    std::filesystem::path folder;
    std::uint64_t maxBytes = 512ULL << 20;
    // Names the file of a key. Tests replace it by a function with collisions.
    std::function<std::uint64_t(std::string_view key)> hash;
};

// Each entry is one file, which holds the whole key. An entry is valid only if its key has the same bytes and
// its checksum is right. Files appear by a rename, so readers and writers of other processes need no lock;
// files that vanish or are torn count as no entry. Thread-safe. No failure reaches the caller: see trouble().
class CacheStore final : public base::Memo {
public:
    explicit CacheStore(StoreOptions options);

    // Returns the value of `key` among the entries of `kind`, which is part of the file's name, and marks it
    // as used.
    std::optional<std::string> find(std::string_view kind, std::string_view key) override;
    // Replaces an existing value. The value can be lost at any time.
    void put(std::string_view kind, std::string_view key, std::string_view value) override;
    // If anything was put, removes the entries that were unused for longest until at most maxBytes are left.
    // It also removes the remains of killed writers.
    void trim();
    // Returns the first reason why something could not be stored.
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

}  // namespace glint::compiler
