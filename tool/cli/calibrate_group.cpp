#include "cli/calibrate_group.h"

#include "cli/camera.h"
#include "cli/render_input.h"
#include "cli/scene_view.h"
#include "emit/compile.h"

#include <chrono>
#include <utility>

namespace glint {

namespace {

using Clock = std::chrono::steady_clock;

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
    // All that scenes of the two kinds of rays need, so that they can share a package.
    settings.effects = {false, package::kEffectReflection | package::kEffectIndirectDiffuse};
    if (arguments.calibrate.shadows) {
        settings.effects.named |= package::kEffectShadow;
    }
    settings.emitHeader = false;
    return settings;
}

// What each case's own shader holds.
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

Result<CalibrationGroup> makeCalibrationGroup(Context& context, const BenchArguments& arguments,
                                              std::span<const synthetic::CasesOptions> all,
                                              ModuleCache* cache) {
    std::vector<Scene> scenes;
    for (const synthetic::CasesOptions& options : all) {
        scenes.push_back(synthetic::makeCasesScene(options));
    }
    CalibrationGroup group;
    const Clock::time_point start = Clock::now();
    const Result<CompiledPackage> compiled =
        compilePackage(scenes, settingsOf(arguments, context.handles().tracers), cache);
    if (!compiled) {
        return compiled.error();
    }
    group.compileMs = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    group.work = workOf(*compiled);
    Result<Package> package = loadTemporary(*compiled);
    if (!package) {
        return package.error();
    }
    group.package = std::make_unique<Package>(std::move(*package));
    for (std::size_t i = 0; i < all.size(); ++i) {
        SceneViewData data = makeSceneView(scenes[i]);
        data.packageScene = static_cast<std::uint32_t>(i);
        Result<CameraView> camera = sceneCamera(scenes[i], 0, all[i].aspect);
        if (!camera) {
            return camera.error();
        }
        Result<std::unique_ptr<GpuScene>> uploaded = GpuScene::upload(context, *group.package, data.view());
        if (!uploaded) {
            return uploaded.error();
        }
        group.scenes.push_back({all[i], std::move(*uploaded), *camera, effectOf(all[i].coherence)});
    }
    return group;
}

}  // namespace glint
