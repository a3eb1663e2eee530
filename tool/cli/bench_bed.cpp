#include "cli/bench_bed.h"

#include "cli/bench_machine.h"
#include "cli/bench_point.h"
#include "cli/camera.h"
#include "cli/environment.h"
#include "cli/plan_choice.h"
#include "cli/render_input.h"
#include "cli/render_setup.h"
#include "cli/strategy_advice.h"
#include "gltf/scene_list.h"
#include "spirv/compiler.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

namespace glint {

namespace {

// Opens the device with as many of its optional features as possible: those that the default needs, and those
// that the sweep could use.
Result<std::unique_ptr<Context>> openDevice(const RenderArguments& arguments, DeviceOptions& features) {
    HeadlessOptions options;
    options.validation = arguments.validate ? Validation::Synchronization : Validation::Off;
    options.deviceName = arguments.device;
    Result<std::unique_ptr<Context>> context = Diagnostic{};
    for (const DeviceOptions tried :
         {DeviceOptions{true, true}, {false, true}, {true, false}, {false, false}}) {
        // It is used if shaders can be compiled for it and the validation layers know it.
        options.positionFetch =
            arguments.tracing.positionFetch || (tried.positionFetch && supportsPositionFetch());
        options.shaderFloat16 = arguments.accuracy.halves() || tried.float16;
        context = Context::createHeadless(options);
        if (context) {
            features = {options.positionFetch, options.shaderFloat16};
            break;
        }
    }
    return context;
}

SceneSize sizeOf(const SceneViewData& data) {
    std::map<std::uint32_t, std::uint64_t> triangles;  // by mesh
    for (const PrimitiveView& primitive : data.primitives) {
        triangles[primitive.mesh] += primitive.indices.size() / 3;
    }
    SceneSize size;
    for (const InstanceView& instance : data.instances) {
        size.triangles += triangles[instance.mesh];
        ++size.instances;
    }
    return size;
}

// Returns as words the settings for which `decides` is true.
template <typename Decides>
std::string decided(const RenderArguments& arguments, const Decides& decides) {
    bench::Configuration configuration = configurationOf(arguments);
    std::erase_if(configuration, [&](const auto& choice) { return !decides(choice.first); });
    return fmt::format("{}", fmt::join(wordsOf(configuration), " "));
}

// A pass of a case counts with those of the others.
std::string nameOfPass(const PassTiming& pass) {
    return pass.pass == Pass::ShadeCase ? std::string(kShadeCases) : pass.name;
}

bench::HitPart partOf(Pass pass) {
    switch (pass) {
        case Pass::RayDispatch:
            return bench::HitPart::Dispatch;
        case Pass::Trace:
            return bench::HitPart::Trace;
        case Pass::Count:
        case Pass::Offset:
        case Pass::Copy:
            return bench::HitPart::Order;
        case Pass::Uber:
        case Pass::SortedUber:
        case Pass::HitShaders:
        case Pass::ShadeMiss:
        case Pass::ShadeCase:
            return bench::HitPart::Shade;
        case Pass::ShadowDispatch:
        case Pass::Shadow:
            return bench::HitPart::Shadow;
        default:
            return bench::HitPart::None;
    }
}

}  // namespace

double stretchMs(std::span<const PassTiming> stretches, Pass pass) {
    double sum = 0.0;
    for (const PassTiming& stretch : stretches) {
        sum += stretch.pass == pass ? stretch.milliseconds : 0.0;
    }
    return sum;
}

bench::HitTimes hitTimesOf(std::span<const PassTiming> passes) {
    std::vector<bench::PassTime> times;
    for (const PassTiming& pass : passes) {
        times.push_back({partOf(pass.pass), pass.milliseconds});
    }
    return bench::hitTimesOf(times);
}

Result<Exposure> Mount::expose(std::uint32_t seed) const {
    FrameOptions frame = frame_;
    frame.seed = seed;
    Exposure exposure;
    const auto add = [&]() -> Status {
        const Result<std::vector<PassTiming>> stretches = renderer_->timings();
        if (!stretches) {
            return stretches.error();
        }
        exposure.milliseconds += stretchMs(*stretches, Pass::Frame);
        exposure.hitMs += stretchMs(*stretches, Pass::Hits);
        return okStatus();
    };
    Result<LinearImage> image = renderer_->render(frame, samples_, add);
    if (!image) {
        return image.error();
    }
    Result<FrameCounters> counters = renderer_->counters();
    if (!counters) {
        return counters.error();
    }
    exposure.image = std::move(*image);
    exposure.counters = std::move(*counters);
    if (Status split = addSplit(frame, exposure); !split) {
        return split.error();
    }
    return exposure;
}

// Adds the times of passes, measured on one more sample and multiplied by the number of samples. Measuring
// each pass keeps passes from overlapping.
Status Mount::addSplit(FrameOptions frame, Exposure& exposure) const {
    frame.timing = Timing::Passes;
    if (Status rendered = renderer_->renderSamples(frame, 1); !rendered) {
        return rendered;
    }
    const Result<std::vector<PassTiming>> passes = renderer_->timings();
    if (!passes) {
        return passes.error();
    }
    exposure.hits = hitTimesOf(*passes);
    exposure.hits /= 1.0 / samples_;
    for (const PassTiming& pass : *passes) {
        exposure.passes[nameOfPass(pass)] += pass.milliseconds * samples_;
    }
    return okStatus();
}

Result<LinearImage> Mount::exposeSamples(std::uint32_t seed, std::uint32_t samples) const {
    FrameOptions frame = frame_;
    frame.seed = seed;
    return renderer_->render(frame, samples);
}

Result<std::unique_ptr<BenchBed>> BenchBed::create(const Console& console, const RenderArguments& base,
                                                   const Scene& scene, ModuleCache* cache) {
    std::unique_ptr<BenchBed> bed(new BenchBed(console, base, scene, cache));
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    parseSize(base.size, width, height);
    const SceneViewData data = sceneView(base, scene);
    const Result<CameraChoice> camera =
        chooseCamera(scene, data, base.camera, static_cast<double>(width) / height);
    if (!camera) {
        return camera.error();
    }
    bed->camera_ = camera->view;
    bed->cameraName_ = camera->name;
    bed->sky_ = chooseSky(base, scene, data);
    bed->size_ = sizeOf(data);
    bed->lights_ = static_cast<std::uint32_t>(data.lights.size());
    Result<std::unique_ptr<Context>> context = openDevice(base, bed->features_);
    if (!context) {
        return context.error();
    }
    bed->context_ = std::move(*context);
    bed->onCpu_ = isOnCpu(*bed->context_);
    if (Status settled = bed->settleChoices(); !settled) {
        return settled.error();
    }
    if (!base.environment.file.empty()) {
        std::vector<Diagnostic> notes;
        Result<std::unique_ptr<Environment>> environment =
            loadEnvironment(*bed->context_, base.environment.file, notes);
        console.report(notes);
        if (!environment) {
            return environment.error();
        }
        bed->environment_ = std::move(*environment);
    }
    return bed;
}

// A bench compares with one alpha policy and one strategy. Where they are `auto`, they are those that are
// chosen for this scene.
Status BenchBed::settleChoices() {
    const Result<PlanChoice> plan = choosePlan(base_.plan, SceneList({&scene_, 1}));
    if (!plan) {
        return plan.error();
    }
    base_.plan.alpha = toString(plan->options.keys.alpha);
    if (base_.tracing.strategies.front() != kAutoStrategy) {
        return okStatus();
    }
    std::vector<Diagnostic> warnings;
    const Result<StrategyAdvice> advice = adviseRender(base_, plan->options, *context_, scene_, warnings);
    console_.report(warnings);
    if (!advice) {
        return advice.error();
    }
    console_.detail(fmt::format("strategy {}: {}", advice->choice.strategy, advice->choice.why));
    base_.tracing.strategies = {advice->choice.strategy};
    return okStatus();
}

Result<std::shared_ptr<MountedPackage>> BenchBed::mountPackage(const RenderArguments& arguments) {
    const SceneList scenes({&scene_, 1});
    const Result<PlanChoice> plan = choosePlan(arguments.plan, scenes);
    if (!plan) {
        return plan.error();
    }
    Result<Package> package = Diagnostic{};
    if (arguments.package.empty()) {
        package = compileTemporary(
            scene_, compileSettings(arguments, plan->options, context_->handles().tracers, scene_), cache_);
    } else {
        package = Package::load(arguments.package);
        if (package) {
            const PackageDemand demand{strategyOf(arguments), tracerOf(arguments),
                                       !arguments.environment.file.empty()};
            if (Status checked = checkPackage(*package, arguments.package, demand, scene_); !checked) {
                return checked.error();
            }
        }
    }
    if (!package) {
        return package.error();
    }
    auto mounted = std::make_shared<MountedPackage>();
    mounted->package = std::make_unique<Package>(std::move(*package));
    SceneViewData data = sceneView(arguments, scene_);
    data.packageScene = sceneIn(*mounted->package, scene_).value_or(0);
    Result<std::unique_ptr<GpuScene>> uploaded = GpuScene::upload(*context_, *mounted->package, data.view());
    if (!uploaded) {
        return uploaded.error();
    }
    mounted->scene = std::move(*uploaded);
    return mounted;
}

Result<Mount> BenchBed::mount(const bench::Configuration& configuration, const std::string& package) {
    RenderArguments arguments = withSettings(base_, configuration);
    arguments.package = package;
    const std::string key =
        fmt::format("{} {}", package, decided(arguments, [](std::string_view setting) {
                        // With --effects auto, the limit of roughness decides too.
                        return bench::stageOf(setting) == bench::Stage::Compile || setting == "max-roughness";
                    }));
    std::shared_ptr<MountedPackage> shared = packages_[key].lock();
    if (!shared) {
        Result<std::shared_ptr<MountedPackage>> made = mountPackage(arguments);
        if (!made) {
            return made.error();
        }
        shared = std::move(*made);
        packages_[key] = shared;
    }
    const std::string rendererKey =
        fmt::format("{} {}", key, decided(arguments, [](std::string_view setting) {
                        return setting == "ordering" || setting == "batch-effects";
                    }));
    std::shared_ptr<Renderer> renderer = renderers_[rendererKey].lock();
    if (!renderer) {
        Result<std::unique_ptr<Renderer>> made =
            Renderer::create(*context_, *shared->package, *shared->scene, rendererOptions(arguments));
        if (!made) {
            return made.error();
        }
        renderer = std::move(*made);
        renderers_[rendererKey] = renderer;
    }
    Mount mount;
    mount.package_ = std::move(shared);
    mount.renderer_ = std::move(renderer);
    mount.frame_ = frameOptions(arguments, camera_, sky_, environment_.get());
    mount.samples_ = static_cast<std::uint32_t>(arguments.samples);
    mount.ordersHits_ = (strategyOf(arguments) & package::kOrderedStrategies) != 0;
    return mount;
}

}  // namespace glint
