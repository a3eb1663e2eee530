#include "measure/features/evaluator.h"

#include "emit/compile.h"
#include "emit/feature_kernel.h"
#include "resolve/resolve.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace glint::measure {

namespace {

// Directions of one dispatch: some 20 MiB go in and out.
constexpr std::size_t kMostOfRun = 1U << 17U;

// The package of the checked scene: as few modules as packages have.
compiler::CompileSettings checkedSettings() {
    compiler::CompileSettings settings;
    settings.strategies = package::kDefaultStrategy;
    settings.tracers = package::kTracerRayQuery;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.effects = {};
    settings.emitHeader = false;
    return settings;
}

}  // namespace

Result<std::unique_ptr<FeatureEvaluator>> FeatureEvaluator::create(const gltf::Scene& scene,
                                                                   const CheckMaterialsOptions& options,
                                                                   const Observer& observer) {
    std::unique_ptr<FeatureEvaluator> evaluator(new FeatureEvaluator);
    HeadlessOptions device;
    device.validation = options.validate ? Validation::Synchronization : Validation::Off;
    device.deviceName = options.device;
    GLINT_TRY(evaluator->context_, Context::createHeadless(device));

    observer.progress("compiling");
    compiler::CompileSettings settings = checkedSettings();
    settings.jobs = options.jobs;
    if ((evaluator->context_->handles().tracers & package::kTracerRayQuery) == 0) {
        settings.tracers = package::kTracerRayPipeline;
    }
    GLINT_TRY(const auto build, compiler::resolve(std::span(&scene, 1), settings));
    GLINT_TRY(auto package, session::compileAndLoad(build));
    GLINT_TRY(auto kernel, compileFeatureKernel(build));
    evaluator->layers_ = std::move(kernel.layers);

    observer.progress("making the pipeline");
    session::SceneViewData data = session::makeSceneView(scene);
    data.vertices = VertexForm::Full;  // frames of surfaces are compared exactly
    GLINT_TRY(evaluator->scene_,
              session::DeviceScene::upload(*evaluator->context_, std::move(package), std::move(data)));
    GLINT_TRY(evaluator->kernel_, SceneKernel::create(*evaluator->scene_.gpu, kernel.spirv));
    return evaluator;
}

std::uint32_t FeatureEvaluator::lobeOf(const std::string& layer) const {
    const auto found = std::ranges::find(layers_, layer);
    return found == layers_.end() ? 0 : static_cast<std::uint32_t>(found - layers_.begin()) + 1;
}

Result<std::vector<compiler::FeatureKernelOutput>> FeatureEvaluator::run(
    std::span<const compiler::FeatureKernelInput> inputs) const {
    std::vector<compiler::FeatureKernelOutput> outputs(inputs.size());
    constexpr std::size_t kWordsIn = sizeof(compiler::FeatureKernelInput) / sizeof(std::uint32_t);
    constexpr std::size_t kWordsOut = sizeof(compiler::FeatureKernelOutput) / sizeof(std::uint32_t);
    for (std::size_t first = 0; first < inputs.size(); first += kMostOfRun) {
        const std::size_t count = std::min(kMostOfRun, inputs.size() - first);
        std::vector<std::uint32_t> words(count * kWordsIn);
        std::memcpy(words.data(), inputs.data() + first, count * sizeof(compiler::FeatureKernelInput));
        GLINT_TRY(const auto found,
                  kernel_->run(words, static_cast<std::uint32_t>(count), count * kWordsOut));
        std::memcpy(static_cast<void*>(outputs.data() + first), found.data(),
                    count * sizeof(compiler::FeatureKernelOutput));
    }
    return outputs;
}

std::string FeatureEvaluator::deviceName() const {
    return context_->deviceName();
}

Status FeatureEvaluator::validate(const Observer& observer) const {
    return checkValidation(observer, *context_);
}

}  // namespace glint::measure
