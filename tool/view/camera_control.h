// Moves a camera by mouse and keys: it flies, or orbits a point.
#pragma once

#include <glint/scene_view.h>
#include <glint/session/camera.h>

#include <array>
#include <string>

namespace glint::view {

class CameraControl {
public:
    // Begins with a camera of the scene, or one that frames it. `name` is its name for --camera. `distance`
    // is that of the orbited point, in metres.
    void start(const CameraView& view, std::string name, double distance);

    // Turns around the target, by shares of the picture's height: half a turn for each.
    void orbit(double right, double down);
    // Turns around the camera's own position: the target moves.
    void look(double right, double down);
    // Moves camera and target in the plane of the picture. 1 is the picture's height at the target.
    void pan(double right, double down);
    // Goes towards the target, by a share of the remaining distance; below 0 away from it.
    void approach(double share);
    // Flies: `right`, `up` and `forward` are -1 to 1. The speed is `speed` times the target's distance a
    // second.
    void fly(double right, double up, double forward, double seconds);
    void changeSpeed(double factor);
    double speed() const {
        return speed_;
    }

    // Returns whether the camera has left the place where it started.
    bool moved() const {
        return moved_;
    }
    // The view for a picture of that width / height.
    CameraView view(double aspect) const;
    // Returns the value of --camera that shows the same.
    std::string name() const;
    // The camera that view() shows once it has moved.
    session::PlacedCamera placed() const;

private:
    void turn(double right, double down);

    CameraView start_;
    std::string name_;
    bool moved_ = false;
    std::array<double, 3> position_{};
    double yaw_ = 0.0;    // radians about +Y; 0 looks to -Z
    double pitch_ = 0.0;  // radians; above 0 looks up
    double distance_ = 1.0;
    double degrees_ = 30.0;
    double speed_ = 1.0;
};

}  // namespace glint::view
