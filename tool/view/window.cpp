#include "view/window.h"

#include "image/tone.h"
#include "settings/table.h"

#include <glint/measure/observer.h>
#include <glint/measure/render_settings.h>
#include <glint/scene_view/camera.h>

#define GLFW_INCLUDE_NONE
#include <fmt/format.h>

#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <utility>

namespace glint::view {

namespace {

constexpr double kRestMs = 120.0;         // a size that stays this long is rendered
constexpr double kPollMs = 100.0;         // between two looks at the files
constexpr std::size_t kMessages = 200;    // that are kept
constexpr std::uint32_t kLeastSize = 16;  // pixels each way of a picture
constexpr double kLookMs = 100.0;         // between two views of a picture that is not complete

Window& windowOf(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

Diagnostic windowError(const std::string& message) {
    return makeError("window-open", "", message, "run this where there is a display, or use glint render");
}

}  // namespace

Window::Window(const Request& request) : request_(request), scene_(request.scene) {}

Window::~Window() {
    builder_.reset();
    for (const std::unique_ptr<Side>& one : sides_) {
        if (one) {
            one->picture.cancelLoad();
        }
    }
    if (context_) {
        vkDeviceWaitIdle(context_->handles().device);
        request_.closing(*context_);
    }
    script_.reset();
    for (std::unique_ptr<Side>& one : sides_) {
        one.reset();
    }
    display_.reset();
    interface_.reset();
    presenter_.reset();
    context_.reset();
    if (window_ != nullptr) {
        glfwDestroyWindow(window_);
    }
    glfwTerminate();
}

Status Window::openDevice() {
    HeadlessOptions options = measure::deviceOptions(request_.settings);
    std::uint32_t count = 0;
    const char** const extensions = glfwGetRequiredInstanceExtensions(&count);
    if (extensions == nullptr) {
        return windowError("there is no Vulkan driver that shows pictures in windows");
    }
    options.instanceExtensions.assign(extensions, extensions + count);
    options.deviceExtensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    // What packages may need is there from the start, where the device has it.
    const HeadlessOptions asked = options;
    std::optional<Result<std::unique_ptr<Context>>> made;
    constexpr unsigned kClock = 1;
    constexpr unsigned kHalf = 2;
    constexpr unsigned kFetch = 4;
    constexpr unsigned kEverything = 7;
    for (unsigned tried :
         {kEverything, kHalf | kClock, kFetch | kClock, kFetch | kHalf, kClock, kHalf, kFetch}) {
        // The validation layers of Debian 12 don't know position fetch.
        tried &= asked.validation == Validation::Off ? kEverything : ~kFetch;
        options.positionFetch = asked.positionFetch || (tried & kFetch) != 0;
        options.shaderFloat16 = asked.shaderFloat16 || (tried & kHalf) != 0;
        options.shaderClock = asked.shaderClock || (tried & kClock) != 0;
        made = Context::createHeadless(options);
        if (*made || made->error().id != "device-features") {
            break;
        }
    }
    if (!*made && made->error().id == "device-features") {
        made = Context::createHeadless(asked);
    }
    if (!*made) {
        return made->error();
    }
    context_ = std::move(**made);
    request_.opened(*context_);
    return okStatus();
}

Status Window::open() {
    glfwInitHint(GLFW_JOYSTICK_HAT_BUTTONS, GLFW_FALSE);
    if (glfwInit() == GLFW_FALSE) {
        const char* text = nullptr;
        glfwGetError(&text);
        return windowError(text != nullptr ? fmt::format("no window can be opened ({})", text)
                                           : std::string("no window can be opened"));
    }
    if (Status opened = openDevice(); !opened) {
        return opened;
    }
    showsPanel_ = request_.showsPanel;
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    const int panel = showsPanel_ ? static_cast<int>(kPanelWidth) : 0;
    window_ = glfwCreateWindow(
        static_cast<int>(request_.settings.renderer.width) + panel,
        static_cast<int>(request_.settings.renderer.height) + static_cast<int>(kStatusHeight),
        ("glint view: " + scene_).c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
        return windowError("the window could not be opened");
    }
    glfwSetWindowUserPointer(window_, this);
    // Dear ImGui's callbacks, which are set later, call these.
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int modifiers) {
        windowOf(window).onKey(key, action, modifiers);
    });
    glfwSetScrollCallback(window_,
                          [](GLFWwindow* window, double, double y) { windowOf(window).onScroll(y); });
    glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned) { windowOf(window).onChange(false); });
    glfwSetMouseButtonCallback(window_,
                               [](GLFWwindow* window, int, int, int) { windowOf(window).onChange(false); });
    glfwSetCursorPosCallback(window_,
                             [](GLFWwindow* window, double, double) { windowOf(window).onChange(false); });
    glfwSetFramebufferSizeCallback(window_,
                                   [](GLFWwindow* window, int, int) { windowOf(window).onChange(true); });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) { windowOf(window).onChange(false); });
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** files) {
        for (int i = 0; i < count; ++i) {
            windowOf(window).onDrop(files[i]);
        }
    });
    Result<std::unique_ptr<Presenter>> presenter = Presenter::create(*context_, window_);
    if (!presenter) {
        return presenter.error();
    }
    presenter_ = std::move(*presenter);
    Result<std::unique_ptr<Interface>> interface = Interface::create(*context_, window_, *presenter_);
    if (!interface) {
        return interface.error();
    }
    interface_ = std::move(*interface);
    Result<std::unique_ptr<Display>> display = Display::create(*context_);
    if (!display) {
        return display.error();
    }
    display_ = std::move(*display);
    builder_ = std::make_unique<Builder>(request_, *context_);
    sides_[0] = std::make_unique<Side>(*context_);
    side().wanted = request_.settings;
    autoExposure_ = request_.exposure == "auto";
    if (!autoExposure_) {
        double stops = 0.0;
        compiler::parseReal(request_.exposure, -32.0, 32.0, stops);
        exposure_ = static_cast<float>(stops);
    }
    if (!request_.time.empty()) {
        poses_ = true;
        compiler::parseReal(request_.time, 0.0, 1e6, time_);
    }
    plays_ = request_.plays;
    poses_ = poses_ || plays_;
    order(0);
    if (!request_.script.empty()) {
        const ScriptHost host{window_,
                              &controls_,
                              [this] { return isComplete() && hasWantedSize(); },
                              [this] { return error_.has_value(); },
                              [this](const std::string& file) { onDrop(file); },
                              [this](const std::string& file) { return writeReport(file); },
                              [this] { return frames_; },
                              [this](const std::string& text) { request_.observer->detail(text); }};
        Result<std::unique_ptr<Script>> script = Script::read(request_.script, host);
        if (!script) {
            return script.error();
        }
        script_ = std::move(*script);
        glfwFocusWindow(window_);
    }
    return okStatus();
}

