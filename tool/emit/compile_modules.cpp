#include "emit/compile_modules.h"

#include "emit/context.h"
#include "emit/module_files.h"
#include "emit/module_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

namespace glint::compiler {

namespace {

// The compiled form of one text, which several modules may have.
struct CompiledText {
    CachedModule module;
    bool compiled = false;
};

Result<CompiledText> compileText(const ModuleSource& source, const std::string& text, bool debugInfo,
                                 ModuleCache* cache, WarmModules* warm) {
    if (warm != nullptr) {
        if (std::optional<CachedModule> found = warm->findModule(text)) {
            return CompiledText{std::move(*found), false};
        }
    }
    if (cache != nullptr) {
        if (std::optional<CachedModule> found = cache->find(text)) {
            if (warm != nullptr) {
                warm->putModule(text, *found);
            }
            return CompiledText{std::move(*found), false};
        }
    }
    Result<CachedModule> module = compileMeasured(
        {source.name, source.stage, source.glsl.withPlaces(), source.functionsApart}, {debugInfo});
    if (!module) {
        return module.error();
    }
    if (cache != nullptr) {
        cache->put(text, *module);
    }
    if (warm != nullptr) {
        warm->putModule(text, *module);
    }
    return CompiledText{std::move(*module), true};
}

Result<CompiledText> takeText(const ModuleSource& source, const std::string& text,
                              const std::filesystem::path& file) {
    Result<CachedModule> module = readCompiledModule(file, text, source.name);
    return module ? Result<CompiledText>(CompiledText{std::move(*module), false}) : module.error();
}

constexpr std::string_view kComputeSuffix = ".comp";

// "uber.comp" is compiled to uber.spv. Other stages stay in the file's name: gbuffer.vert.spv.
std::string spirvFileName(const ModuleSource& source) {
    std::string_view stem = source.name;
    if (stem.ends_with(kComputeSuffix)) {
        stem.remove_suffix(kComputeSuffix.size());
    }
    return std::string(stem) + ".spv";
}

CompiledModule makeCompiled(ModuleSource& source, const CompiledText& text, bool isFirst) {
    CompiledModule module;
    module.key = source.key;
    module.file = spirvFileName(source);
    module.name = std::move(source.name);
    module.glsl = std::move(source.glsl);
    module.spirv = text.module.spirv;
    module.statistics = text.module.statistics;
    module.hash = base::hashBytes({reinterpret_cast<const std::uint8_t*>(module.spirv.data()),
                                   module.spirv.size() * sizeof(std::uint32_t)});
    module.compiled = text.compiled && isFirst;
    return module;
}

// Runs work(0) … work(count - 1). They are started in order, and none is started after one has returned
// false.
template <typename Work>
void runParallel(std::size_t count, int jobs, const Work& work) {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    const auto loop = [&] {
        for (std::size_t i = next++; i < count && !failed; i = next++) {
            if (!work(i)) {
                failed = true;
            }
        }
    };
    const std::size_t wanted =
        jobs > 0 ? static_cast<std::size_t>(jobs) : std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> threads;
    try {
        // This thread works too, so one thread fewer is started.
        for (std::size_t i = 1; i < std::min(wanted, count); ++i) {
            threads.emplace_back(loop);
        }
    } catch (const std::system_error&) {
        // No more threads can be created, so the existing ones do the work.
    }
    loop();
}

// Words are compared too, because modules with equal hashes may still differ.
void shareFiles(std::vector<CompiledModule>& modules) {
    std::multimap<std::uint64_t, std::size_t> firsts;
    for (std::size_t i = 0; i < modules.size(); ++i) {
        const auto [begin, end] = firsts.equal_range(modules[i].hash);
        const auto twin = std::find_if(
            begin, end, [&](const auto& entry) { return modules[entry.second].spirv == modules[i].spirv; });
        if (twin != end) {
            modules[i].file = modules[twin->second].file;
        } else {
            firsts.emplace(modules[i].hash, i);
        }
    }
}

// The distinct texts of the modules, in the order of the modules.
struct DistinctTexts {
    std::map<std::string, std::size_t> places;
    std::vector<std::size_t> textOf;        // by module: index of its text
    std::vector<std::size_t> firsts;        // by text: the first module that has it
    std::vector<const std::string*> texts;  // by text; they point into `places`
};

DistinctTexts findTexts(std::span<const ModuleSource> sources, bool debugInfo) {
    DistinctTexts distinct;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const auto [place, added] =
            distinct.places.emplace(makeModuleText(sources[i], debugInfo), distinct.firsts.size());
        distinct.textOf.push_back(place->second);
        if (added) {
            distinct.firsts.push_back(i);
            distinct.texts.push_back(&place->first);
        }
    }
    return distinct;
}

// Makes the modules of `sources` from the results of work(0) … work(texts - 1), each a Result<CompiledText>.
// The names and texts of `sources` are moved into the modules.
template <typename Work>
Result<std::vector<CompiledModule>> makeModules(std::vector<ModuleSource>& sources,
                                                const DistinctTexts& distinct, int jobs, const Work& work) {
    std::vector<std::optional<Result<CompiledText>>> results(distinct.firsts.size());
    runParallel(results.size(), jobs, [&](std::size_t text) {
        results[text] = work(text);
        return results[text]->ok();
    });
    // Texts are started in order, so every text before the first error has a result.
    for (const std::optional<Result<CompiledText>>& result : results) {
        if (!result->ok()) {
            return result->error();
        }
    }
    std::vector<CompiledModule> modules;
    modules.reserve(sources.size());
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const std::size_t text = distinct.textOf[i];
        modules.push_back(makeCompiled(sources[i], **results[text], distinct.firsts[text] == i));
    }
    shareFiles(modules);
    return modules;
}

}  // namespace

Result<CachedModule> compileMeasured(const ShaderSource& source, const ShaderCompileOptions& options) {
    Result<std::vector<std::uint32_t>> spirv = compileShader(source, options);
    if (!spirv) {
        return spirv.error();
    }
    const Result<SpirvStatistics> statistics = measureSpirv(*spirv);
    return statistics ? Result<CachedModule>(CachedModule{std::move(*spirv), *statistics})
                      : statistics.error();
}

std::string moduleCompiler() {
    return fmt::format("glint {}; {}", toolVersion(), compilerIdentity());
}

Result<std::vector<CompiledModule>> compileModules(std::vector<ModuleSource> sources, int jobs,
                                                   bool debugInfo, ModuleCache* cache, WarmModules* warm) {
    const DistinctTexts distinct = findTexts(sources, debugInfo);
    return makeModules(sources, distinct, jobs, [&](std::size_t text) {
        return compileText(sources[distinct.firsts[text]], *distinct.texts[text], debugInfo, cache, warm);
    });
}

Result<std::vector<CompiledModule>> takeModules(std::vector<ModuleSource> sources, bool debugInfo,
                                                const std::filesystem::path& folder) {
    const DistinctTexts distinct = findTexts(sources, debugInfo);
    const std::vector<std::string> files = nameModuleTexts(distinct.texts);
    return makeModules(sources, distinct, 1, [&](std::size_t text) {
        return takeText(sources[distinct.firsts[text]], *distinct.texts[text],
                        folder / (files[text] + std::string(kCompiledModuleSuffix)));
    });
}

}  // namespace glint::compiler
