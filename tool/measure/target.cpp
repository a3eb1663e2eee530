#include "gltf/import.h"
#include "inspect/pipelines.h"

#include <glint/measure/device_file.h>
#include <glint/measure/machine.h>
#include <glint/measure/target.h>
#include <glint/session/session.h>

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

namespace glint::measure {

namespace {

compiler::DecidedPackage decidedBy(const Package& package, const gltf::Scene& scene) {
    compiler::DecidedPackage decided{.shape = package.shape(),
                                     .alpha = package.alpha(),
                                     .shadowThrough = package.shadowThrough(),
                                     .trustsTextures = package.trustTextures(),
                                     .emissiveLights = package.emission() != nullptr,
                                     .skyLight = package.skyLight(),
                                     .sizedLights = package.sizedLights(),
                                     .diskLights = package.diskLights(),
                                     .lightSamples = package.lightSamples(),
                                     .cases = {},
                                     .hits = {}};
    const materials::MaterialModel& model =
        scene.materials.empty() ? materials::builtinMaterialModel() : scene.materials.front().model();
    for (const package::CaseEntry& entry : package.cases()) {
        decided.cases.push_back(
            {model.maskOf(entry.always), model.maskOf(entry.sometimes), entry.keyCount == 0});
    }
    if (const std::optional<std::uint32_t> index = session::sceneIn(package, scene)) {
        for (const materials::PrimitiveInputs& inputs : planningInputs(scene)) {
            const package::PrimitiveEntry* const entry = package.scene(*index).findPrimitive(
                static_cast<std::uint32_t>(inputs.mesh), static_cast<std::uint32_t>(inputs.primitive));
            if (entry != nullptr && entry->shaderId < decided.cases.size()) {
                decided.hits.push_back({static_cast<int>(entry->shaderId), inputs.expectedHits});
            }
        }
    }
    return decided;
}

// Makes the pipelines of the package, and lets what the device's compiler says of them count.
Status askDevice(const compiler::Settings& settings, Context& context, const Package* package,
                 compiler::Target& target) {
    if (package == nullptr || !context.handles().pipelineStatistics) {
        target.warnings.push_back(makeWarning(
            "gpu-device", context.deviceName(),
            package == nullptr ? "is asked for statistics of shaders that are not compiled yet"
                               : "has no VK_KHR_pipeline_executable_properties: there are no statistics",
            package == nullptr ? "give --package, or the name of a GPU" : "leave out --gpu device"));
        return okStatus();
    }
    GLINT_TRY(const auto manifest, inspect::readManifest(settings.package));
    GLINT_TRY(const auto report, inspect::reportPipelines(context, *package, manifest, settings.package,
                                                          settings.renderer.pipelineThreads));
    target.costs.gpu = inspect::gpuOf(std::string(compiler::kThisDevice), {&report, 1});
    target.costs.device = withGpu(std::move(target.costs.device), *target.costs.gpu);
    return okStatus();
}

Result<compiler::KnownCosts> knownCosts(const compiler::Settings& settings, bool onCpu, bool isAuto) {
    compiler::KnownCosts costs{.device = compiler::builtInCosts(onCpu)};
    if (!settings.calibration.empty() && isAuto) {
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

}  // namespace

Result<compiler::Target> targetOf(const compiler::Settings& settings) {
    compiler::Target target;
    GLINT_TRY(target.costs, knownCosts(settings, false, settings.advisesStrategy));
    return target;
}

Result<compiler::Target> targetOf(const compiler::Settings& settings, Context& context,
                                  const Package* package, const gltf::Scene& scene) {
    compiler::Target target;
    target.tracers = context.handles().tracers;
    const bool isAuto = !settings.strategy;
    GLINT_TRY(target.costs, knownCosts(settings, isOnCpu(context), isAuto));
    compiler::KnownCosts& costs = target.costs;
    if (costs.builtIn && !costs.gpu && context.subgroupSize() > 0) {
        costs.device.subgroupSize = context.subgroupSize();
    } else if (!costs.builtIn && costs.device.device != context.deviceName()) {
        target.warnings.push_back(makeWarning("calibration-device", settings.calibration,
                                              fmt::format("was measured on {}, but this device is {}",
                                                          costs.device.device, context.deviceName()),
                                              "measure this device with glint bench --calibrate"));
    }
    if (isAuto && settings.gpu == compiler::kThisDevice) {
        GLINT_TRY_DO(askDevice(settings, context, package, target));
    }
    if (package != nullptr) {
        target.package = decidedBy(*package, scene);
    }
    return target;
}

}  // namespace glint::measure
