#include "base/lists.h"
#include "cache/store.h"
#include "gltf/import.h"
#include "gltf/scene_list.h"
#include "settings/descriptor.h"
#include "spirv/compiler.h"

#include <glint/measure/bed.h>
#include <glint/measure/machine.h>
#include <glint/measure/target.h>
#include <glint/session/camera.h>

#include <fmt/format.h>

#include <utility>

namespace glint::measure {

namespace {

// Opens the device with as many of its optional features as possible, for the default and the sweep.
Result<std::unique_ptr<Context>> openDevice(const compiler::Settings& render, BedFacts& facts) {
    const HeadlessOptions wanted = session::deviceOptions(render);
    HeadlessOptions options = wanted;
    Result<std::unique_ptr<Context>> context = Diagnostic{};
    for (const auto& [positionFetch, float16] :
         {std::pair(true, true), std::pair(false, true), std::pair(true, false), std::pair(false, false)}) {
        // It is used if shaders can be compiled for it and the validation layers know it.
        options.positionFetch = wanted.positionFetch || (positionFetch && compiler::supportsPositionFetch());
        options.shaderFloat16 = wanted.shaderFloat16 || float16;
        context = Context::createHeadless(options);
        if (context) {
            facts.positionFetch = options.positionFetch;
            facts.float16 = options.shaderFloat16;
            facts.onCpu = isOnCpu(**context);
            break;
        }
    }
    return context;
}

void countTriangles(const session::SceneViewData& data, BedFacts& facts) {
    std::map<std::uint32_t, std::uint64_t> triangles;  // by mesh
    for (const PrimitiveView& primitive : data.primitives) {
        triangles[primitive.mesh] += primitive.indices.size() / 3;
    }
    for (const InstanceView& instance : data.instances) {
        facts.triangles += triangles[instance.mesh];
        ++facts.instances;
    }
}

// A pass of a case counts with those of the others.
std::string nameOfPass(const PassTiming& pass) {
    return pass.pass == Pass::FirstCase   ? std::string("first")
           : pass.pass == Pass::ShadeCase ? std::string(kShadeCases)
                                          : pass.name;
}

}  // namespace

double stretchMs(std::span<const PassTiming> stretches, Pass pass) {
    return base::sumOf<double>(stretches, [pass](const PassTiming& stretch) {
        return stretch.pass == pass ? stretch.milliseconds : 0.0;
    });
}

// Renders the frames before the picture, each with samples of its own, and filters them.
Status Mount::showFramesBefore(FrameOptions frame) const {
    constexpr std::uint32_t kSeedsOfFrames = 0xF17E0000U;  // far from those of rounds
    filter_->restart();
    for (std::uint32_t i = 1; i < frames_; ++i) {
        FrameOptions before = frame;
        before.seed = frame.seed + kSeedsOfFrames + (i << 8U);
        GLINT_TRY_DO(renderer_->renderSamples(before, samples_));
        GLINT_TRY([[maybe_unused]] const auto filtered, filter_->filter());
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
    GLINT_TRY(exposure.image, renderer_->render(frame, samples_, add));
    GLINT_TRY(exposure.counters, renderer_->counters());
    if (filter_ != nullptr) {
        GLINT_TRY(exposure.image, filter_->filter());
        exposure.milliseconds += filter_->milliseconds();
        exposure.passes[std::string(kFilterPass)] = filter_->milliseconds();
    }
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
    const session::SceneViewData data = session::sceneView(base, scene);
    GLINT_TRY(const auto camera,
              session::chooseCamera(scene, data, base.camera,
                                    static_cast<double>(base.renderer.width) / base.renderer.height));
    if (const std::optional<Diagnostic> warning = session::nothingSeen(scene, data, camera)) {
        observer.report(*warning);
    }
    bed->camera_ = camera.view;
    bed->sky_ = session::chooseSky(base, scene, data);
    bed->facts_.cameraName = camera.name;
    bed->facts_.lights = static_cast<std::uint32_t>(data.lights.size());
    countTriangles(data, bed->facts_);
    GLINT_TRY(bed->context_, openDevice(base, bed->facts_));
    GLINT_TRY_DO(bed->resolveBase());
    if (!base.environment.empty()) {
        std::vector<Diagnostic> notes;
        Result<std::unique_ptr<Environment>> environment =
            session::loadEnvironment(*bed->context_, base.environment, {.sampled = true}, notes);
        observer.report(notes);
        if (!environment) {
            return environment.error();
        }
        bed->environment_ = std::move(*environment);
    }
    return bed;
}

// A bench compares with one alpha policy and one strategy. Where they are `auto`, they are those that are
// chosen for this scene.
Status BenchBed::resolveBase() {
    GLINT_TRY(const auto target, targetOf(base_, *context_, nullptr, scene_));
    GLINT_TRY(build_, resolve(list_, base_, target));
    observer_.report(build_.messages);
    if (!base_.strategy) {
        const compiler::StrategyChoice& choice = build_.settings.compile.strategyChoice->choice;
        observer_.detail(fmt::format("strategy {}: {}", choice.strategy, choice.why));
    }
    base_.alpha = build_.settings.alpha;
    base_.strategy = build_.settings.strategy;
    return okStatus();
}

// A package that does not rely on what textures hold needs a scene that was read accordingly.
Result<std::shared_ptr<const gltf::SceneList>> BenchBed::scenesFor(const Package* package) {
    if (package == nullptr || package->trustTextures() == scene_.trustsTextures) {
        return list_;
    }
    if (!otherScene_) {
        GLINT_TRY(const auto import,
                  session::importOptions(base_, session::ImageReading::Files, store_, package));
        GLINT_TRY(auto read, importScene(scene_.path, import));
        otherScene_ = std::make_unique<const gltf::Scene>(std::move(read));
        otherList_ = std::make_shared<const gltf::SceneList>(std::span(otherScene_.get(), 1));
    }
    return otherList_;
}

Result<std::shared_ptr<const session::TextureSet>> BenchBed::textures(const compiler::Build& build,
                                                                      const Package& package) {
    const gltf::Scene& scene = build.scenes->scenes().front();
    const session::TextureOptions options =
        session::textureOptions(build.settings, *context_, package, store_);
    std::shared_ptr<const session::TextureSet>& known =
        textures_[{&scene, options.fit.compress, options.fit.decodeEmission}];
    if (!known) {
        GLINT_TRY(known, session::loadTextures(scene, options));
        observer_.report(known->notes);
    }
    return known;
}

Result<session::DeviceScene> BenchBed::mountScene(const compiler::Build& build,
                                                  std::shared_ptr<const Package> given) {
    const gltf::Scene& scene = build.scenes->scenes().front();
    GLINT_TRY(auto package, session::packageFor(build, std::move(given), cache_));
    GLINT_TRY(auto images, textures(build, *package));
    session::SceneViewData data = session::sceneView(build.settings, scene);
    session::usePackage(*package, scene, std::move(images), data);
    return session::DeviceScene::upload(*context_, std::move(package), std::move(data));
}

Result<Mount> BenchBed::mount(const compiler::Configuration& configuration, const std::string& package) {
    compiler::Settings render = withSettings(base_, configuration);
    render.package = package;
    return mount(render);
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

Result<Mount> BenchBed::mount(const compiler::Settings& asked) {
    GLINT_TRY(auto given, session::givenPackage(asked));
    GLINT_TRY(auto scenes, scenesFor(given.get()));
    GLINT_TRY(const auto target, targetOf(asked, *context_, given.get(), scenes->scenes().front()));
    GLINT_TRY(const auto build, resolve(std::move(scenes), asked, target));
    const compiler::Settings& settings = build.settings;
    Mount mount;
    for (const Known& known : known_) {
        const std::shared_ptr<const session::DeviceScene> scene = known.scene.lock();
        if (scene && changeBetween(known.settings, settings) < compiler::kChangesUpload) {
            mount.scene_ = scene;
        }
    }
    if (!mount.scene_) {
        GLINT_TRY(auto scene, mountScene(build, std::move(given)));
        mount.scene_ = std::make_shared<const session::DeviceScene>(std::move(scene));
    }
    for (const Known& known : known_) {
        if (known.scene.lock() == mount.scene_ &&
            changeBetween(known.settings, settings) < compiler::kChangesRenderer) {
            mount.renderer_ = known.renderer.lock();
        }
    }
    if (!mount.renderer_) {
        GLINT_TRY(mount.renderer_, mount.scene_->makeRenderer(*context_, session::rendererOptions(settings)));
        known_.push_back({settings, mount.scene_, mount.renderer_});
    }
    mount.frame_ = session::frameOptions(settings, camera_, sky_, environment_.get());
    mount.samples_ = settings.samples;
    mount.ordersHits_ = (*settings.strategy & package::orderedStrategies()) != 0;
    return mount;
}

}  // namespace glint::measure
