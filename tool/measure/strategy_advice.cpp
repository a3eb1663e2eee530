#include "emit/effects.h"
#include "gltf/import.h"
#include "inspect/pipelines.h"
#include "plan/built_in_costs.h"

#include <glint/measure/device_file.h>
#include <glint/measure/render_settings.h>
#include <glint/measure/strategy_advice.h>
#include <glint/scene_view/package.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace glint::measure {

namespace {

compiler::FrameShape shapeOf(const compiler::Settings& render, std::uint32_t effects) {
    return {static_cast<double>(render.renderer.width) * render.renderer.height, effects,
            render.frame.maxReflectionRoughness, render.renderer.batchEffects, render.compile.maxBounces};
}

// Returns the rounds of a scene whose cases are those of a package.
std::vector<compiler::Round> roundsOf(const Package& package, const gltf::Scene& scene,
                                      const compiler::FrameShape& shape) {
    std::vector<compiler::CaseFeatures> cases;
    for (const package::CaseEntry& entry : package.cases()) {
        cases.push_back({entry.always, entry.sometimes, entry.keyCount == 0});
    }
    const std::vector<materials::PrimitiveInputs> primitives = planningInputs(scene);
    std::vector<compiler::CaseHits> hits;
    if (const std::optional<std::uint32_t> index = scene_view::sceneIn(package, scene)) {
        for (const materials::PrimitiveInputs& inputs : primitives) {
            const package::PrimitiveEntry* const entry = package.scene(*index).findPrimitive(
                static_cast<std::uint32_t>(inputs.mesh), static_cast<std::uint32_t>(inputs.primitive));
            if (entry != nullptr && entry->shaderId < cases.size()) {
                hits.push_back({static_cast<int>(entry->shaderId), inputs.expectedHits});
            }
        }
    }
    return frameRounds(scene.materials, primitives, roundCases(cases, hits), shape);
}

// Makes the pipelines of the package, and uses the device compiler's statistics of them.
Status askDevice(const compiler::Settings& render, Context& context, const Package* package,
                 KnownCosts& costs, std::vector<Diagnostic>& warnings) {
    if (package == nullptr || !context.handles().pipelineStatistics) {
        warnings.push_back(makeWarning(
            "gpu-device", context.deviceName(),
            package == nullptr ? "is asked for statistics of shaders that are not compiled yet"
                               : "has no VK_KHR_pipeline_executable_properties: there are no statistics",
            package == nullptr ? "give --package, or the name of a GPU" : "leave out --gpu device"));
        return okStatus();
    }
    GLINT_TRY(const auto manifest, inspect::readManifest(render.package));
    GLINT_TRY(const auto report, inspect::reportPipelines(context, *package, manifest, render.package,
                                                          render.renderer.pipelineThreads));
    costs.gpu = inspect::gpuOf(std::string(compiler::kThisDevice), {&report, 1});
    costs.device = withGpu(std::move(costs.device), *costs.gpu);
    return okStatus();
}

}  // namespace

Result<KnownCosts> knownCosts(const compiler::Settings& settings, bool onCpu) {
    KnownCosts costs{compiler::builtInCosts(onCpu), true};
    if (!settings.calibration.empty()) {
        GLINT_TRY(auto read, readDeviceFile(settings.calibration));
        costs = {std::move(read.costs), false};
    }
    if (!settings.gpu.empty() && settings.gpu != compiler::kThisDevice) {
        GLINT_TRY(auto gpu, inspect::readGpuCosts(settings.gpu));
        costs.device = withGpu(std::move(costs.device), gpu);
        costs.gpu = std::move(gpu);
    }
    return costs;
}

std::vector<std::string> runnableStrategies(std::uint32_t deviceTracers,
                                            std::optional<package::Tracer> tracer, const Package* package) {
    const std::uint32_t wanted = tracer ? std::uint32_t{*tracer} : package::kAllTracers;
    const std::uint32_t compiled = package != nullptr ? package->shape().tracers : package::kAllTracers;
    std::vector<std::string> names;
    for (const std::string_view name : compiler::simplestFirst()) {
        const package::Strategy strategy = *valueNamed<package::Strategy>(name);
        const bool has = package == nullptr || package->supports(strategy);
        // Some strategies need ray tracing pipelines, whatever the package's tracers are.
        const std::uint32_t tracers = package::tracersOf(strategy, compiled);
        if (has && (tracers & wanted & deviceTracers) != 0) {
            names.emplace_back(name);
        }
    }
    return names;
}

