#include "view/picture.h"

#include "base/clock.h"
#include "resolve/resolve.h"
#include "settings/descriptor.h"

#include <glint/scene.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace glint::view {

namespace {

// The picture has the size of its part of the window.
RendererOptions optionsOf(compiler::Settings settings, std::uint32_t width, std::uint32_t height) {
    settings.renderer.width = width;
    settings.renderer.height = height;
    return session::rendererOptions(settings);
}

}  // namespace

Status Picture::readEnvironment(const Build& build, std::vector<Diagnostic>& notes) {
    const std::string& file = build.settings().environment;
    const std::string key =
        file.empty() ? std::string() : fmt::format("{} {}", file, build.package->skyLight());
    if (key == environmentKey_) {
        return okStatus();
    }
    environment_.reset();
    environmentKey_.clear();
    if (!file.empty()) {
        GLINT_TRY(environment_,
                  session::loadEnvironment(context_, file, {.sampled = build.package->skyLight()}, notes));
    }
    environmentKey_ = key;
    return okStatus();
}

// Records the upload of a build's scene on any thread. `scene` is that of the build, in its rest pose or in
// the present one.
Result<Picture::Device> Picture::recordUpload(Context& context, const Build& build, const gltf::Scene& scene,
                                              Use use) {
    const base::Clock::time_point start = base::Clock::now();
    session::SceneViewData data = session::sceneView(build.settings(), scene);
    data.moves = use == Use::Moves;
    if (use == Use::Edited) {
        session::makeEditable(*build.package, data);
    }
    session::usePackage(*build.package, scene, build.textures, data);
    Device made;
    made.read = build.scene;
    GLINT_TRY(made.commands, OneTimeCommands::create(context));
    GLINT_TRY(made.scene,
              session::DeviceScene::record(context, build.package, std::move(data), made.commands.handle()));
    made.recordMs = base::millisecondsSince(start);
    return made;
}

// Returns whether the scene on the device can go on with the build's package.
bool Picture::isSameScene(const Build& build) const {
    // A scene that moves has its materials from the scene with which it was read. One that is edited has the
    // keys of its package.
    return isReady() && edits_.empty() &&
           (build.scene == build_.scene || (!posed_ && haveSameFiles(*build.scene, *build_.scene))) &&
           build.textures == build_.textures &&
           (changeBetween(build.settings(), build_.settings()) & compiler::kChangesUpload) == 0;
}

// Edits are those of a file.
bool Picture::keepsEdits(const Build& build) const {
    return !edits_.empty() && (!isReady() || build.scene->path == build_.scene->path);
}

bool Picture::load(const Build& build) {
    const bool moves = edits_.empty() && posed_ && build.scene == build_.scene;
    if (moves || isSameScene(build)) {
        return false;
    }
    const Use use = keepsEdits(build) ? Use::Edited : Use::Still;
    loading_ = std::async(std::launch::async, [&context = context_, build, use] {
        return recordUpload(context, build, *build.scene, use);
    });
    return true;
}

