// Stores compiled modules by everything that decides about their words.
#pragma once

#include "cache/store.h"
#include "spirv/statistics.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

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

    // `source` must hold everything that is compiled, including the options.
    std::optional<CachedModule> find(std::string_view source) const;
    void put(std::string_view source, const CachedModule& module) const;

private:
    std::string keyOf(std::string_view source) const;

    CacheStore& store_;
    std::string compiler_;
};

}  // namespace glint::compiler
