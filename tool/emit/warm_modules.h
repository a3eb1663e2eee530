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
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::compiler {

// The files that modules include: those of one set hide those of another.
class IncludedFiles {
public:
    // Both must outlive this.
    IncludedFiles(const SourceSet& own, const SourceSet& others) : own_(own), others_(others) {}

    std::optional<std::string_view> find(std::string_view name) const {
        const std::optional<std::string_view> found = own_.find(name);
        return found ? found : others_.find(name);
    }
    std::optional<std::uint64_t> markOf(std::string_view name) const {
        const std::optional<std::uint64_t> found = own_.markOf(name);
        return found ? found : others_.markOf(name);
    }
    // Returns SourceSet::mark() of those that hide others.
    std::uint64_t markOfOwn() const {
        return own_.mark();
    }

private:
    const SourceSet& own_;
    const SourceSet& others_;
};

// A compiled module with the hash of its bytes.
struct HashedModule {
    explicit HashedModule(CachedModule compiled)
        : module(std::move(compiled)), hash(base::hashBytes(module.bytes())) {}

    CachedModule module;
    std::uint64_t hash = 0;
};

// Keeps the GLSL and the SPIR-V of modules whose inputs stay the same from run to run. A module's GLSL is
// found by the text that it starts with and the contents of every file that it included, by name; its SPIR-V
// by the hash of the text that makeModuleText() makes. Files are compared by a 64-bit hash. What a run has
// not used for kRuns runs is dropped. Thread-safe but for endRun().
class WarmModules {
public:
    static constexpr std::uint64_t kRuns = 8;

    // The files that a module asked for, by name, each with SourceSet::markOf() of it.
    using Read = std::vector<std::pair<std::string, std::optional<std::uint64_t>>>;

    // Takes the files that the modules of a run share. Call it before those are looked up.
    void takeSources(const SourceSet& sources);
    // Returns what was put for the same text, name and included files.
    std::shared_ptr<const PreparedGlsl> findGlsl(std::string_view name, std::string_view text,
                                                 const IncludedFiles& files);
    void putGlsl(std::string_view name, std::string_view text, Read read, const IncludedFiles& files,
                 std::shared_ptr<const PreparedGlsl> glsl);

    // Returns null if there is none.
    std::shared_ptr<const HashedModule> findModule(const TextHash& text);
    void putModule(const TextHash& text, std::shared_ptr<const HashedModule> module);

    // Returns the material code of the plan's cases, with what earlier runs have made of it as long as
    // nothing that decides about it changes. It is for one run at a time.
    MaterialCodeOfCases& codeOfCases(const Plan& plan);

    // Drops what was not used lately. Call it between runs.
    void endRun();

private:
    using Key = TextHash;
    struct Glsl {
        Read read;  // ascending
        std::shared_ptr<const PreparedGlsl> glsl;
        std::uint64_t used = 0;  // run
        // The files were these when it was used.
        std::uint64_t own = 0;      // IncludedFiles::markOfOwn()
        std::uint64_t sources = 0;  // number of takeSources()
    };
    bool isOf(const Glsl& candidate, const IncludedFiles& files) const;
    struct Module {
        std::shared_ptr<const HashedModule> module;
        std::uint64_t used = 0;
    };

    std::mutex mutex_;
    std::uint64_t run_ = 0;
    std::uint64_t sources_ = 0;                                   // how often they were taken
    std::vector<std::pair<std::string, std::uint64_t>> marks_;    // of the last ones
    std::vector<std::pair<std::string, std::uint64_t>> changed_;  // marks before and after
    // Several texts of included files for one text of a module, the latest first.
    std::map<Key, std::list<Glsl>> glsl_;
    std::map<Key, Module> modules_;
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
    // `sources` and `warm`, which may be null, must outlive this.
    ModuleDrafts(const SourceSet& sources, WarmModules* warm) : sources_(sources), warm_(warm) {}

    // Will make the GLSL of `module` from `text`, whose includes are found in `own` before `sources`. `own`
    // must outlive this. `origin` names the text in messages.
    void add(std::shared_ptr<ModuleSource> module, std::string origin, std::string text,
             const SourceSet& own);

    // Makes the GLSL of all that was added, on at most `jobs` threads (0: one for each core). Has the errors
    // of flatten(), of the first module that has one.
    Status finish(int jobs);

private:
    struct Draft {
        std::shared_ptr<ModuleSource> module;
        std::string origin;
        std::string text;
        const SourceSet* own = nullptr;
    };
    Status finish(const Draft& draft) const;

    const SourceSet& sources_;
    WarmModules* warm_;
    std::vector<Draft> drafts_;
};

}  // namespace glint::compiler
