// Fuzzes a folder of the cache: the file of an entry as a crash or another program left it, and the values in
// it as other versions may have packed them. The worst result may be that there is no entry.
#include "cache/action.h"
#include "cache/module_cache.h"
#include "cache/store.h"
#include "cli/compile/compile.h"
#include "emit/warm_modules.h"
#include "fuzz/fuzz_target.h"
#include "fuzz/scratch_file.h"
#include "support/temporary_folder.h"

#include <optional>
#include <string>
#include <utility>

namespace {

using glint::fuzz::require;

constexpr std::string_view kCompiler = "compiler";
constexpr std::string_view kSource = "source";

// All keys of a kind share one file, that of hash 0, so that its name is known.
glint::compiler::CacheStore& store() {
    static const glint::test::TemporaryFolder folder;
    static glint::compiler::CacheStore store(
        {folder.path(), 1ULL << 20, [](std::string_view) { return std::uint64_t{0}; }});
    return store;
}

std::filesystem::path fileOf(const std::string& kind) {
    return store().folder() / "v1" / "00" / ("00000000000000." + kind);
}

void readEntry(std::span<const std::uint8_t> bytes, std::string_view text) {
    static glint::fuzz::ScratchFile file(fileOf("entry"));
    file.hold(bytes);
    const std::optional<std::string> found = store().find("entry", kSource);
    require(!found || text.find(*found) != std::string_view::npos, "a value is part of its entry");
}

void readAction(std::string_view text) {
    const std::optional<glint::compiler::ActionRecord> record = glint::compiler::unpackAction(text);
    if (record) {
        const std::string packed = glint::compiler::pack(*record);
        const std::optional<glint::compiler::ActionRecord> again = glint::compiler::unpackAction(packed);
        require(again && glint::compiler::pack(*again) == packed, "a record reads back as it was packed");
    }
}

void readSummary(std::string_view text) {
    const std::optional<glint::cli::CompileSummary> summary = glint::cli::unpackSummary(text, true);
    if (summary) {
        const std::string packed = glint::cli::pack(*summary);
        const std::optional<glint::cli::CompileSummary> again = glint::cli::unpackSummary(packed, true);
        require(again && glint::cli::pack(*again) == packed, "a summary reads back as it was packed");
    }
}

void readTexts(std::string_view text) {
    using glint::compiler::WarmModules;
    const std::string packed = WarmModules::pack(WarmModules::unpack(text));
    require(WarmModules::pack(WarmModules::unpack(packed)) == packed, "texts read back as they were packed");
}

void readModule(std::string_view text) {
    const std::optional<glint::compiler::CachedModule> module = glint::compiler::unpackModule(text);
    require(!module || !module->spirv.empty(), "a cached module has words");
}

// The store handles all values alike, and writing takes longer than everything else here.
void storeModule(std::string_view text) {
    const glint::compiler::TextHash source = glint::compiler::hashOfText(kSource);
    const std::string key =
        glint::compiler::Packer().add(kCompiler).add(source.first).add(source.second).take();
    store().put("module", key, text);
    require(store().find("module", key) == text, "the store gives back what was put");
    const std::optional<glint::compiler::CachedModule> module =
        glint::compiler::ModuleCache(store(), std::string(kCompiler)).find(source);
    require(module.has_value() == glint::compiler::unpackModule(text).has_value(),
            "a stored module is as it was put");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = glint::fuzz::asText(data, size);
    constexpr std::size_t kStoredSizes = 64;
    // The first call makes the folder.
    static bool isFirst = true;
    if (std::exchange(isFirst, false) || size % kStoredSizes == 0) {
        storeModule(text);
    }
    readModule(text);
    readEntry({data, size}, text);
    readAction(text);
    readSummary(text);
    readTexts(text);
    return 0;
}