void Window::onChange(bool size) {
    wakes_ = 4;
    if (size) {
        presenter_->sizeChanged();
        resized_ = base::Clock::now();
    }
}

void Window::report(const Diagnostic& message) {
    request_.observer->report(message);
    messages_.push_back(message);
    ++unread_;
    if (messages_.size() > kMessages) {
        messages_.pop_front();
    }
    wakes_ = 4;
}

void Window::fail(const Diagnostic& error) {
    error_ = error;
    report(error);
    status_ = "failed, the picture stays as it was";
}

void Window::say(const std::string& text) {
    status_ = text;
    request_.observer->detail(text);
    wakes_ = 4;
}

void Window::order(std::size_t index, std::span<const std::string> changed) {
    Side& one = *sides_[index];
    one.ordered = one.wanted;
    BuildOrder order{index, one.wanted, scene_, {changed.begin(), changed.end()}};
    // As on the command line: textures may hold anything where a fallback or a host stands by.
    order.settings.compile.trustTextures = one.wanted.compile.trustTextures &&
                                           !one.wanted.compile.plan.fallback &&
                                           one.wanted.compile.host.empty();
    builder_->start(std::move(order));
}

bool Window::isComplete() const {
    for (std::size_t i = 0; i < kPictures; ++i) {
        if (sides_[i] && (builder_->isBusy(i) || sides_[i]->loading != nullptr ||
                          (sides_[i]->picture.isReady() && !sides_[i]->picture.isComplete()))) {
            return false;
        }
    }
    const bool isSettled = base::millisecondsSince(resized_) > 2.0 * kRestMs;
    return (sides_[0]->picture.isReady() || error_) && isSettled && !wantsShot_ && !exposureIsNew_ &&
           isLookCurrent();
}

