// Frames of the window: samples of its pictures, and the image that is shown.
#include "view/window/window.h"

#include <glint/session/camera.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace glint::view {

// --- The camera, and the moment of animations that is shown ---

CameraView Window::cameraView() const {
    const Picture& picture = sides_[0]->picture;
    return camera_.view(static_cast<double>(picture.settings().renderer.width) /
                        picture.settings().renderer.height);
}

// Returns the distance of a camera from the point that it orbits, in metres.
double Window::distanceToMiddle(const CameraView& view) const {
    const Picture& picture = sides_[0]->picture;
    if (const std::optional<session::PlacedCamera> placed =
            session::parsePlacedCamera(sides_[0]->wanted.camera)) {
        return std::hypot(placed->target[0] - placed->position[0], placed->target[1] - placed->position[1],
                          placed->target[2] - placed->position[2]);
    }
    const session::Bounds bounds = session::posedBounds(picture.scene(), picture.data());
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
    const Result<session::CameraChoice> choice =
        session::chooseCamera(one.picture.scene(), one.picture.data(), one.wanted.camera, aspect);
    if (!choice) {
        report(choice.error());
        one.wanted.camera = "auto";
        cameraIsNew_ = true;
        return;
    }
    if (const std::optional<Diagnostic> warning =
            session::nothingSeen(one.picture.scene(), one.picture.data(), *choice)) {
        report(*warning);
    }
    if (orbitDistance_ <= 0.0) {
        orbitDistance_ = distanceToMiddle(choice->view);
    }
    camera_.start(choice->view, one.wanted.camera, orbitDistance_);
    restartPictures();
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
        const std::vector<std::size_t>& added = sides_[0]->picture.addedAnimations();
        animations_.insert(animations_.end(), added.begin(), added.end());
    }
    const auto moment = poses_ ? std::optional(session::Moment{animations_, time_}) : std::nullopt;
    bool isNew = false;
    for (std::unique_ptr<Side>& one : sides_) {
        if (!one || !one->picture.isReady() || one->picture.moment() == moment) {
            continue;
        }
        isNew = true;
        finishSamples();
        if (Status posed = one->picture.pose(moment, presenter_->submitted() + 1); !posed) {
            report(posed.error());
            plays_ = false;
            poses_ = false;
        }
    }
    if (isNew && !camera_.moved()) {
        // A camera of the scene may move, too.
        const Picture& picture = sides_[0]->picture;
        if (!session::framesEverything(picture.scene(), sides_[0]->wanted.camera)) {
            cameraIsNew_ = true;
        }
    }
    return okStatus();
}

// --- Frames ---

namespace {

constexpr double kRestMs = 120.0;         // a size that stays this long is rendered
constexpr std::uint32_t kLeastSize = 16;  // pixels each way of a picture
constexpr double kLookMs = 100.0;         // between two views of a picture that is not complete

}  // namespace

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

// A size that the panel requests is reached once the window has it.
bool Window::hasWantedSize() const {
    const Side& one = *sides_[0];
    return !one.picture.isReady() || (one.wanted.renderer.width == one.picture.settings().renderer.width &&
                                      one.wanted.renderer.height == one.picture.settings().renderer.height);
}

bool Window::isIdle() const {
    return isComplete() && !plays_ && wakes_ <= 0;
}

// Returns the width and height that pictures have in the present window.
std::array<std::uint32_t, 2> Window::pictureExtent() const {
    return {std::max(static_cast<std::uint32_t>(area_.width / divisor_), kLeastSize),
            std::max(static_cast<std::uint32_t>(area_.height / divisor_), kLeastSize)};
}

// Makes the picture as large as its part of the window, once the window keeps its size.
Status Window::fitSize() {
    if (area_.width <= 0 || area_.height <= 0) {
        return okStatus();
    }
    const auto [width, height] = pictureExtent();
    if (display_->image().width == width && display_->image().height == height) {
        return okStatus();
    }
    if (base::millisecondsSince(resized_) < kRestMs && display_->image().width > 0) {
        return okStatus();
    }
    GLINT_TRY_DO(presenter_->waitForFrames());
    GLINT_TRY([[maybe_unused]] const auto resized, display_->resize(width, height));
    pick_.reset();
    for (std::size_t i = 0; i < kPictures; ++i) {
        if (sides_[i]) {
            sides_[i]->wanted.renderer.width = width;
            sides_[i]->wanted.renderer.height = height;
            GLINT_TRY_DO(followSettings(i));
        }
    }
    cameraIsNew_ = cameraIsNew_ || !camera_.moved();
    return okStatus();
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
    GLINT_TRY_DO(fitSize());
    GLINT_TRY_DO(applyPose());
    if (cameraIsNew_) {
        startCamera();
    }
    ++frames_;
    return drawFrame(frame);
}

Status Window::drawFrame(const Presenter::Frame& frame) {
    GLINT_TRY_DO(followLook());
    bool sampled = false;
    if (measuresPasses_ && !isComplete()) {
        GLINT_TRY_DO(presenter_->waitForFrames());
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
    GLINT_TRY_DO(presenter_->end(frame));
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
        reportErrorOf(measureExposure());
    }
    if (wantsShot_ && complete && isLookCurrent()) {
        reportErrorOf(saveScreenshot());
    }
    return okStatus();
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
    GLINT_TRY_DO(presenter_->waitForFrames());
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
        if (const Result<Renderer::Counters> counters = one->picture.renderer().counters(); counters) {
            one->counters = *counters;
        }
        if (const Result<std::vector<PassTiming>> passes = one->picture.renderer().timings(); passes) {
            // Rounds of rays are parts of the frame's own time and would be counted twice.
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

}  // namespace glint::view
