#include "view/picture.h"

#include "base/clock.h"
#include "settings/table.h"

#include <glint/measure/render_settings.h>
#include <glint/scene_view/environment.h>
#include <glint/scene_view/package.h>
#include <glint/scene_view/pose.h>
#include <glint/scene_view/textures.h>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace glint::view {

Change changeBetween(const compiler::Settings& before, const compiler::Settings& after) {
    Change change = Change::None;
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        if ((row.commands & compiler::kOfRender) == 0 || row.values.text(before) == row.values.text(after)) {
            continue;
        }
        // What `glint compile` also takes has a part in the package.
        const bool isBuilt = compiler::isCompiled(row) || (row.commands & compiler::kOfCompile) != 0 ||
                             row.stage == compiler::SettingStage::Scene;
        const bool isMade = row.stage == compiler::SettingStage::Renderer;
        change = std::max(change, isBuilt ? Change::Build : isMade ? Change::Renderer : Change::Frame);
    }
    return before.environment == after.environment && before.package == after.package ? change
                                                                                      : Change::Build;
}

namespace {

// Whether both are uploaded in the same way.
bool uploadsAlike(const compiler::Settings& a, const compiler::Settings& b) {
    return std::ranges::all_of(compiler::settingsTable(), [&](const compiler::Descriptor& row) {
        return row.stage != compiler::SettingStage::Scene || row.values.text(a) == row.values.text(b);
    });
}

bool drawAlike(const RendererOptions& a, const RendererOptions& b) {
    return a.strategy == b.strategy && a.width == b.width && a.height == b.height && a.tracer == b.tracer &&
           a.ordering == b.ordering && a.checkOrder == b.checkOrder && a.batchEffects == b.batchEffects &&
           a.screenMarch == b.screenMarch && a.bands == b.bands && a.bounces == b.bounces &&
           a.pipelineThreads == b.pipelineThreads;
}

}  // namespace

RendererOptions Picture::optionsOf(const compiler::Settings& settings, const Package& package,
                                   std::uint32_t width, std::uint32_t height) const {
    RendererOptions options = measure::rendererOptions(settings);
    options.width = width;
    options.height = height;
    options.accumulate = true;
    // Pipelines of cases swap in one after the other where the package can do without them for a while.
    options.backgroundPipelines = package.shape().fallback;
    return options;
}

Status Picture::readEnvironment(const Build& build, std::vector<Diagnostic>& notes) {
    const std::string& file = build.settings.environment;
    const std::string key =
        file.empty() ? std::string() : fmt::format("{} {}", file, build.package->skyLight());
    if (key == environmentKey_) {
        return okStatus();
    }
    environment_.reset();
    environmentKey_.clear();
    if (!file.empty()) {
        Result<std::unique_ptr<Environment>> read =
            scene_view::loadEnvironment(context_, file, {.sampled = build.package->skyLight()}, notes);
        if (!read) {
            return read.error();
        }
        environment_ = std::move(*read);
    }
    environmentKey_ = key;
    return okStatus();
}

Result<Picture::Device> Picture::upload(const Build& build, const RendererOptions& options, bool moves) {
    const gltf::Scene& scene = moves ? *posed_ : *build.scene;
    Device made;
    made.data = std::make_unique<scene_view::SceneViewData>(measure::sceneView(build.settings, scene));
    made.data->packageScene = scene_view::sceneIn(*build.package, scene).value_or(0);
    made.data->moves = moves;
    scene_view::useLayoutOf(*build.package, scene, *made.data);
    scene_view::useTextures(build.textures, *made.data);
    if (moves) {
        scene_view::poseSceneView(scene, *made.data);
        measure::sizeLights(build.settings, *made.data);
    }
    Result<std::unique_ptr<GpuScene>> uploaded =
        GpuScene::upload(context_, *build.package, made.data->view());
    if (!uploaded) {
        return uploaded.error();
    }
    made.scene = std::move(*uploaded);
    Result<std::unique_ptr<Renderer>> renderer =
        Renderer::create(context_, *build.package, *made.scene, options);
    if (!renderer) {
        return renderer.error();
    }
    made.renderer = std::move(*renderer);
    return made;
}

// Returns whether the scene on the device goes on with the new package.
Result<bool> Picture::replace(Build& build, const RendererOptions& options) {
    // A scene that moves has its materials from the scene that it was read with.
    const bool isSameScene =
        renderer_ &&
        (build.scene == build_.scene || (!posed_ && haveSameFiles(*build.scene, *build_.scene))) &&
        build.textures == build_.textures && uploadsAlike(build.settings, build_.settings);
    if (!isSameScene) {
        return false;
    }
    const Result<PackageReplacement> replaced = renderer_->replacePackage(build.package);
    if (!replaced) {
        return false;  // the scene is uploaded anew; if that fails, too, its error says why
    }
    lastChange_ = fmt::format("package replaced: {} pipelines made, {} kept", replaced->pipelinesMade,
                              replaced->pipelinesKept);
    if (drawAlike(options, options_)) {
        return true;
    }
    // The scene changes to the package with a sample of the renderer that it has. Then it can get another
    // one.
    renderer_->waitForPipelines();
    if (recordedIn_ == 0 || !renderer_->renderSamples(lastFrame_, 1)) {
        return false;
    }
    Result<std::unique_ptr<Renderer>> renderer =
        Renderer::create(context_, *build.package, *gpuScene_, options);
    if (!renderer) {
        return renderer.error();
    }
    renderer_ = std::move(*renderer);
    inFlight_.clear();
    lastChange_ = fmt::format("{} pipelines made", renderer_->footprint().pipelines);
    return true;
}

