#include "base/parallel.h"
#include "cache/module_cache.h"
#include "emit/module_files.h"
#include "emit/modules.h"
#include "emit/warm_modules.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

namespace glint::compiler {

namespace {

// The compiled form of one text, which several modules may have.
struct CompiledText {
    std::shared_ptr<const HashedModule> module;
    bool compiled = false;
    bool folded = false;  // and not optimised, though the settings ask for it
};

CompiledText textOf(CachedModule module, bool compiled) {
    return {std::make_shared<const HashedModule>(std::move(module)), compiled};
}

Result<ShaderSource> shaderOf(const ModuleSource& source) {
    GLINT_TRY(const auto unit, source.glsl->unit());
    return ShaderSource{source.name, source.stage, unit->withPlaces(), source.functionsApart};
}

Result<CompiledText> takeText(const ModuleSource& source, const std::string& text,
                              const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / (nameOfModuleText(text) + std::string(kCompiledModuleSuffix));
    Result<CachedModule> module = readCompiledModule(file, text, source.name);
    return module ? Result<CompiledText>(textOf(std::move(*module), false)) : module.error();
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
    module.glsl = source.glsl;
    module.spirv = {text.module, text.module->module.spirv};
    module.statistics = text.module->module.statistics;
    module.hash = text.module->hash;
    module.compiled = text.compiled && isFirst;
    module.folded = text.folded;
    return module;
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

// The distinct texts of modules and their parts.
class DistinctTexts {
public:
    struct Text {
        const ModuleSource* source = nullptr;  // the first that has it
        TextHash hash;
        std::vector<std::size_t> parts;  // texts, the one with the entry point first
    };

    DistinctTexts(std::span<const ModuleSource> sources, const ShaderCompileOptions& options)
        : options_(options) {
        for (std::size_t i = 0; i < sources.size(); ++i) {
            const std::size_t known = texts_.size();
            textOf_.push_back(add(sources[i]));
            isFirst_.push_back(textOf_.back() >= known);
        }
    }
    const std::vector<Text>& texts() const {
        return texts_;
    }
    std::size_t textOf(std::size_t module) const {
        return textOf_[module];
    }
    // Returns whether no module before this one has its text.
    bool isFirst(std::size_t module) const {
        return isFirst_[module];
    }

private:
    // Texts of parts come before those that are joined from them.
    std::size_t add(const ModuleSource& source) {
        std::vector<std::size_t> parts;
        for (const std::shared_ptr<const ModuleSource>& part : source.parts) {
            parts.push_back(add(*part));
        }
        const auto [place, added] = places_.emplace(hashOfModuleText(source, options_), texts_.size());
        if (added) {
            texts_.push_back({&source, place->first, std::move(parts)});
        }
        return place->second;
    }

    const ShaderCompileOptions& options_;
    std::map<TextHash, std::size_t> places_;
    std::vector<Text> texts_;
    std::vector<std::size_t> textOf_;
    std::vector<bool> isFirst_;
};

// Compiles texts on several threads, and joins what is joined as soon as its parts are there.
class TextCompiler {
public:
    TextCompiler(const std::vector<DistinctTexts::Text>& texts, const ShaderCompileOptions& options,
                 ModuleCache* cache, WarmModules* warm, NewShaders newShaders,
                 const std::function<void(std::size_t, std::size_t)>& progress)
        : texts_(texts),
          options_(options),
          foldsNew_(options.optimize && newShaders == NewShaders::Folded),
          cache_(cache),
          warm_(warm),
          progress_(progress),
          results_(texts.size()),
          done_(texts.size()) {}

    // Returns the result of each text; texts of parts that nothing needed have none. The reported error is
    // that of the first text in the order of the work, whatever the jobs.
    Result<std::vector<std::optional<CompiledText>>> run(int jobs) {
        const std::vector<std::size_t> order = orderOfWork();
        jobs_ = jobs > 0 ? jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
        base::runParallel(order.size(), jobs, [&](std::size_t place) {
            const std::size_t text = order[place];
            const auto finish = [&](Result<CompiledText> result) {
                results_[text] = std::move(result);
                done_[text] = true;
                done_[text].notify_all();
            };
            try {
                finish(compile(text));
            } catch (...) {
                // Joins that wait for it end, too.
                finish(makeError("internal", "", "a part was not compiled"));
                throw;
            }
            tellProgress(order.size());
            return results_[text]->ok();
        });
        for (const std::size_t text : order) {
            if (!results_[text]->ok()) {
                return results_[text]->error();
            }
        }
        std::vector<std::optional<CompiledText>> compiled(texts_.size());
        for (std::size_t i = 0; i < texts_.size(); ++i) {
            if (results_[i]) {
                compiled[i] = std::move(**results_[i]);
            }
        }
        return compiled;
    }

private:
    void tellProgress(std::size_t all) {
        const std::lock_guard lock(telling_);
        ++told_;
        if (progress_) {
            progress_(told_, all);
        }
    }

    // Joined texts come last, so that their parts were started before them. Parts of a text that is there
    // already are not needed.
    std::vector<std::size_t> orderOfWork() {
        std::vector<bool> needed(texts_.size(), true);
        for (std::size_t i = 0; i < texts_.size(); ++i) {
            if (texts_[i].source->link) {
                needed[i] = false;
            } else if (!texts_[i].parts.empty()) {
                if (std::optional<CompiledText> found = find(texts_[i].hash)) {
                    results_[i] = std::move(*found);
                }
            }
        }
        for (std::size_t i = 0; i < texts_.size(); ++i) {
            if (!results_[i]) {
                for (const std::size_t part : texts_[i].parts) {
                    needed[part] = true;
                }
            }
        }
        std::vector<std::size_t> order;
        for (const bool joined : {false, true}) {
            for (std::size_t i = 0; i < texts_.size(); ++i) {
                if (needed[i] && !results_[i] && texts_[i].parts.empty() != joined) {
                    order.push_back(i);
                }
            }
        }
        return order;
    }

    // Returns the compiled form that an earlier run has left, if there is one.
    std::optional<CompiledText> find(const TextHash& hash) const {
        if (auto found = warm_ != nullptr ? warm_->findModule(hash) : nullptr) {
            return CompiledText{std::move(found)};
        }
        std::optional<CachedModule> module = cache_ != nullptr ? cache_->find(hash) : std::nullopt;
        if (!module) {
            return std::nullopt;
        }
        CompiledText found = textOf(std::move(*module), false);
        if (warm_ != nullptr) {
            warm_->putModule(hash, found.module);
        }
        return found;
    }

    Result<CompiledText> compile(std::size_t index) {
        const DistinctTexts::Text& text = texts_[index];
        if (!text.parts.empty()) {
            return join(text);
        }
        if (std::optional<CompiledText> found = find(text.hash)) {
            return std::move(*found);
        }
        if (!foldsNew_ || text.source->link) {
            return compile(*text.source, text.hash, options_);
        }
        ShaderCompileOptions folding = options_;
        folding.optimize = false;
        const TextHash hash = hashOfModuleText(*text.source, folding);
        std::optional<CompiledText> found = find(hash);
        GLINT_TRY(auto folded,
                  found ? Result<CompiledText>(std::move(*found)) : compile(*text.source, hash, folding));
        folded.folded = true;
        return folded;
    }

    Result<CompiledText> compile(const ModuleSource& source, const TextHash& hash,
                                 const ShaderCompileOptions& options) {
        GLINT_TRY(const auto shader, shaderOf(source));
        return keep(hash, compileMeasured(shader, options, source.link));
    }

    Result<CompiledText> join(const DistinctTexts::Text& text) {
        std::vector<const CachedModule*> parts;
        for (const std::size_t part : text.parts) {
            done_[part].wait(false);
            if (!results_[part]->ok()) {
                return results_[part]->error();
            }
            parts.push_back(&(*results_[part])->module->module);
        }
        // The joins that wait or run share the threads.
        const int idle = jobs_ / std::max(1, ++joins_);
        Result<CompiledText> joined = joinOf(text, parts, std::max(1, idle));
        --joins_;
        return joined;
    }

    Result<CompiledText> joinOf(const DistinctTexts::Text& text, std::span<const CachedModule* const> parts,
                                int jobs) {
        GLINT_TRY(const auto shader, shaderOf(*text.source));
        return keep(text.hash, joinMeasured(shader, options_, parts, jobs));
    }

    Result<CompiledText> keep(const TextHash& hash, Result<CachedModule> module) {
        if (!module) {
            return module.error();
        }
        if (cache_ != nullptr) {
            cache_->put(hash, *module);
        }
        CompiledText compiled = textOf(std::move(*module), true);
        if (warm_ != nullptr) {
            warm_->putModule(hash, compiled.module);
        }
        return compiled;
    }

    const std::vector<DistinctTexts::Text>& texts_;
    ShaderCompileOptions options_;
    bool foldsNew_;
    ModuleCache* cache_;
    WarmModules* warm_;
    const std::function<void(std::size_t, std::size_t)>& progress_;
    std::mutex telling_;
    std::size_t told_ = 0;
    std::vector<std::optional<Result<CompiledText>>> results_;
    std::vector<std::atomic<bool>> done_;
    int jobs_ = 1;
    std::atomic<int> joins_{0};
};

// Counts the parts of a module that were made in this run, each once.
void countParts(const DistinctTexts::Text& text, const std::vector<std::optional<CompiledText>>& compiled,
                std::vector<bool>& counted, CompiledModule& module) {
    for (const std::size_t part : text.parts) {
        if (compiled[part] && !counted[part]) {
            counted[part] = true;
            ++(compiled[part]->compiled ? module.partsCompiled : module.partsCached);
        }
    }
}

// Makes the modules of `sources` from the compiled texts. The names and texts of `sources` are moved into the
// modules.
std::vector<CompiledModule> makeModules(std::vector<ModuleSource>& sources, const DistinctTexts& distinct,
                                        const std::vector<std::optional<CompiledText>>& compiled) {
    std::vector<CompiledModule> modules;
    modules.reserve(sources.size());
    std::vector<bool> counted(compiled.size());
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const std::size_t text = distinct.textOf(i);
        const DistinctTexts::Text& distinctText = distinct.texts()[text];
        modules.push_back(makeCompiled(sources[i], *compiled[text], distinct.isFirst(i)));
        countParts(distinctText, compiled, counted, modules.back());
    }
    shareFiles(modules);
    return modules;
}

}  // namespace

Result<std::vector<CompiledModule>> compileModules(
    std::vector<ModuleSource> sources, int jobs, const ShaderCompileOptions& options, ModuleCache* cache,
    WarmModules* warm, NewShaders newShaders, const std::function<void(std::size_t, std::size_t)>& progress) {
    const DistinctTexts distinct(sources, options);
    GLINT_TRY(auto compiled,
              TextCompiler(distinct.texts(), options, cache, warm, newShaders, progress).run(jobs));
    return makeModules(sources, distinct, compiled);
}

Result<std::vector<CompiledModule>> takeModules(std::vector<ModuleSource> sources,
                                                const ShaderCompileOptions& options,
                                                const std::filesystem::path& folder) {
    const DistinctTexts distinct(sources, options);
    std::vector<std::optional<CompiledText>> taken;
    for (const DistinctTexts::Text& text : distinct.texts()) {
        taken.emplace_back();
        if (text.source->link) {
            continue;  // the module that was joined from it has been made already
        }
        GLINT_TRY(taken.back(), takeText(*text.source, makeModuleText(*text.source, options), folder));
    }
    return makeModules(sources, distinct, taken);
}

}  // namespace glint::compiler
