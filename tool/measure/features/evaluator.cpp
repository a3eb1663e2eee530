#include "measure/features/evaluator.h"

#include <glint/scene_view/package.h>

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
    Result<std::unique_ptr<Context>> context = Context::createHeadless(device);
    if (!context) {
        return context.error();
    }
    evaluator->context_ = std::move(*context);

    observer.progress("compiling");
    compiler::CompileSettings settings = checkedSettings();
    settings.jobs = options.jobs;
    if ((evaluator->context_->handles().tracers & package::kTracerRayQuery) == 0) {
        settings.tracers = package::kTracerRayPipeline;
    }
    const Result<compiler::CompiledPackage> compiled = compilePackage(scene, settings);
    if (!compiled) {
        return compiled.error();
    }
    Result<compiler::FeatureKernel> kernel = compileFeatureKernel(scene, compiled->plan, settings);
    if (!kernel) {
        return kernel.error();
    }
    evaluator->layers_ = std::move(kernel->layers);
    Result<Package> package = scene_view::loadPackage(*compiled);
    if (!package) {
        return package.error();
    }
    evaluator->package_ = std::make_unique<Package>(std::move(*package));

    observer.progress("making the pipeline");
    scene_view::SceneViewData data = scene_view::makeSceneView(scene);
    data.vertices = VertexForm::Full;  // frames of surfaces are compared exactly
    Result<std::unique_ptr<GpuScene>> uploaded =
        GpuScene::upload(*evaluator->context_, *evaluator->package_, data.view());
    if (!uploaded) {
        return uploaded.error();
    }
    evaluator->scene_ = std::move(*uploaded);
    Result<std::unique_ptr<SceneKernel>> made = SceneKernel::create(*evaluator->scene_, kernel->spirv);
    if (!made) {
        return made.error();
    }
    evaluator->kernel_ = std::move(*made);
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
        const Result<std::vector<std::uint32_t>> found =
            kernel_->run(words, static_cast<std::uint32_t>(count), count * kWordsOut);
        if (!found) {
            return found.error();
        }
        std::memcpy(static_cast<void*>(outputs.data() + first), found->data(),
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
