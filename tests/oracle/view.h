// Rays of a glTF camera.
#pragma once

#include "gltf/scene.h"
#include "oracle/world.h"

#include <cstdint>

namespace glint::oracle {

// A perspective camera: glTF 2.0, 3.10.3. The vertical field of view is the camera's, the width follows the
// image.
class View {
public:
    View(const Camera& camera, std::uint32_t width, std::uint32_t height);

    // Through a place of the image in pixels from the top left corner.
    Ray ray(double x, double y) const;
    std::uint32_t width() const {
        return width_;
    }
    std::uint32_t height() const {
        return height_;
    }

private:
    Vec3 origin_;
    Vec3 right_;  // on the plane at distance 1, from the middle to the right edge
    Vec3 up_;
    Vec3 forward_;
    std::uint32_t width_;
    std::uint32_t height_;
};

}  // namespace glint::oracle
