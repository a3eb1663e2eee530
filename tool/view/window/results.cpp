// Builds of the pictures, what makes them build again, and the window's measurements and files.
#include "base/fields.h"
#include "base/files.h"
#include "base/text.h"
#include "image/compare.h"
#include "image/image_file.h"
#include "image/tone.h"
#include "settings/descriptor.h"
#include "view/request.h"
#include "view/window/window.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <unistd.h>
#include <utility>

namespace glint::view {

// --- Builds ---

void Window::order(std::size_t index, bool rereads) {
    Side& one = *sides_[index];
    one.ordered = one.wanted;
    builder_->start({index, one.wanted, scene_, edits_, rereads});
}

void Window::orderAll(bool rereads) {
    for (std::size_t i = 0; i < kPictures; ++i) {
        if (sides_[i]) {
            order(i, rereads);
        }
    }
}

void Window::pollFiles() {
    if (base::millisecondsSince(polled_) < kPollMs || builder_->isBusy(0)) {
        return;
    }
    polled_ = base::Clock::now();
    if (packageWatch_) {
        const Result<std::shared_ptr<const Package>> package = packageWatch_->poll();
        if (!package) {
            report(package.error());
        } else if (*package) {
            say("the package has changed");
            order(0);
        }
    }
    if (!watch_.wait(std::chrono::milliseconds(0))) {
        return;
    }
    const std::vector<std::string> changed = watch_.changed();
    if (!changed.empty()) {
        say(changed.front() + " has changed");
        orderAll(true);
    }
}

Status Window::takeBuilds() {
    for (const Diagnostic& message : builder_->takeMessages()) {
        report(message);
    }
    for (std::size_t i = 0; i < kPictures; ++i) {
        if (sides_[i] && sides_[i]->loading != nullptr && sides_[i]->picture.isLoading()) {
            continue;
        }
        std::optional<Result<Build>> done;
        if (sides_[i] && sides_[i]->loading != nullptr) {
            done = std::move(*std::exchange(sides_[i]->loading, nullptr));
        } else {
            done = builder_->poll(i);
            if (!done || !sides_[i]) {
                continue;
            }
            if (*done && sides_[i]->picture.load(**done)) {
                sides_[i]->loading = std::make_unique<Build>(std::move(**done));
                continue;
            }
        }
        Status installed = *done ? install(i, std::move(**done)) : Status((*done).error());
        sides_[i]->buildFailed = !installed;
        if (installed) {
            opening_.reset();
            error_.reset();
            continue;
        }
        if (!sides_[0]->picture.isReady() && !driver_) {
            // Nothing is shown yet, and nobody can correct it here.
            return installed;
        }
        keepScene();
        fail(installed.error());
        dropEdits(installed.error());
    }
    return okStatus();
}

Status Window::install(std::size_t index, Build build) {
    Side& one = *sides_[index];
    if (!one.picture.hasLoaded()) {
        GLINT_TRY_DO(presenter_->waitForFrames());
    }
    finishSamples();
    const bool isOtherScene =
        index == 0 && (!one.picture.isReady() || one.picture.build().scene->path != build.scene->path);
    const bool isUploaded = !one.picture.isReady() || one.picture.build().scene != build.scene;
    const double buildMs = build.readMs + build.compileMs + build.texturesMs;
    const int compiled = build.modulesCompiled;
    const std::vector<base::InputFile> inputs = build.inputs;
    std::vector<Diagnostic> notes;
    const auto [width, height] = pictureExtent();
    const Status installed =
        one.picture.install(std::move(build), width, height, presenter_->submitted() + 1, notes);
    for (const Diagnostic& note : notes) {
        report(note);
    }
    if (!installed) {
        return installed.error();
    }
    one.history.clear();
    if (index == 0) {
        watch_.watch(inputs);
        packageWatch_.reset();
        if (!one.wanted.package.empty()) {
            packageWatch_.emplace(one.wanted.package);
        }
    }
    if (isUploaded) {
        pick_.reset();
    }
    if (one.picture.needsBuild()) {
        order(index);  // edits have come meanwhile
    }
    if (isOtherScene) {
        cameraIsNew_ = true;
        orbitDistance_ = 0.0;
        exposureIsNew_ = autoExposure_;
        animationChoice_ = 0;
        const auto& animations = one.picture.scene().animations;
        if (request_.animation == "all") {
            animationChoice_ = static_cast<int>(animations.size());
        }
        for (std::size_t i = 0; i < animations.size(); ++i) {
            if (animations[i].name == request_.animation || std::to_string(i) == request_.animation) {
                animationChoice_ = static_cast<int>(i);
            }
        }
        if (animations.empty() && one.wanted.materials.empty()) {
            poses_ = plays_ = false;
        }
    }
    say(fmt::format("{} modules compiled, {:.0f} ms; {}", compiled, buildMs, one.picture.lastChange()));
    GLINT_TRY_DO(followSettings(index));
    return applyPose();
}

// Applies changed settings to the picture, apart from those that need another build.
Status Window::followSettings(std::size_t index) {
    Side& one = *sides_[index];
    if (!one.picture.isReady()) {
        return okStatus();
    }
    // Until the other build is there, the picture keeps what only that build has.
    if (changeBetween(one.ordered, one.wanted) >= compiler::kChangesUpload) {
        order(index);
    }
    compiler::Settings next = withoutRebuilding(one.picture.build().settings(), one.wanted);
    const auto [width, height] = pictureExtent();
    next.renderer.width = width;
    next.renderer.height = height;
    const std::uint32_t changes = changeBetween(one.picture.settings(), next);
    if (changes == 0) {
        return okStatus();
    }
    if (!builder_->isBusy(index) && !one.buildFailed) {
        error_.reset();
    }
    if (changes != compiler::kChangesFrame) {
        GLINT_TRY_DO(presenter_->waitForFrames());
        finishSamples();
        one.history.clear();
    }
    if (Status changed = one.picture.change(next, width, height); !changed) {
        fail(changed.error());
    }
    wakes_ = 4;
    return okStatus();
}

// --- Measurements and files ---

namespace {

namespace fs = std::filesystem;

// Resident memory of this process; 0 where the system does not say.
std::uint64_t residentBytes() {
    std::ifstream file("/proc/self/statm");
    std::uint64_t total = 0;
    std::uint64_t resident = 0;
    file >> total >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

Status Window::measureExposure() {
    Picture& picture = sides_[0]->picture;
    if (picture.samples() > 0) {
        GLINT_TRY(const auto image, picture.renderer().readOutput());
        GLINT_TRY(const auto surfaces, picture.renderer().readSurfaces());
        exposure_ = static_cast<float>(image::automaticExposure(image, surfaces));
        exposureIsNew_ = false;
        wakes_ = 4;
    }
    return okStatus();
}

Status Window::writeShot(const std::string& file, const Look& shown, const LinearImage& image) {
    const auto exposure = static_cast<double>(exposure_);
    if (!shown.view.empty()) {
        return image::writeImage(file, measure::withLegend(*view_));
    }
    std::vector<image::ExrLayer> layers;
    if (!shown.layer.empty()) {
        GLINT_TRY(auto layer, layerForFile(shown, side().picture));
        layers.push_back(std::move(layer));
    }
    return image::writeImage(file, image, exposure, layers);
}

Status Window::saveScreenshot() {
    wantsShot_ = false;
    Picture& picture = side().picture;
    GLINT_TRY(const auto image, picture.renderer().readOutput());
    fs::path file;
    const std::string stem = fs::path(scene_).stem().string();
    // A layer needs a file that holds its numbers.
    const Look shown = view_ ? look_ : Look();
    const char* const extension = shown.layer.empty() ? "png" : "exr";
    std::error_code error;
    do {
        file = fs::path(request_.folder) / fmt::format("{}-{:03}.{}", stem, ++shots_, extension);
    } while (fs::exists(file, error));
    GLINT_TRY_DO(writeShot(file, shown, image));
    const std::string animation = animationChoice_ >= static_cast<int>(picture.scene().animations.size())
                                      ? std::string("all")
                                      : std::to_string(animationChoice_);
    // The settings that were asked for say the same as the decided ones, in fewer words.
    compiler::Settings settings = withoutRebuilding(picture.build().resolved->asked, picture.settings());
    settings.strategy = picture.settings().strategy;
    // A camera that frames everything was placed for another moment.
    const bool isPlaced = poses_ && session::framesEverything(picture.scene(), sides_[0]->wanted.camera);
    const std::string camera = isPlaced ? session::toText(camera_.placed()) : camera_.name();
    fs::path edits;
    if (!edits_.empty()) {
        edits = file;
        edits.replace_extension(".edits.json");
        GLINT_TRY_DO(base::writeFile(edits, base::toText(base::jsonOf(session::EditList{edits_}))));
    }
    const std::vector<std::string> words =
        shotWords(settings, {scene_, file.string(), camera, static_cast<double>(exposure_),
                             poses_ ? fmt::format("{}", time_) : std::string(), animation, shown.view,
                             shown.layer.empty() ? std::string() : layerWord(shown.layer), edits.string()});
    fs::path command = file;
    command.replace_extension(".sh");
    const std::string line = base::shellWords(words);
    GLINT_TRY_DO(base::writeFile(command, "# Makes the picture beside this file again.\n" + line + "\n"));
    say("wrote " + file.string());
    report(Diagnostic{Severity::Note, "window-shot", file.string(), "shows the picture; this makes it again",
                      line});
    return okStatus();
}

Status Window::measureDifference() {
    if (!sides_[1] || !sides_[1]->picture.isReady()) {
        return okStatus();
    }
    GLINT_TRY(const auto first, sides_[0]->picture.renderer().readOutput());
    GLINT_TRY(const auto second, sides_[1]->picture.renderer().readOutput());
    GLINT_TRY(const auto linear, image::compareImages(second, first, "B", "A"));
    const auto exposure = static_cast<double>(exposure_);
    const double flip = image::flipMean(
        image::flipMap(image::displayedImage(second, exposure), image::displayedImage(first, exposure)));
    difference_ = fmt::format("FLIP {:.4f}, RMSE {:.3g}, most {:.3g} at {}, {}", flip, linear.rmse,
                              linear.absolute.value, linear.absolute.x, linear.absolute.y);
    return okStatus();
}

Status Window::writeReport(const std::string& file) {
    Side& one = side();
    base::Json settings = base::Json::object();
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        if ((row.commands & compiler::kOfRender) != 0) {
            settings[std::string(row.name)] = row.values.text(one.wanted);
        }
    }
    base::Json messages = base::Json::array();
    for (const Diagnostic& message : messages_) {
        messages.push_back(toString(message));
    }
    base::Json picked = nullptr;
    if (pick_) {
        picked = base::Json{{"x", pick_->x}, {"y", pick_->y}, {"fields", base::Json::object()}};
        for (const Field& field : pick_->fields) {
            picked["fields"][field.label] = field.text;
        }
    }
    base::Json passes = base::Json::object();
    for (std::size_t i = 0; i < one.history.names().size(); ++i) {
        passes[one.history.names()[i]] = one.history.median(i);
    }
    base::Json looks = base::Json::array();
    for (const Look& look : one.picture.isReady() ? looksOf(one.picture.build()) : std::vector<Look>()) {
        looks.push_back((look.view.empty() ? "layer " : "view ") + look.name());
    }
    const double samples = static_cast<double>(sampleTimes_.size());
    const double seconds = std::accumulate(sampleTimes_.begin(), sampleTimes_.end(), 0.0);
    const bool isReady = one.picture.isReady();
    const base::Json json{
        {"scene", scene_},
        {"camera", camera_.name()},
        {"exposure", exposure_},
        {"settings", settings},
        {"compares", sides_[1] != nullptr},
        {"shown", static_cast<std::uint32_t>(shown_)},
        {"difference", difference_},
        {"width", isReady ? one.picture.settings().renderer.width : 0},
        {"height", isReady ? one.picture.settings().renderer.height : 0},
        {"samples", isReady ? one.picture.samples() : 0},
        {"missingLevels", one.picture.missingLevels()},
        {"strategy", isReady ? std::string(package::nameOf(*one.picture.settings().strategy)) : ""},
        {"lastChange", one.picture.lastChange()},
        {"time", poses_ ? base::Json(time_) : base::Json(nullptr)},
        {"plays", plays_},
        {"flies", flies_},
        {"panel", showsPanel_},
        {"help", showsHelp_},
        {"frames", frames_},
        {"samplesDrawn", samples_},
        {"samplesPerSecond", seconds > 0.0 ? samples / seconds : 0.0},
        {"firstPictureMs", firstPictureMs_ ? base::Json(*firstPictureMs_) : base::Json(nullptr)},
        {"residentBytes", residentBytes()},
        {"rendererBytes", isReady ? one.picture.renderer().footprint().allocatedBytes : 0},
        {"sceneBytes", isReady ? one.picture.gpuScene().allocatedBytes() : 0},
        {"passes", passes},
        {"look", look_.name()},
        {"looks", looks},
        {"view", base::jsonOf(view_)},
        {"lookNote", lookNote_},
        {"pick", picked},
        {"error", error_ ? base::Json(toString(*error_)) : base::Json(nullptr)},
        {"messages", messages}};
    return base::writeFile(file, base::toText(json));
}

}  // namespace glint::view