// A size that the panel asks for is there once the window has it.
bool Window::hasWantedSize() const {
    const Side& one = *sides_[0];
    return !one.picture.isReady() || (one.wanted.renderer.width == one.picture.settings().renderer.width &&
                                      one.wanted.renderer.height == one.picture.settings().renderer.height);
}

bool Window::isIdle() const {
    return isComplete() && !plays_ && wakes_ <= 0;
}

CameraView Window::cameraView() const {
    const Picture& picture = sides_[0]->picture;
    return camera_.view(static_cast<double>(picture.settings().renderer.width) /
                        picture.settings().renderer.height);
}

Status Window::run() {
    while (glfwWindowShouldClose(window_) == GLFW_FALSE) {
        if (isIdle() && !script_) {
            glfwWaitEventsTimeout(kPollMs / 1000.0);
        } else {
            glfwPollEvents();
        }
        if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE) {
            glfwWaitEventsTimeout(kPollMs / 1000.0);
            ++frames_;
        } else if (!isIdle() || script_) {
            if (Status drawn = frame(); !drawn) {
                return drawn;
            }
        }
        pollFiles();
        if (Status taken = takeBuilds(); !taken) {
            return taken;
        }
        if (script_) {
            if (Status stepped = script_->step(); !stepped) {
                return stepped;
            }
            if (script_->isDone()) {
                script_.reset();
            }
        }
        const std::vector<std::string> validation = context_->validationMessages();
        for (; validationSeen_ < validation.size(); ++validationSeen_) {
            messages_.push_back(makeWarning("validation", "", validation[validationSeen_]));
            ++unread_;
        }
    }
    if (Status waited = presenter_->waitForFrames(); !waited) {
        return waited;
    }
    return measure::checkValidation(*request_.observer, *context_);
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
    const std::vector<std::string> changed = watch_.changed();
    if (!changed.empty()) {
        say(changed.front() + " has changed");
        for (std::size_t i = 0; i < kPictures; ++i) {
            if (sides_[i]) {
                order(i, changed);
            }
        }
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
            if (const std::optional<Build> early = builder_->pollEarly(i); early && sides_[i]) {
                finishSamples();
                if (sides_[i]->picture.showEarly(*early)) {
                    ++earlyPackages_;
                    say("the edit is shown as a draft");
                }
            }
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
        if (!sides_[0]->picture.isReady() && !script_) {
            // Nothing is shown yet, and nobody can correct it here.
            return installed;
        }
        sides_[i]->picture.takeBackEarly();
        keepScene();
        fail(installed.error());
    }
    return okStatus();
}

Status Window::install(std::size_t index, Build build) {
    Side& one = *sides_[index];
    if (!one.picture.hasLoaded()) {
        if (Status waited = presenter_->waitForFrames(); !waited) {
            return waited;
        }
    }
    finishSamples();
    const bool isOtherScene =
        index == 0 && (!one.picture.isReady() || one.picture.build().scene->path != build.scene->path);
    const bool isUploaded = !one.picture.isReady() || one.picture.build().scene != build.scene;
    const double buildMs = build.readMs + build.compileMs + build.texturesMs;
    const int compiled = build.modulesCompiled;
    std::vector<std::string> inputs = build.inputs;
    std::vector<Diagnostic> notes;
    const auto width = std::max(static_cast<std::uint32_t>(area_.width / divisor_), kLeastSize);
    const auto height = std::max(static_cast<std::uint32_t>(area_.height / divisor_), kLeastSize);
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
    if (Status followed = followSettings(index); !followed) {
        return followed;
    }
    return applyPose();
}

