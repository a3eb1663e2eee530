#include "emit/material_compiler.h"

#include "cache/module_cache.h"
#include "cache/store.h"
#include "emit/compile.h"
#include "emit/module_files.h"
#include "emit/warm_modules.h"
#include "resolve/resolve.h"

#include <algorithm>
#include <iterator>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

namespace glint::compiler {

struct MaterialCompiler::State {
    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State();

    Settings settings;
    gltf::ImportOptions import{};
    std::optional<CacheStore> store{};
    std::optional<ModuleCache> modules{};
    std::mutex compiling{};  // guards all of this
    WarmModules warm{};
};

MaterialCompiler::MaterialCompiler(std::unique_ptr<State> state) : state_(std::move(state)) {}
MaterialCompiler::MaterialCompiler(MaterialCompiler&&) noexcept = default;
MaterialCompiler& MaterialCompiler::operator=(MaterialCompiler&&) noexcept = default;
MaterialCompiler::~MaterialCompiler() = default;

MaterialCompiler::State::~State() {
    if (store) {
        store->trim();
    }
}

Result<MaterialCompiler> MaterialCompiler::create(Settings settings, const std::filesystem::path& cache) {
    auto state = std::make_unique<State>();
    state->settings = std::move(settings);
    if (!cache.empty()) {
        StoreOptions options;
        options.folder = cache;
        state->store.emplace(std::move(options));
        state->modules.emplace(*state->store, moduleCompiler());
    }
    GLINT_TRY(state->import, importOptions(state->settings, state->store ? &*state->store : nullptr));
    return MaterialCompiler(std::move(state));
}

Result<CompiledMaterials> MaterialCompiler::compile(const gltf::MaterialSet& set, NewShaders newShaders) {
    const std::lock_guard lock(state_->compiling);
    state_->settings.compile.newShaders = newShaders;
    CompiledMaterials compiled;
    GLINT_TRY(compiled.scene, gltf::importMaterials(set, state_->import));
    GLINT_TRY(auto build, resolve(std::span(&compiled.scene, 1), state_->settings));
    Result<CompiledPackage> package =
        compilePackage(build, state_->modules ? &*state_->modules : nullptr, &state_->warm);
    state_->warm.endRun();
    if (!package) {
        return package.error();
    }
    compiled.package = std::move(*package);
    compiled.folded =
        static_cast<std::size_t>(std::ranges::count_if(compiled.package.modules, &CompiledModule::folded));
    compiled.messages = compiled.scene.warnings;
    std::ranges::move(build.messages, std::back_inserter(compiled.messages));
    if (state_->store && state_->store->trouble()) {
        compiled.messages.push_back(*state_->store->trouble());
    }
    return compiled;
}

}  // namespace glint::compiler
