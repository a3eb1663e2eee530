#include "view/camera_control.h"

#include "base/vectors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace glint::view {

namespace {

constexpr double kMostPitch = 0.4999 * std::numbers::pi;  // straight up and down have no right side
constexpr double kLeastDistance = 1e-12;                  // metres; keeps the target apart from the camera

glm::dvec3 directionOf(double yaw, double pitch) {
    return {-std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch)};
}

glm::dvec3 rightOf(double yaw) {
    return {std::cos(yaw), 0.0, -std::sin(yaw)};
}

}  // namespace

void CameraControl::start(const CameraView& view, std::string name, double distance) {
    start_ = view;
    name_ = std::move(name);
    moved_ = false;
    position_ = view.position;
    const glm::dvec3 forward = base::toVector(view.forward);
    yaw_ = std::atan2(-forward.x, -forward.z);
    pitch_ = std::clamp(std::asin(std::clamp(forward.y, -1.0, 1.0)), -kMostPitch, kMostPitch);
    distance_ = std::max(distance, kLeastDistance);
    // An orthographic camera that moves becomes one in perspective, which shows as much at the target.
    const double halfHeight = view.orthographic ? view.halfHeight / distance_ : view.halfHeight;
    degrees_ = std::clamp(2.0 * std::atan(halfHeight) * 180.0 / std::numbers::pi, 1.0, 170.0);
    degrees_ = std::round(degrees_ * 1e4) / 1e4;
}

void CameraControl::turn(double right, double down) {
    yaw_ = std::remainder(yaw_ - right * std::numbers::pi, 2.0 * std::numbers::pi);
    pitch_ = std::clamp(pitch_ - down * std::numbers::pi, -kMostPitch, kMostPitch);
    moved_ = true;
}

void CameraControl::orbit(double right, double down) {
    const glm::dvec3 target = base::toVector(position_) + distance_ * directionOf(yaw_, pitch_);
    turn(right, down);
    position_ = base::toArray(target - distance_ * directionOf(yaw_, pitch_));
}

void CameraControl::look(double right, double down) {
    turn(right, down);
}

void CameraControl::pan(double right, double down) {
    const double height = 2.0 * distance_ * std::tan(degrees_ * std::numbers::pi / 360.0);
    const glm::dvec3 side = rightOf(yaw_);
    const glm::dvec3 up = glm::cross(side, directionOf(yaw_, pitch_));
    position_ = base::toArray(base::toVector(position_) + height * (down * up - right * side));
    moved_ = true;
}

void CameraControl::approach(double share) {
    const double distance = std::max(distance_ * (1.0 - share), kLeastDistance);
    position_ = base::toArray(base::toVector(position_) + (distance_ - distance) * directionOf(yaw_, pitch_));
    distance_ = distance;
    moved_ = true;
}

void CameraControl::fly(double right, double up, double forward, double seconds) {
    const double metres = speed_ * distance_ * seconds;
    position_ =
        base::toArray(base::toVector(position_) + metres * (right * rightOf(yaw_) + glm::dvec3{0.0, up, 0.0} +
                                                            forward * directionOf(yaw_, pitch_)));
    moved_ = true;
}

void CameraControl::changeSpeed(double factor) {
    speed_ = std::clamp(speed_ * factor, 1e-3, 1e3);
}

CameraView CameraControl::view(double aspect) const {
    if (moved_) {
        return session::viewOf(placed(), aspect);
    }
    CameraView view = start_;
    view.halfWidth = static_cast<float>(view.halfHeight * aspect);
    return view;
}

session::PlacedCamera CameraControl::placed() const {
    // A user reads and copies these numbers, so they are no longer than the view needs: a millionth of the
    // target's distance.
    const double unit = std::exp2(std::floor(std::log2(distance_)) - 20.0);
    const double scale = std::pow(10.0, -std::floor(std::log10(unit)));
    const auto rounded = [&](const glm::dvec3& place) {
        return base::toArray(glm::round(place * scale) / scale);
    };
    const glm::dvec3 position = base::toVector(position_);
    return {rounded(position), rounded(position + distance_ * directionOf(yaw_, pitch_)), degrees_};
}

std::string CameraControl::name() const {
    return moved_ ? session::toText(placed()) : name_;
}

}  // namespace glint::view