// Gives the picture what has changed of its settings, apart from what needs another build.
Status Window::followSettings(std::size_t index) {
    Side& one = *sides_[index];
    if (!one.picture.isReady()) {
        return okStatus();
    }
    compiler::Settings next = one.wanted;
    // Until the other build is there, the picture keeps what only that build has.
    if (changeBetween(one.ordered, one.wanted) == Change::Build) {
        order(index);
    }
    if (changeBetween(one.picture.build().settings, next) == Change::Build) {
        const compiler::Settings built = one.picture.settings();
        for (const compiler::Descriptor& row : compiler::settingsTable()) {
            compiler::Settings probe = built;
            if ((row.commands & compiler::kOfRender) != 0) {
                row.values.set(probe, row.values.text(next));
                if (changeBetween(built, probe) == Change::Build) {
                    row.values.set(next, row.values.text(built));
                }
            }
        }
        next.environment = built.environment;
        next.package = built.package;
    }
    next.strategy = one.picture.build().settings.strategy;
    next.compile.strategyChoice = one.picture.build().settings.compile.strategyChoice;
    const auto width = std::max(static_cast<std::uint32_t>(area_.width / divisor_), kLeastSize);
    const auto height = std::max(static_cast<std::uint32_t>(area_.height / divisor_), kLeastSize);
    next.renderer.width = width;
    next.renderer.height = height;
    const Change change = changeBetween(one.picture.settings(), next);
    if (change == Change::None) {
        return okStatus();
    }
    if (!builder_->isBusy(index) && !one.buildFailed) {
        error_.reset();
    }
    if (change != Change::Frame) {
        if (Status waited = presenter_->waitForFrames(); !waited) {
            return waited;
        }
        finishSamples();
        one.history.clear();
    }
    if (Status changed = one.picture.change(next, width, height); !changed) {
        fail(changed.error());
    }
    wakes_ = 4;
    return okStatus();
}

// Makes the picture as large as its part of the window, once the window keeps its size.
Status Window::fitSize() {
    if (area_.width <= 0 || area_.height <= 0) {
        return okStatus();
    }
    const auto width = std::max(static_cast<std::uint32_t>(area_.width / divisor_), kLeastSize);
    const auto height = std::max(static_cast<std::uint32_t>(area_.height / divisor_), kLeastSize);
    if (display_->image().width == width && display_->image().height == height) {
        return okStatus();
    }
    if (base::millisecondsSince(resized_) < kRestMs && display_->image().width > 0) {
        return okStatus();
    }
    if (Status waited = presenter_->waitForFrames(); !waited) {
        return waited;
    }
    if (Result<bool> resized = display_->resize(width, height); !resized) {
        return resized.error();
    }
    pick_.reset();
    for (std::size_t i = 0; i < kPictures; ++i) {
        if (sides_[i]) {
            sides_[i]->wanted.renderer.width = width;
            sides_[i]->wanted.renderer.height = height;
            if (Status followed = followSettings(i); !followed) {
                return followed;
            }
        }
    }
    cameraIsNew_ = cameraIsNew_ || !camera_.moved();
    return okStatus();
}

// Returns how far ahead of a camera the point is that it orbits, in metres.
double Window::distanceToMiddle(const CameraView& view) const {
    const Picture& picture = sides_[0]->picture;
    if (const std::optional<scene_view::PlacedCamera> placed =
            scene_view::parsePlacedCamera(sides_[0]->wanted.camera)) {
        return std::hypot(placed->target[0] - placed->position[0], placed->target[1] - placed->position[1],
                          placed->target[2] - placed->position[2]);
    }
    const scene_view::Bounds bounds = scene_view::posedBounds(picture.scene(), picture.data());
    double distance = 0.0;
    double size = 0.0;
    for (std::size_t i = 0; i < 3 && !bounds.empty(); ++i) {
        distance += (0.5 * (bounds.min[i] + bounds.max[i]) - view.position[i]) * view.forward[i];
        size = std::max(size, bounds.max[i] - bounds.min[i]);
    }
    // Inside a scene, its middle may be behind the camera.
    constexpr double kNearest = 0.02;
    constexpr double kInside = 0.25;
    distance = distance < kNearest * size ? kInside * size : distance;
    return distance > 0.0 ? distance : 1.0;
}

void Window::startCamera() {
    Side& one = *sides_[0];
    if (!one.picture.isReady()) {
        return;
    }
    cameraIsNew_ = false;
    const compiler::Settings& settings = one.picture.settings();
    const double aspect = static_cast<double>(settings.renderer.width) / settings.renderer.height;
    const Result<scene_view::CameraChoice> choice =
        scene_view::chooseCamera(one.picture.scene(), one.picture.data(), one.wanted.camera, aspect);
    if (!choice) {
        report(choice.error());
        one.wanted.camera = "auto";
        cameraIsNew_ = true;
        return;
    }
    if (orbitDistance_ <= 0.0) {
        orbitDistance_ = distanceToMiddle(choice->view);
    }
    camera_.start(choice->view, one.wanted.camera, orbitDistance_);
    for (std::unique_ptr<Side>& each : sides_) {
        if (each) {
            each->picture.restart();
        }
    }
}