std::vector<compiler::Round> roundsOf(const gltf::SceneList& scenes, const compiler::Plan& plan,
                                      const compiler::PlanOptions& options,
                                      const compiler::FrameShape& shape) {
    const std::vector<compiler::CaseFeatures> cases = caseFeatures(plan);
    std::vector<compiler::Round> rounds;
    for (std::size_t i = 0; i < scenes.scenes().size(); ++i) {
        const gltf::SceneList::Range range = scenes.primitivesOf(i);
        const std::span<const materials::PrimitiveInputs> primitives =
            scenes.primitives().subspan(range.first, range.count);
        const std::vector<compiler::CaseHits> hits = caseHits(plan, options, primitives, range.first);
        for (compiler::Round& round :
             frameRounds(scenes.materials(), primitives, roundCases(cases, hits), shape)) {
            rounds.push_back(std::move(round));
        }
    }
    return rounds;
}

Result<compiler::StrategyAdvice> adviseStrategy(const KnownCosts& costs,
                                                const std::vector<compiler::Round>& rounds,
                                                const std::vector<std::string>& available, double pixels) {
    std::optional<compiler::StrategyChoice> choice = chooseStrategy(rounds, costs.device, available);
    if (!choice) {
        return makeError(
            "calibration-strategies", costs.device.device,
            fmt::format("was not measured with any strategy that can be used here: {}",
                        available.empty() ? "none" : fmt::format("{}", fmt::join(available, ", "))),
            "name a --strategy, or measure the device again with glint bench --calibrate");
    }
    return compiler::StrategyAdvice{std::move(*choice), costs.device.device, costs.builtIn, pixels};
}

Result<compiler::StrategyAdvice> adviseRender(const compiler::Settings& render,
                                              const compiler::PlanOptions& plan, Context& context,
                                              const gltf::Scene& scene, const Package* package,
                                              std::vector<Diagnostic>& warnings) {
    GLINT_TRY(auto costs, knownCosts(render, context.deviceType() == VK_PHYSICAL_DEVICE_TYPE_CPU));
    if (costs.builtIn && !costs.gpu && context.subgroupSize() > 0) {
        costs.device.subgroupSize = context.subgroupSize();
    } else if (!costs.builtIn && costs.device.device != context.deviceName()) {
        warnings.push_back(makeWarning("calibration-device", render.calibration,
                                       fmt::format("was measured on {}, but this device is {}",
                                                   costs.device.device, context.deviceName()),
                                       "measure this device with glint bench --calibrate"));
    }
    if (render.gpu == compiler::kThisDevice) {
        GLINT_TRY_DO(askDevice(render, context, package, costs, warnings));
    }
    const std::uint32_t tracers = context.handles().tracers;
    const gltf::SceneList scenes({&scene, 1});
    if (package == nullptr) {
        const compiler::CompileSettings settings = compileSettings(render, plan, tracers, scene);
        const compiler::FrameShape shape = shapeOf(render, planEffects(scenes, settings).effects.all);
        const compiler::Plan made = makePlan(scenes.materials(), scenes.primitives(), plan);
        return adviseStrategy(costs, roundsOf(scenes, made, plan, shape),
                              runnableStrategies(tracers, render.renderer.tracer, nullptr), shape.pixels);
    }
    const compiler::FrameShape shape = shapeOf(render, package->shape().effects.all);
    std::vector<std::string> available = runnableStrategies(tracers, render.renderer.tracer, package);
    if (available.empty()) {
        // Features that the device lacks are reported when the package is used.
        available = compiler::strategyNames(package->shape().strategies);
    }
    return adviseStrategy(costs, roundsOf(*package, scene, shape), available, shape.pixels);
}

}  // namespace glint::measure