bool Picture::isLoading() const {
    return loading_.valid() && loading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

// Makes a renderer for the scene, and submits its upload. Frames in flight go on with the scene before.
Status Picture::adopt(Device made, const RendererOptions& options, std::uint64_t frame) {
    GLINT_TRY(made.renderer, made.scene.makeRenderer(context_, options));
    GLINT_TRY_DO(made.commands.submit(context_));
    made.uploadedIn = frame;
    if (isReady()) {
        // The frame that follows its upload may not exist yet.
        retired_.push_back({frame, std::move(device_)});
    }
    live_.reset();
    device_ = std::move(made);
    levelsIn_ = frame;
    levelsAreNew_ = true;
    recordedIn_ = 0;
    inFlight_.clear();
    return okStatus();
}

// Returns whether the scene on the device goes on with the new package.
Result<bool> Picture::replace(Build& build, const RendererOptions& options) {
    if (!isSameScene(build)) {
        return false;
    }
    const Result<Renderer::Replacement> replaced = device_.renderer->replacePackage(build.package);
    if (!replaced) {
        return false;  // the scene is uploaded anew; if that fails, too, its error says why
    }
    device_.scene.package = build.package;
    lastChange_ = fmt::format("package replaced: {} pipelines made, {} kept", replaced->pipelinesMade,
                              replaced->pipelinesKept);
    if (options == options_) {
        return true;
    }
    // The scene changes to the package with a sample of the renderer that it has. Then it can get another
    // one.
    device_.renderer->waitForPipelines();
    if (recordedIn_ == 0 || !device_.renderer->renderSamples(lastFrame_, 1)) {
        return false;
    }
    GLINT_TRY(device_.renderer, device_.scene.makeRenderer(context_, options));
    inFlight_.clear();
    lastChange_ = fmt::format("{} pipelines made", device_.renderer->footprint().pipelines);
    return true;
}

Status Picture::install(Build build, std::uint32_t width, std::uint32_t height, std::uint64_t frame,
                        std::vector<Diagnostic>& notes) {
    std::optional<Result<Device>> loaded;
    if (loading_.valid()) {
        loaded = loading_.get();
    }
    const bool isLoaded = loaded.has_value();
    GLINT_TRY_DO(readEnvironment(build, notes));
    const RendererOptions options = optionsOf(build.settings(), width, height);
    GLINT_TRY(const auto replaced, loaded ? Result<bool>(false) : replace(build, options));
    if (!replaced) {
        const bool keepsPose = edits_.empty() && posed_ && build.scene == build_.scene;
        if (!loaded) {
            loaded = keepsPose ? recordUpload(context_, build, *posed_, Use::Moves)
                               : recordUpload(context_, build, *build.scene,
                                              keepsEdits(build) ? Use::Edited : Use::Still);
        }
        if (!*loaded) {
            return loaded->error();
        }
        const base::Clock::time_point start = base::Clock::now();
        GLINT_TRY_DO(adopt(std::move(**loaded), options, frame));
        // A pose may have been taken while the thread recorded a scene that stands still: the next one
        // uploads it to move.
        if (build.scene != build_.scene || isLoaded) {
            posed_.reset();
            moment_.reset();
        }
        poseIsNew_ = false;
        lastChange_ = fmt::format("upload recorded in {:.0f} ms, renderer made in {:.0f} ms",
                                  device_.recordMs, base::millisecondsSince(start));
    }
    if (!keepsEdits(build)) {
        edits_.clear();
        edited_ = 0;
        addedAnimations_.clear();
    }
    build_ = std::move(build);
    settings_ = build_.settings();
    options_ = options;
    Status edited = okStatus();
    if (device_.scene.data.editable) {
        startEdits();
        edited = makeEdits(frame);
    }
    sky_ = session::chooseSky(settings_, scene(), data());
    restart();
    if (!edited) {
        notes.push_back(edited.error());
    }
    return okStatus();
}

Status Picture::change(const compiler::Settings& settings, std::uint32_t width, std::uint32_t height) {
    const RendererOptions options = optionsOf(settings, width, height);
    if (options != options_) {
        GLINT_TRY(device_.renderer, device_.scene.makeRenderer(context_, options));
        options_ = options;
        inFlight_.clear();
    }
    settings_ = settings;
    sky_ = session::chooseSky(settings_, scene(), data());
    restart();
    return okStatus();
}

Status Picture::pose(const std::optional<session::Moment>& moment, std::uint64_t frame) {
    if (moment == moment_) {
        return okStatus();
    }
    if (!posed_) {
        auto copy = std::make_unique<gltf::Scene>(*build_.scene);
        std::swap(posed_, copy);
        Result<Device> loaded = recordUpload(context_, build_, *posed_, Use::Moves);
        Status adopted = loaded ? adopt(std::move(*loaded), options_, frame) : Status(loaded.error());
        if (!adopted) {
            posed_.reset();
            return adopted;
        }
    }
    moment_ = moment;
    return followScene();
}

// Brings the scene's present moment and edits to the data of the next recording.
Status Picture::followScene() {
    session::moveTo(moment_, *posed_);
    poseIsNew_ = true;
    restart();
    if (live_) {
        return live_->follow(*posed_);
    }
    session::poseSceneView(*posed_, device_.scene.data);
    return okStatus();
}

// Begins with the scene as the device has it: without edits.
void Picture::startEdits() {
    posed_ = std::make_unique<gltf::Scene>(*build_.scene);
    live_.emplace(*device_.scene.package, *device_.scene.gpu, device_.scene.data, *posed_,
                  build_.settings().compile.plan.keys.keptLobes);
    edited_ = 0;
    addedAnimations_.clear();
}

Status Picture::edit(std::span<const session::Edit> edits, std::size_t same, std::uint64_t frame) {
    edits_.assign(edits.begin(), edits.end());
    edited_ = std::min(edited_, same);
    return isReady() ? makeEdits(frame) : okStatus();
}

Status Picture::makeEdits(std::uint64_t frame) {
    Status first = okStatus();
    const auto keep = [&](const Status& status) { first = first ? status : first; };
    const auto isReadyFor = [&](std::size_t index) {
        return index < build_.edits || !session::needsShaders(edits_[index], scene());
    };
    if (edited_ == edits_.size() || !isReadyFor(edited_)) {
        return okStatus();
    }
    if (!live_) {
        GLINT_TRY(auto loaded, recordUpload(context_, build_, *build_.scene, Use::Edited));
        GLINT_TRY_DO(adopt(std::move(loaded), options_, frame));
        startEdits();
    }
    for (; edited_ < edits_.size() && isReadyFor(edited_); ++edited_) {
        const session::Edit& edit = edits_[edited_];
        const std::size_t known = posed_->animations.size();
        const Result<int> node = session::applyEdit(edit, build_.files, *posed_);
        keep(node ? okStatus() : Status(node.error()));
        if (node && edit.kind == session::EditKind::Add) {
            session::addTextures(build_.fileTextures.find(edit.file)->second, device_.scene.data);
        }
        if (posed_->animations.size() > known) {
            addedAnimations_.push_back(known);
        }
    }
    keep(followScene());
    sky_ = session::chooseSky(settings_, scene(), data());
    return first;
}

std::optional<std::size_t> Picture::instanceAt(const Renderer::SurfacePlace& place) const {
    return live_ ? live_->instanceOf(place.handle) : std::optional<std::size_t>(place.instance);
}

Status Picture::record(VkCommandBuffer commands, const CameraView& camera, Timing timing,
                       std::uint64_t number) {
    GLINT_TRY([[maybe_unused]] const auto compacted, gpuScene().recordCompaction(commands, number));
    if (poseIsNew_) {
        GLINT_TRY_DO(gpuScene().update(commands, live_ ? live_->motion() : data().motion(), number));
        poseIsNew_ = false;
        restart();
    }
    if (missingLevels() > 0) {
        GLINT_TRY(const auto levels, gpuScene().textureStream()->record(commands, number));
        levelsIn_ = number;
        if (levels > 0) {
            restart();
        }
    }
    if (device_.renderer->replacementProgress().ready) {
        restart();
    }
    FrameOptions frame = session::frameOptions(settings_, camera, sky_, environment_.get());
    frame.timing = timing;
    frame.sampleIndex = samples_;
    frame.time = moment_ ? static_cast<float>(moment_->seconds) : 0.0F;
    const bool wasDraft = device_.renderer->pipelineProgress().draft;
    lastFrame_ = frame;
    lastFrame_.sampleIndex = 0;
    lastFrame_.timing = Timing::Frame;
    GLINT_TRY_DO(device_.renderer->record(commands, frame));
    samples_ = wasDraft ? 0 : samples_ + 1;
    recordedIn_ = number;
    inFlight_.push_back({number, device_.renderer->recordings()});
    return okStatus();
}

void Picture::completed(std::uint64_t number) {
    std::uint64_t recording = 0;
    std::erase_if(inFlight_, [&](const Recording& one) {
        recording = one.frame <= number ? std::max(recording, one.recording) : recording;
        return one.frame <= number;
    });
    if (recording > 0) {
        device_.renderer->finished(recording);
    }
    if (isReady() && device_.uploadedIn <= number) {
        gpuScene().complete(number);
        device_.commands = OneTimeCommands();
    }
    std::erase_if(retired_, [&](const RetiredDevice& one) { return one.frame <= number; });
}

std::uint32_t Picture::missingLevels() const {
    return isReady() ? device_.scene.gpu->textureStream()->progress().textures : 0;
}

bool Picture::takeAllLevels(std::uint64_t completed) {
    const bool has = levelsAreNew_ && missingLevels() == 0 && levelsIn_ <= completed;
    levelsAreNew_ = levelsAreNew_ && !has;
    return has;
}

}  // namespace glint::view
