#include "gltf/scene_list.h"
#include "settings/table.h"
#include "spirv/compiler.h"

#include <glint/measure/bed.h>
#include <glint/measure/machine.h>
#include <glint/measure/point.h>
#include <glint/measure/profile.h>
#include <glint/measure/render_settings.h>
#include <glint/measure/strategy_advice.h>
#include <glint/scene_view/camera.h>
#include <glint/scene_view/environment.h>
#include <glint/scene_view/package.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

namespace glint::measure {

namespace {

// Opens the device with as many of its optional features as possible, for the default and the sweep.
Result<std::unique_ptr<Context>> openDevice(const compiler::Settings& render, DeviceOptions& features) {
    const HeadlessOptions wanted = deviceOptions(render);
    HeadlessOptions options = wanted;
    Result<std::unique_ptr<Context>> context = Diagnostic{};
    for (const DeviceOptions tried :
         {DeviceOptions{true, true}, {false, true}, {true, false}, {false, false}}) {
        // It is used if shaders can be compiled for it and the validation layers know it.
        options.positionFetch =
            wanted.positionFetch || (tried.positionFetch && compiler::supportsPositionFetch());
        options.shaderFloat16 = wanted.shaderFloat16 || tried.float16;
        context = Context::createHeadless(options);
        if (context) {
            features = {options.positionFetch, options.shaderFloat16};
            break;
        }
    }
    return context;
}

SceneSize sizeOf(const scene_view::SceneViewData& data) {
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

// Returns as words the swept settings for which `decides` is true.
template <typename Decides>
std::string decided(const compiler::Settings& settings, const Decides& decides) {
    compiler::Configuration configuration = configurationOf(settings);
    std::erase_if(configuration,
                  [&](const auto& choice) { return !decides(*compiler::sweptSetting(choice.first)); });
    return fmt::format("{}", fmt::join(compiler::wordsOf(configuration), " "));
}

// The passes of all cases count together.
std::string nameOfPass(const PassTiming& pass) {
    return pass.pass == Pass::ShadeCase ? std::string(kShadeCases) : pass.name;
}

}  // namespace

double stretchMs(std::span<const PassTiming> stretches, Pass pass) {
    double sum = 0.0;
    for (const PassTiming& stretch : stretches) {
        sum += stretch.pass == pass ? stretch.milliseconds : 0.0;
    }
    return sum;
}

// Renders the frames before the picture, each with samples of its own, and filters them.
Status Mount::showFramesBefore(FrameOptions frame) const {
    constexpr std::uint32_t kSeedsOfFrames = 0xF17E0000U;  // far from those of rounds
    filter_->restart();
    for (std::uint32_t i = 1; i < frames_; ++i) {
        FrameOptions before = frame;
        before.seed = frame.seed + kSeedsOfFrames + (i << 8U);
        GLINT_TRY_DO(renderer_->renderSamples(before, samples_));
        GLINT_TRY_DO(filter_->filter());
    }
    return okStatus();
}

Result<Exposure> Mount::expose(std::uint32_t seed) const {
    FrameOptions frame = frame_;
    frame.seed = seed;
    Exposure exposure;
    if (filter_ != nullptr) {
        GLINT_TRY_DO(showFramesBefore(frame));
    }
    const auto add = [&]() -> Status {
        GLINT_TRY(const auto stretches, renderer_->timings());
        exposure.milliseconds += stretchMs(stretches, Pass::Frame);
        exposure.hitMs += stretchMs(stretches, Pass::Hits);
        return okStatus();
    };
    Result<LinearImage> image = renderer_->render(frame, samples_, add);
    if (!image) {
        return image.error();
    }
    GLINT_TRY(auto counters, renderer_->counters());
    if (filter_ != nullptr) {
        image = filter_->filter();
        if (!image) {
            return image.error();
        }
        exposure.milliseconds += filter_->milliseconds();
        exposure.passes[std::string(kFilterPass)] = filter_->milliseconds();
    }
    exposure.image = std::move(*image);
    exposure.counters = std::move(counters);
    GLINT_TRY_DO(addSplit(frame, exposure));
    return exposure;
}

// Adds the times of passes, measured on one more sample and multiplied by the number of samples. Measuring
// each pass keeps passes from overlapping.
Status Mount::addSplit(FrameOptions frame, Exposure& exposure) const {
    frame.timing = Timing::Passes;
    GLINT_TRY_DO(renderer_->renderSamples(frame, 1));
    GLINT_TRY(const auto passes, renderer_->timings());
    exposure.hits = hitTimesOf(passes);
    exposure.hits /= 1.0 / samples_;
    for (const PassTiming& pass : passes) {
        exposure.passes[nameOfPass(pass)] += pass.milliseconds * samples_;
    }
    return okStatus();
}

Result<LinearImage> Mount::exposeSamples(std::uint32_t seed, std::uint32_t samples) const {
    FrameOptions frame = frame_;
    frame.seed = seed;
    return renderer_->render(frame, samples);
}

Result<std::unique_ptr<BenchBed>> BenchBed::create(const Observer& observer, const compiler::Settings& base,
                                                   const gltf::Scene& scene, compiler::ModuleCache* cache,
                                                   compiler::CacheStore* store) {
    std::unique_ptr<BenchBed> bed(new BenchBed(observer, base, scene, cache, store));
    const scene_view::SceneViewData data = sceneView(base, scene);
    GLINT_TRY(const auto camera,
              scene_view::chooseCamera(scene, data, base.camera,
                                       static_cast<double>(base.renderer.width) / base.renderer.height));
    if (const std::optional<Diagnostic> warning = scene_view::nothingSeen(scene, data, camera)) {
        observer.report(*warning);
    }
    bed->camera_ = camera.view;
    bed->cameraName_ = camera.name;
    bed->sky_ = chooseSky(base, scene, data);
    bed->size_ = sizeOf(data);
    bed->lights_ = static_cast<std::uint32_t>(data.lights.size());
    GLINT_TRY(bed->context_, openDevice(base, bed->features_));
    bed->onCpu_ = isOnCpu(*bed->context_);
    GLINT_TRY_DO(bed->settleChoices());
    if (!base.environment.empty()) {
        std::vector<Diagnostic> notes;
        Result<std::unique_ptr<Environment>> environment =
            scene_view::loadEnvironment(*bed->context_, base.environment, {.sampled = true}, notes);
        observer.report(notes);
        if (!environment) {
            return environment.error();
        }
        bed->environment_ = std::move(*environment);
    }
    return bed;
}

// A bench compares with one value of each setting. Where a setting is `auto`, it is what is chosen for this
// scene.
Status BenchBed::settleChoices() {
    GLINT_TRY(const auto plan, choosePlan(base_, gltf::SceneList({&scene_, 1})));
    base_.alpha = plan.options.keys.alpha;
    base_ = withSettings(std::move(base_), plan.decided);
    if (base_.strategy) {
        return okStatus();
    }
    std::vector<Diagnostic> warnings;
    const Result<compiler::StrategyAdvice> advice =
        adviseRender(base_, plan.options, *context_, scene_, nullptr, warnings);
    observer_.report(warnings);
    if (!advice) {
        return advice.error();
    }
    observer_.detail(fmt::format("strategy {}: {}", advice->choice.strategy, advice->choice.why));
    base_.strategy = valueNamed<package::Strategy>(advice->choice.strategy);
    return okStatus();
}

Result<std::shared_ptr<const scene_view::TextureSet>> BenchBed::textures(const compiler::Settings& settings,
                                                                         const Package& package) {
    const scene_view::TextureOptions options = textureOptions(settings, *context_, package, store_);
    std::shared_ptr<const scene_view::TextureSet>& known =
        textures_[{options.fit.compress, options.fit.decodeEmission}];
    if (!known) {
        Result<std::shared_ptr<const scene_view::TextureSet>> loaded =
            scene_view::loadTextures(scene_, options);
        if (!loaded) {
            return loaded;
        }
        observer_.report((*loaded)->notes);
        known = std::move(*loaded);
    }
    return known;
}

Result<std::shared_ptr<MountedPackage>> BenchBed::mountPackage(const compiler::Settings& render) {
    const gltf::SceneList scenes({&scene_, 1});
    GLINT_TRY(const auto plan, choosePlan(render, scenes));
    Result<Package> package = Diagnostic{};
    if (render.package.empty()) {
        package = scene_view::compileAndLoad(
            scene_, compileSettings(render, plan.options, context_->handles().tracers, scene_), cache_);
    } else {
        package = Package::load(render.package);
        if (package) {
            const scene_view::PackageDemand demand{*render.strategy, render.renderer.tracer,
                                                   !render.environment.empty()};
            GLINT_TRY_DO(scene_view::checkPackage(*package, render.package, demand, scene_));
        }
    }
    if (!package) {
        return package.error();
    }
    auto mounted = std::make_shared<MountedPackage>();
    mounted->package = std::make_unique<Package>(std::move(*package));
    scene_view::SceneViewData data = sceneView(render, scene_);
    data.packageScene = scene_view::sceneIn(*mounted->package, scene_).value_or(0);
    scene_view::useLayoutOf(*mounted->package, scene_, data);
    GLINT_TRY(auto images, textures(render, *mounted->package));
    useTextures(std::move(images), data);
    GLINT_TRY(mounted->scene, GpuScene::upload(*context_, *mounted->package, data.view()));
    return mounted;
}

Result<Mount> BenchBed::mount(const compiler::Configuration& configuration, const std::string& package) {
    compiler::Settings render = withSettings(base_, configuration);
    render.package = package;
    return mount(std::move(render));
}

Result<Mount> BenchBed::mountFiltered(const FilterMaker& filter, std::uint32_t frames) {
    compiler::Settings render = base_;
    render.compile.layers = filter.layers;
    render.compile.layers.insert(render.compile.layers.end(), filter.imageLayers.begin(),
                                 filter.imageLayers.end());
    Result<Mount> mounted = mount(render);
    if (!mounted && mounted.error().id == "layer-effect") {
        render.compile.layers = filter.layers;
        mounted = mount(render);
    }
    if (!mounted) {
        return mounted;
    }
    GLINT_TRY(mounted->filter_, filter.make(*context_, *mounted->renderer_, render.renderer.width,
                                            render.renderer.height, render.samples));
    mounted->frames_ = frames;
    return mounted;
}

Result<Mount> BenchBed::mount(compiler::Settings render) {
    const std::string key = fmt::format("{} {} {}", render.package, fmt::join(render.compile.layers, ","),
                                        decided(render, [](const compiler::Descriptor& row) {
                                            // With --effects auto, the limit of roughness decides too.
                                            return isCompiled(row) ||
                                                   row.stage == compiler::SettingStage::Scene ||
                                                   row.name == "max-roughness";
                                        }));
    std::shared_ptr<MountedPackage> shared = packages_[key].lock();
    if (!shared) {
        GLINT_TRY(shared, mountPackage(render));
        packages_[key] = shared;
    }
    const std::string rendererKey =
        fmt::format("{} {}", key, decided(render, [](const compiler::Descriptor& row) {
                        return row.stage == compiler::SettingStage::Renderer;
                    }));
    std::shared_ptr<Renderer> renderer = renderers_[rendererKey].lock();
    if (!renderer) {
        GLINT_TRY(renderer,
                  Renderer::create(*context_, *shared->package, *shared->scene, rendererOptions(render)));
        renderers_[rendererKey] = renderer;
    }
    Mount mount;
    mount.package_ = std::move(shared);
    mount.renderer_ = std::move(renderer);
    mount.frame_ = frameOptions(render, camera_, sky_, environment_.get());
    mount.samples_ = render.samples;
    mount.ordersHits_ = (*render.strategy & package::orderedStrategies()) != 0;
    return mount;
}

}  // namespace glint::measure
