// Compiled modules by everything that decides about their words.
#pragma once

#include "cache/store.h"
#include "spirv/statistics.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

struct CachedModule {
    std::vector<std::uint32_t> spirv;
    SpirvStatistics statistics;
};

std::string packModule(const CachedModule& module);
// Nothing where `bytes` is no module.
std::optional<CachedModule> unpackModule(std::string_view bytes);

// Thread-safe, as the store is.
class ModuleCache {
public:
    // `compiler`: a text that is another for every compiler that may give other words. The store must outlive
    // the cache.
    ModuleCache(CacheStore& store, std::string compiler);

    // `source`: all of what is compiled, options included.
    std::optional<CachedModule> find(std::string_view source) const;
    void put(std::string_view source, const CachedModule& module) const;

private:
    std::string keyOf(std::string_view source) const;

    CacheStore& store_;
    std::string compiler_;
};

}  // namespace glint
