// Modules between their templates and their GLSL, and the results that one compilation leaves in memory for
// the next one of the same process.
#pragma once

#include "base/files.h"
#include "cache/module_cache.h"
#include "emit/glsl/passes.h"
#include "emit/material_code.h"
#include "emit/source_set.h"

#include <glint/result.h>

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::compiler {

// The files that modules include: those of one set hide those of another.
class IncludedFiles {
public:
    IncludedFiles(std::shared_ptr<const SourceSet> own, std::shared_ptr<const SourceSet> others)
        : own_(std::move(own)), others_(std::move(others)) {}

    std::optional<std::string_view> find(std::string_view name) const {
        return setOf(name).find(name);
    }
    const SourceSet::Items* itemsOf(std::string_view name) const {
        return setOf(name).itemsOf(name);
    }
    // Returns a number that differs between states of the sources, each by its sourceNumber().
    std::uint64_t stateOf(std::span<const std::uint64_t> sources) const;

private:
    const SourceSet& setOf(std::string_view name) const {
        return own_->find(name) ? *own_ : *others_;
    }

    std::shared_ptr<const SourceSet> own_;
    std::shared_ptr<const SourceSet> others_;
};

// A text from which the GLSL of a module is made.
struct ModuleTemplate {
    std::string origin;  // names it in messages
    std::string text;
    IncludedFiles files;

    // Flattens and prunes. `sources`, which may be null, gets the numbers of all sources that decide about
    // the result, ascending. Has the errors of flatten().
    Result<GlslUnit> make(std::vector<std::uint64_t>* sources = nullptr) const;
};

// A compiled module with the hash of its bytes.
struct HashedModule {
    explicit HashedModule(CachedModule compiled)
        : module(std::move(compiled)), hash(base::hashBytes(module.bytes())) {}

    CachedModule module;
    std::uint64_t hash = 0;
};

// Keeps what follows from inputs that stay the same from run to run: the hash of a module's GLSL, by the text
// that it starts with and the state of every source that it is made of; and SPIR-V, by the hash of the text
// that makeModuleText() makes. Sources are compared by a 64-bit hash. What a run has not used for kRuns runs
// is dropped. Thread-safe but for endRun().
class WarmModules {
public:
    static constexpr std::uint64_t kRuns = 8;

    // The text that a template becomes with some sources in one state.
    struct Text {
        std::vector<std::uint64_t> sources;
        std::uint64_t state = 0;  // IncludedFiles::stateOf() them
        TextHash text;
        std::uint64_t used = 0;  // run
    };
    using Texts = std::list<Text>;  // of one template, the latest first
    // The first few of them as the cache stores them. unpack() finds none in malformed bytes.
    static std::string pack(const Texts& texts);
    static Texts unpack(std::string_view bytes);

    // Returns the hash that was put for the same template and the same state of its sources, by this object
    // or by another process with the same `cache`, which may be null.
    std::optional<TextHash> findText(const ModuleTemplate& made, const ModuleCache* cache);
    // `sources` are those of ModuleTemplate::make().
    void putText(const ModuleTemplate& made, std::vector<std::uint64_t> sources, const TextHash& text,
                 const ModuleCache* cache);

    // Returns null if there is none.
    std::shared_ptr<const HashedModule> findModule(const TextHash& text);
    void putModule(const TextHash& text, std::shared_ptr<const HashedModule> module);

    // Returns the material code of the plan's cases, with what earlier runs have made of it as long as
    // nothing that decides about it changes. It is for one run at a time.
    MaterialCodeOfCases& codeOfCases(const Plan& plan);

    // Drops what was not used lately. Call it between runs.
    void endRun();

private:
    static TextHash keyOf(const ModuleTemplate& made);

    struct Module {
        std::shared_ptr<const HashedModule> module;
        std::uint64_t used = 0;
    };

    std::mutex mutex_;
    std::uint64_t run_ = 0;
    std::map<TextHash, Texts> texts_;
    std::map<TextHash, Module> modules_;
    std::optional<MaterialCodeOfCases> codeOfCases_;
};

// --- Modules between their templates and their GLSL: flattening and pruning, on several threads ---

// Returns what a module of this precision begins with.
std::string precisionDefines(package::ShadingPrecision precision);
// Inserts macros after the line of #version, which must come first.
void insertDefines(std::string& text, const std::string& defines);

// A part with functions, which traces no ray: it is the same for every strategy and tracer.
std::shared_ptr<ModuleSource> makePart(std::string name, std::vector<std::string> functions);
// Inserts the macros of such a part.
void insertPartDefines(std::string& text, package::ShadingPrecision precision);
// Makes the part of `module` that has its entry point and imports `functions`.
std::shared_ptr<ModuleSource> makeHead(const ModuleSource& module, std::vector<std::string> functions);

class ModuleDrafts {
public:
    // `warm` and `cache`, which may be null, must outlive this. With `all`, every text is made, also one
    // whose hash is known.
    ModuleDrafts(std::shared_ptr<const SourceSet> sources, WarmModules& warm, const ModuleCache* cache,
                 bool all)
        : sources_(std::move(sources)), warm_(warm), cache_(cache), all_(all) {}

    // Will give `module` the GLSL of `text`, whose includes are found in `own` before the common sources.
    // `origin` names the text in messages.
    void add(std::shared_ptr<ModuleSource> module, std::string origin, std::string text,
             std::shared_ptr<const SourceSet> own);

    // Gives GLSL to all that was added, on at most `jobs` threads (0: one for each core). Has the errors of
    // flatten(), of the first module that has one.
    Status finish(int jobs);

private:
    struct Draft {
        std::shared_ptr<ModuleSource> module;
        std::shared_ptr<const ModuleTemplate> made;
    };
    Status finish(const Draft& draft) const;

    std::shared_ptr<const SourceSet> sources_;
    WarmModules& warm_;
    const ModuleCache* cache_;
    bool all_;
    std::vector<Draft> drafts_;
};

}  // namespace glint::compiler
