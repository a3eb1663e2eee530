// The camera, and the moment of animations that is shown.
#include "view/window/window.h"

#include <glint/session/camera.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glint::view {

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
    const auto moment = poses_ ? std::optional(session::Moment{animations_, time_}) : std::nullopt;
    for (std::unique_ptr<Side>& one : sides_) {
        if (!one || !one->picture.isReady() || one->picture.moment() == moment) {
            continue;
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
        if (!session::framesEverything(picture.scene(), sides_[0]->wanted.camera)) {
            cameraIsNew_ = true;
        }
    }
    return okStatus();
}

}  // namespace glint::view
