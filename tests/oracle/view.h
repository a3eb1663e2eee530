// The rays of a glTF camera.
#pragma once

#include "gltf/scene.h"
#include "oracle/world.h"

#include <cstdint>

namespace glint::oracle {

// Source: glTF 2.0, 3.10.3. A perspective camera keeps its vertical field of view; the width follows the
// image.
class View {
public:
    View(const gltf::Camera& camera, std::uint32_t width, std::uint32_t height);
    // Rays start at `near`, metres along the view. `right` and `up` go from the middle of the image to its
    // edges, on the plane at distance 1 or, if rays are parallel, in world units.
    View(const Ray& middle, const Vec3& right, const Vec3& up, bool parallel, double near,
         std::uint32_t width, std::uint32_t height);

    // Returns the ray through a place of the image, in pixels from the top left corner.
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
    bool parallel_ = false;
    double near_ = 0.0;
    std::uint32_t width_;
    std::uint32_t height_;
};

}  // namespace glint::oracle
