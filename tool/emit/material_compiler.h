// Compiles sets of materials (gltf/material_set.h) to packages in memory, for programs that make or edit
// materials while they run. The first call takes as long as a compiler does, and each further one as long as
// the shaders that are new:
//
//     GLINT_TRY(auto compiler, MaterialCompiler::create(settings, cacheFolder));
//     GLINT_TRY(const auto compiled, compiler.compile(set));
//     GLINT_TRY(auto package, session::loadPackage(compiled.package));  // or Package::load()
#pragma once

#include "emit/package/compiled_package.h"
#include "gltf/material_set.h"
#include "gltf/scene.h"
#include "settings/settings.h"

#include <glint/result.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

namespace glint::compiler {

struct CompiledMaterials {
    // Material i of the set is material i of the scene, and that of mesh i, primitive 0. Images have no
    // texels.
    gltf::Scene scene;
    CompiledPackage package;
    std::vector<Diagnostic> messages;  // warnings and notes, about the set and about what was decided
    // Modules that NewShaders::Folded has left to the driver's optimiser. If there are any, another call
    // without it gives a package whose shaders may run faster.
    std::size_t folded = 0;
};

// Threads: compile() may be called on any thread. Calls of one compiler wait for each other, and those of
// several run at the same time. Each uses Settings::compile.jobs threads.
class MaterialCompiler {
public:
    // Reads the packs in the folders `settings.materials`, once: a program that changes their GLSL makes
    // another compiler. `cache` is a folder that keeps compiled shaders for the next run, which processes
    // share; if it is empty, they are kept in memory alone. The settings are those of `glint compile`.
    // Errors: those of importOptions().
    static Result<MaterialCompiler> create(Settings settings, const std::filesystem::path& cache = {});
    MaterialCompiler(MaterialCompiler&&) noexcept;
    MaterialCompiler& operator=(MaterialCompiler&&) noexcept;
    ~MaterialCompiler();

    // Shaders that none of the last 8 calls used are dropped from memory. Shader IDs may differ between two
    // calls; a lock file is read and not written. `newShaders` stands in place of that of the settings.
    // Errors: those of importMaterials(), resolve() and compilePackage(). After an error the compiler can be
    // used as before.
    Result<CompiledMaterials> compile(const gltf::MaterialSet& set,
                                      NewShaders newShaders = NewShaders::Optimized);

private:
    struct State;
    explicit MaterialCompiler(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace glint::compiler