Status Picture::install(Build build, std::uint32_t width, std::uint32_t height,
                        std::vector<Diagnostic>& notes) {
    if (Status read = readEnvironment(build, notes); !read) {
        return read;
    }
    const base::Clock::time_point start = base::Clock::now();
    const RendererOptions options = optionsOf(build.settings, *build.package, width, height);
    const Result<bool> replaced = replace(build, options);
    if (!replaced) {
        return replaced.error();
    }
    if (!*replaced) {
        if (build.scene != build_.scene) {
            posed_.reset();
            moment_.reset();
        }
        Result<Device> made = upload(build, options, posed_ != nullptr);
        if (!made) {
            return made.error();
        }
        renderer_ = std::move(made->renderer);
        gpuScene_ = std::move(made->scene);
        data_ = std::move(made->data);
        uploaded_ = build.scene;
        inFlight_.clear();
        lastChange_ = fmt::format("scene uploaded in {:.0f} ms", base::millisecondsSince(start));
    }
    build_ = std::move(build);
    settings_ = build_.settings;
    options_ = options;
    sky_ = measure::chooseSky(settings_, scene(), *data_);
    restart();
    return okStatus();
}

Status Picture::change(const compiler::Settings& settings, std::uint32_t width, std::uint32_t height) {
    const RendererOptions options = optionsOf(settings, *build_.package, width, height);
    if (!drawAlike(options, options_)) {
        Result<std::unique_ptr<Renderer>> renderer =
            Renderer::create(context_, *build_.package, *gpuScene_, options);
        if (!renderer) {
            return renderer.error();
        }
        renderer_ = std::move(*renderer);
        options_ = options;
        inFlight_.clear();
    }
    settings_ = settings;
    sky_ = measure::chooseSky(settings_, scene(), *data_);
    restart();
    return okStatus();
}

Status Picture::pose(const std::optional<Moment>& moment) {
    if (moment == moment_) {
        return okStatus();
    }
    if (!posed_) {
        auto copy = std::make_unique<gltf::Scene>(*build_.scene);
        std::swap(posed_, copy);
        Result<Device> made = upload(build_, options_, true);
        if (!made) {
            posed_.reset();
            return made.error();
        }
        renderer_ = std::move(made->renderer);
        gpuScene_ = std::move(made->scene);
        data_ = std::move(made->data);
        inFlight_.clear();
    }
    moment_ = moment;
    scene_view::applyPose(moment ? scene_view::poseAt(*posed_, moment->animations, moment->seconds)
                                 : scene_view::restPose(*posed_),
                          *posed_);
    scene_view::poseSceneView(*posed_, *data_);
    measure::sizeLights(settings_, *data_);
    poseIsNew_ = true;
    restart();
    return okStatus();
}

Status Picture::record(VkCommandBuffer commands, const CameraView& camera, Timing timing,
                       std::uint64_t number) {
    if (poseIsNew_) {
        if (Status moved = gpuScene_->update(commands, data_->motion()); !moved) {
            return moved;
        }
        poseIsNew_ = false;
    }
    if (renderer_->replacementProgress().ready) {
        restart();
    }
    FrameOptions frame = measure::frameOptions(settings_, camera, sky_, environment_.get());
    frame.timing = timing;
    frame.sampleIndex = samples_;
    frame.time = moment_ ? static_cast<float>(moment_->seconds) : 0.0F;
    const bool wasDraft = renderer_->pipelineProgress().draft;
    lastFrame_ = frame;
    lastFrame_.sampleIndex = 0;
    lastFrame_.timing = Timing::Frame;
    if (Status recorded = renderer_->record(commands, frame); !recorded) {
        return recorded;
    }
    samples_ = wasDraft ? 0 : samples_ + 1;
    recordedIn_ = number;
    inFlight_.push_back({number, renderer_->recordings()});
    return okStatus();
}

void Picture::completed(std::uint64_t number) {
    std::uint64_t recording = 0;
    std::erase_if(inFlight_, [&](const Recording& one) {
        recording = one.frame <= number ? std::max(recording, one.recording) : recording;
        return one.frame <= number;
    });
    if (recording > 0) {
        renderer_->finished(recording);
    }
}

}  // namespace glint::view