void Window::animate(double seconds) {
    if (!plays_ || !sides_[0]->picture.isReady()) {
        return;
    }
    double duration = 0.0;
    const auto& animations = sides_[0]->picture.scene().animations;
    for (const std::size_t index : animations_) {
        duration = std::max(duration, animations[index].duration);
    }
    time_ += seconds * playSpeed_;
    if (duration > 0.0) {
        time_ = std::fmod(time_, duration);
    }
}

Status Window::applyPose() {
    if (!sides_[0]->picture.isReady()) {
        return okStatus();
    }
    const std::size_t count = sides_[0]->picture.scene().animations.size();
    animations_.clear();
    if (animationChoice_ >= static_cast<int>(count)) {
        animations_.resize(count);
        std::iota(animations_.begin(), animations_.end(), std::size_t{0});
    } else {
        animations_.push_back(static_cast<std::size_t>(animationChoice_));
    }
    const std::optional<Moment> moment = poses_ ? std::optional(Moment{animations_, time_}) : std::nullopt;
    for (std::unique_ptr<Side>& one : sides_) {
        if (!one || !one->picture.isReady() || one->picture.moment() == moment) {
            continue;
        }
        // Poses are written to memory that frames in flight read.
        if (Status waited = presenter_->waitForFrames(); !waited) {
            return waited;
        }
        finishSamples();
        if (Status posed = one->picture.pose(moment, presenter_->submitted() + 1); !posed) {
            report(posed.error());
            plays_ = false;
            poses_ = false;
        }
    }
    if (!camera_.moved() && poses_) {
        // A camera of the scene may move, too.
        const Picture& picture = sides_[0]->picture;
        if (!scene_view::framesEverything(picture.scene(), sides_[0]->wanted.camera)) {
            cameraIsNew_ = true;
        }
    }
    return okStatus();
}

// Reads times and counts of samples that the device has completed.
void Window::finishSamples() {
    for (std::unique_ptr<Side>& one : sides_) {
        if (!one || !one->picture.isReady()) {
            continue;
        }
        one->picture.completed(presenter_->completed());
        if (one->picture.takeAllLevels(presenter_->completed())) {
            request_.observer->detail(fmt::format("all levels of the textures {:.0f} ms after the start",
                                                  base::millisecondsSince(start_)));
        }
        const std::uint64_t recorded = one->picture.recordedIn();
        if (recorded == 0 || recorded == one->timedFrame || recorded > presenter_->completed()) {
            continue;
        }
        one->timedFrame = recorded;
        if (const Result<FrameCounters> counters = one->picture.renderer().counters(); counters) {
            one->counters = *counters;
        }
        if (const Result<std::vector<PassTiming>> passes = one->picture.renderer().timings(); passes) {
            // Rounds of rays are parts of the frame's own time, and would count twice.
            std::vector<PassTiming> kept;
            std::ranges::copy_if(*passes, std::back_inserter(kept),
                                 [](const PassTiming& pass) { return pass.pass != Pass::Hits; });
            one->history.add(kept);
        }
        if (!firstPictureMs_) {
            firstPictureMs_ = base::millisecondsSince(start_);
            request_.observer->detail(
                fmt::format("first sample {:.0f} ms after the start", *firstPictureMs_));
        }
    }
}

Status Window::frame() {
    const double seconds = std::min(base::millisecondsSince(lastFrame_) / 1000.0, 0.25);
    lastFrame_ = base::Clock::now();
    Presenter::Frame frame;
    const Result<bool> begun = presenter_->begin(frame);
    if (!begun || !*begun) {
        ++frames_;
        return begun ? okStatus() : Status(begun.error());
    }
    finishSamples();
    --wakes_;
    interface_->begin();
    controls_.beginFrame();
    handleInput(seconds);
    drawInterface();
    interface_->end();
    animate(seconds);
    for (const Status& status : {fitSize(), applyPose()}) {
        if (!status) {
            return status;
        }
    }
    if (cameraIsNew_) {
        startCamera();
    }
    ++frames_;
    return drawFrame(frame);
}

