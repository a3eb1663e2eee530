// Stores compiled modules by everything that decides about their words.
#pragma once

#include "cache/store.h"
#include "spirv/statistics.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::compiler {

// Identifies a text.
using TextHash = std::pair<std::uint64_t, std::uint64_t>;
TextHash hashOfText(std::string_view text);

struct CachedModule {
    std::vector<std::uint32_t> spirv;
    SpirvStatistics statistics;

    std::span<const std::uint8_t> bytes() const {
        return {reinterpret_cast<const std::uint8_t*>(spirv.data()), spirv.size() * sizeof(std::uint32_t)};
    }
};

std::string packModule(const CachedModule& module);
// Returns nothing if `bytes` is not a module.
std::optional<CachedModule> unpackModule(std::string_view bytes);

// Thread-safe, because the store is.
class ModuleCache {
public:
    // `compiler` must differ between compilers that may give different words for the same source. The store
    // must outlive the cache.
    ModuleCache(CacheStore& store, std::string compiler);

    // `source` is a hash of everything that is compiled, including the options.
    std::optional<CachedModule> find(const TextHash& source) const;
    void put(const TextHash& source, const CachedModule& module) const;
    CacheStore& store() const {
        return store_;
    }

private:
    std::string keyOf(const TextHash& source) const;

    CacheStore& store_;
    std::string compiler_;
};

}  // namespace glint::compiler
