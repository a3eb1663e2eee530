// Modules between their templates and their GLSL: flattening and pruning, on several threads.
#pragma once

#include "emit/module_source.h"
#include "emit/source_set.h"
#include "emit/warm_modules.h"

#include <glint/result.h>

#include <memory>
#include <string>
#include <vector>

namespace glint::compiler {

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
