#include "cli/calibrate_group.h"

#include "cli/camera.h"
#include "cli/render_input.h"
#include "cli/scene_view.h"

#include <utility>

namespace glint {

namespace {

package::Effect effectOf(synthetic::Coherence coherence) {
    return coherence == synthetic::Coherence::Coherent ? package::kEffectReflection
                                                       : package::kEffectIndirectDiffuse;
}

CompileSettings settingsOf(const BenchArguments& arguments, std::uint32_t tracers) {
    TracingArguments tracing = arguments.render.tracing;
    tracing.strategies = strategiesFor(tracers);
    CompileSettings settings;
    tracing.apply(settings, tracers);
    arguments.render.accuracy.apply(settings);
    settings.plan.merge = MergePolicy::None;
    // The settings cover scenes with both kinds of rays, so that they can share a package.
    settings.effects = {false, package::kEffectReflection | package::kEffectIndirectDiffuse};
    if (arguments.calibrate.shadows) {
        settings.effects.named |= package::kEffectShadow;
    }
    settings.emitHeader = false;
    return settings;
}

// Returns the size of the code of each case's own shader.
std::vector<bench::CaseWork> workOf(const CompiledPackage& compiled) {
    std::vector<bench::CaseWork> work(compiled.plan.cases.size());
    for (const CompiledModule& module : compiled.modules) {
        if (module.key.role == package::ModuleRole::ShadeCase) {
            bench::CaseWork& one = work[module.key.index];
            one.instructions = module.statistics.instructions;
            one.fetches = module.statistics.textureFetches;
        }
    }
    return work;
}

}  // namespace

std::vector<std::string> strategiesFor(std::uint32_t tracers) {
    std::vector<std::string> names;
    for (const package::Strategy strategy : package::kStrategies) {
        const bool pipelineOnly = strategy == package::kStrategyHitShaders;
        if (!pipelineOnly || (tracers & package::kTracerRayPipeline) != 0) {
            names.emplace_back(package::nameOf(strategy));
        }
    }
    return names;
}

Result<CompiledGroup> compileGroup(const BenchArguments& arguments, std::uint32_t tracers,
                                   std::vector<synthetic::CasesOptions> options, ModuleCache* cache) {
    CompiledGroup group;
    for (const synthetic::CasesOptions& one : options) {
        group.scenes.push_back(synthetic::makeCasesScene(one));
    }
    group.options = std::move(options);
    Result<CompiledPackage> compiled = compilePackage(group.scenes, settingsOf(arguments, tracers), cache);
    if (!compiled) {
        return compiled.error();
    }
    group.package = std::move(*compiled);
    return group;
}

Result<CalibrationGroup> uploadGroup(Context& context, const CompiledGroup& compiled) {
    CalibrationGroup group;
    group.work = workOf(compiled.package);
    Result<Package> package = loadTemporary(compiled.package);
    if (!package) {
        return package.error();
    }
    group.package = std::make_unique<Package>(std::move(*package));
    for (std::size_t i = 0; i < compiled.scenes.size(); ++i) {
        const Scene& scene = compiled.scenes[i];
        const synthetic::CasesOptions& options = compiled.options[i];
        SceneViewData data = makeSceneView(scene);
        data.packageScene = static_cast<std::uint32_t>(i);
        const Result<CameraView> camera = sceneCamera(scene, 0, options.aspect);
        if (!camera) {
            return camera.error();
        }
        Result<std::unique_ptr<GpuScene>> uploaded = GpuScene::upload(context, *group.package, data.view());
        if (!uploaded) {
            return uploaded.error();
        }
        group.scenes.push_back({options, std::move(*uploaded), *camera, effectOf(options.coherence)});
    }
    return group;
}

}  // namespace glint