bool Window::isLookCurrent() const {
    const Picture& picture = sides_[edited_]->picture;
    return look_.isPicture() || !picture.isReady() || picture.samples() == 0 ||
           (viewedFrame_ == picture.recordedIn() && viewedSide_ == edited_ && viewedLook_ == look_ &&
            viewedExposure_ == exposure_);
}

// Makes the view or layer that is shown follow the picture's last sample.
Status Window::followLook() {
    if (isLookCurrent()) {
        return okStatus();
    }
    Picture& picture = side().picture;
    const bool isFirst = !view_ || viewedLook_ != look_ || viewedSide_ != edited_;
    if (!isFirst && !picture.isComplete() && base::millisecondsSince(viewed_) < kLookMs) {
        return okStatus();
    }
    if (Status waited = presenter_->waitForFrames(); !waited) {
        return waited;
    }
    finishSamples();
    Result<measure::View> made = makeLook(look_, picture, static_cast<double>(exposure_));
    viewedLook_ = look_;
    viewedSide_ = edited_;
    viewedFrame_ = picture.recordedIn();
    viewedExposure_ = exposure_;
    viewed_ = base::Clock::now();
    wakes_ = std::max(wakes_, 2);
    if (!made) {
        view_.reset();
        lookNote_ = toString(made.error());
        return okStatus();
    }
    lookNote_.clear();
    view_ = std::move(*made);
    return display_->keep(view_->picture);
}

Status Window::drawFrame(const Presenter::Frame& frame) {
    if (Status followed = followLook(); !followed) {
        return followed;
    }
    bool sampled = false;
    if (measuresPasses_ && !isComplete()) {
        if (Status waited = presenter_->waitForFrames(); !waited) {
            return waited;
        }
        finishSamples();
    }
    for (std::unique_ptr<Side>& one : sides_) {
        if (!one || !one->picture.isReady() || one->picture.isComplete()) {
            continue;
        }
        const Timing timing = measuresPasses_ ? Timing::Passes : Timing::Frame;
        const Status recorded =
            one->picture.record(frame.commands, cameraView(), timing, presenter_->submitted() + 1);
        if (!recorded) {
            fail(recorded.error());
            one->picture.skip();
            continue;
        }
        sampled = true;
        ++samples_;
    }
    Presenter::Area area;
    if (!look_.isPicture() && view_ && display_->recordCopy(frame.commands)) {
        area = area_;
    } else if (sides_[0]->picture.isReady() && display_->image().width > 0 &&
               sides_[0]->picture.renderer().recordings() > 0) {
        const bool hasSecond =
            sides_[1] && sides_[1]->picture.isReady() && sides_[1]->picture.renderer().recordings() > 0;
        DisplayOptions options;
        options.scale = std::exp2(exposure_);
        options.shown = hasSecond ? shown_ : Shown::First;
        options.border = border_;
        options.gain = gain_;
        display_->record(frame.commands, sides_[0]->picture.renderer().outputView(),
                         hasSecond ? sides_[1]->picture.renderer().outputView() : VK_NULL_HANDLE, options);
        area = area_;
    }
    presenter_->beginDrawing(frame, area.width > 0 ? &display_->image() : nullptr, area);
    interface_->record(frame.commands);
    if (Status ended = presenter_->end(frame); !ended) {
        return ended;
    }
    if (sampled) {
        sampleTimes_.push_back(base::millisecondsSince(lastSample_) / 1000.0);
        lastSample_ = base::Clock::now();
        if (sampleTimes_.size() > 32) {
            sampleTimes_.pop_front();
        }
        wakes_ = std::max(wakes_, 2);
    }
    const bool complete = sides_[0]->picture.isReady() && sides_[0]->picture.isComplete();
    const bool isNew = complete && !wasComplete_;
    wasComplete_ = complete;
    if (autoExposure_ && sides_[0]->picture.isReady() && (isNew || exposureIsNew_)) {
        measureExposure();
    }
    if (wantsShot_ && complete && isLookCurrent()) {
        saveScreenshot();
    }
    return okStatus();
}

Status showWindow(const Request& request) {
    Window window(request);
    if (Status opened = window.open(); !opened) {
        return opened;
    }
    return window.run();
}

}  // namespace glint::view
