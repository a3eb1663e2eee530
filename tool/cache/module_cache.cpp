#include "cache/module_cache.h"

#include "base/files.h"
#include "cache/store.h"

#include <cstring>
#include <utility>

namespace glint::compiler {

namespace {

constexpr std::string_view kKind = "module";

// This fails if a count is added to the statistics, because it must then be packed here too.
static_assert(sizeof(SpirvStatistics) == sizeof(std::uint64_t) + 6 * sizeof(std::uint32_t));

}  // namespace

TextHash hashOfText(std::string_view text) {
    return {base::hashBytes(base::asBytes(text)), base::hashBytes(base::asBytes(text), 1)};
}

std::string packModule(const CachedModule& module) {
    const SpirvStatistics& counts = module.statistics;
    Packer packer;
    for (const std::uint64_t count :
         {counts.bytes, std::uint64_t{counts.instructions}, std::uint64_t{counts.textureFetches},
          std::uint64_t{counts.rayQueries}, std::uint64_t{counts.branches}, std::uint64_t{counts.traces},
          std::uint64_t{counts.functions}}) {
        packer.add(count);
    }
    const std::span<const std::uint8_t> bytes = module.bytes();
    packer.add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    return packer.take();
}

std::optional<CachedModule> unpackModule(std::string_view bytes) {
    CachedModule module;
    SpirvStatistics& counts = module.statistics;
    Unpacker unpacker(bytes);
    counts.bytes = unpacker.number().value_or(0);
    for (std::uint32_t* const count : {&counts.instructions, &counts.textureFetches, &counts.rayQueries,
                                       &counts.branches, &counts.traces, &counts.functions}) {
        *count = static_cast<std::uint32_t>(unpacker.number().value_or(0));
    }
    const std::optional<std::string_view> words = unpacker.text();
    if (!words || !unpacker.atEnd() || words->empty() || words->size() % sizeof(std::uint32_t) != 0) {
        return std::nullopt;
    }
    module.spirv.resize(words->size() / sizeof(std::uint32_t));
    std::memcpy(module.spirv.data(), words->data(), words->size());
    return module;
}

ModuleCache::ModuleCache(CacheStore& store, std::string compiler)
    : store_(store), compiler_(std::move(compiler)) {}

std::string ModuleCache::keyOf(const TextHash& source) const {
    return Packer().add(compiler_).add(source.first).add(source.second).take();
}

std::optional<CachedModule> ModuleCache::find(const TextHash& source) const {
    const std::optional<std::string> found = store_.find(kKind, keyOf(source));
    return found ? unpackModule(*found) : std::nullopt;
}

void ModuleCache::put(const TextHash& source, const CachedModule& module) const {
    store_.put(kKind, keyOf(source), packModule(module));
}

}  // namespace glint::compiler
