#include "measure/calibration_group.h"

#include "emit/compile.h"
#include "resolve/resolve.h"

#include <glint/scene_view/camera.h>
#include <glint/scene_view/package.h>
#include <glint/scene_view/scene_view.h>

#include <utility>

namespace glint::measure {

namespace {

package::Effect effectOf(synthetic::Coherence coherence) {
    return compiler::builtinEffects(
        {coherence == synthetic::Coherence::Coherent ? "reflection" : "indirect-diffuse"});
}

compiler::Settings settingsOf(const CalibrationSettings& settings, std::uint32_t tracers) {
    compiler::Settings asked = settings.render;
    asked.profile.clear();
    asked.packLobes.clear();
    asked.compile.plan = {};
    asked.compile.plan.merge = compiler::MergePolicy::None;
    asked.alpha = package::AlphaPolicy::Opaque;
    asked.sun = compiler::Sun::Off;
    asked.strategy = package::strategyTable().front().strategy;
    for (const std::string& strategy : strategiesFor(tracers)) {
        asked.furtherStrategies |= *valueNamed<package::Strategy>(strategy);
    }
    // The settings cover scenes with both kinds of rays, so that they can share a package.
    asked.compile.effects = {false, compiler::builtinEffects({"reflection", "indirect-diffuse"})};
    if (settings.shadows) {
        asked.compile.effects.named |= compiler::builtinEffects({"shadow"});
    }
    return asked;
}

// Returns the size of the code of each case's own shader.
std::vector<CaseWork> workOf(const compiler::CompiledPackage& compiled) {
    std::vector<CaseWork> work(compiled.plan.cases.size());
    for (const compiler::CompiledModule& module : compiled.modules) {
        if (package::findRole(module.key.role)->over == package::Over::Buckets) {
            CaseWork& one = work[module.key.index];
            one.instructions = module.statistics.instructions;
            one.fetches = module.statistics.textureFetches;
        }
    }
    return work;
}

}  // namespace

std::vector<std::string> strategiesFor(std::uint32_t tracers) {
    std::vector<std::string> names;
    for (const package::Strategy strategy : package::strategies()) {
        const bool pipelineOnly = (strategy & package::pipelineStrategies()) != 0;
        if (!pipelineOnly || (tracers & package::kTracerRayPipeline) != 0) {
            names.emplace_back(package::nameOf(strategy));
        }
    }
    return names;
}

Result<CompiledGroup> compileGroup(const CalibrationSettings& settings, std::uint32_t tracers,
                                   std::vector<synthetic::CasesOptions> options,
                                   compiler::ModuleCache* cache) {
    CompiledGroup group;
    for (const synthetic::CasesOptions& one : options) {
        group.scenes.push_back(synthetic::makeCasesScene(one));
    }
    group.options = std::move(options);
    GLINT_TRY(const auto build,
              compiler::resolve(group.scenes, settingsOf(settings, tracers), {.tracers = tracers}));
    GLINT_TRY(group.package, compilePackage(build, cache));
    return group;
}

Result<CalibrationGroup> uploadGroup(Context& context, const CompiledGroup& compiled) {
    CalibrationGroup group;
    group.work = workOf(compiled.package);
    GLINT_TRY(auto package, scene_view::loadPackage(compiled.package));
    group.package = std::make_unique<Package>(std::move(package));
    for (std::size_t i = 0; i < compiled.scenes.size(); ++i) {
        const gltf::Scene& scene = compiled.scenes[i];
        const synthetic::CasesOptions& options = compiled.options[i];
        scene_view::SceneViewData data = scene_view::makeSceneView(scene);
        data.packageScene = static_cast<std::uint32_t>(i);
        GLINT_TRY(const auto camera, scene_view::sceneCamera(scene, 0, options.aspect));
        GLINT_TRY(auto uploaded, GpuScene::upload(context, *group.package, data.view()));
        group.scenes.push_back({options, std::move(uploaded), camera, effectOf(options.coherence)});
    }
    return group;
}

}  // namespace glint::measure
