#include "oracle/view.h"

namespace glint::oracle {
namespace {

Vec3 column(const gltf::Matrix4& m, std::size_t index) {
    return {m[4 * index], m[4 * index + 1], m[4 * index + 2]};
}

}  // namespace

View::View(const gltf::Camera& camera, std::uint32_t width, std::uint32_t height)
    : origin_(column(camera.world, 3)),
      right_(glm::normalize(column(camera.world, 0))),
      up_(glm::normalize(column(camera.world, 1))),
      forward_(-glm::normalize(column(camera.world, 2))),
      width_(width),
      height_(height) {
    const double half = std::tan(0.5 * camera.yfov);
    up_ *= half;
    right_ *= half * width / height;
}

View::View(const Ray& middle, const Vec3& right, const Vec3& up, bool parallel, double near,
           std::uint32_t width, std::uint32_t height)
    : origin_(middle.origin),
      right_(right),
      up_(up),
      forward_(middle.direction),
      parallel_(parallel),
      near_(near),
      width_(width),
      height_(height) {}

Ray View::ray(double x, double y) const {
    const double across = 2.0 * x / width_ - 1.0;
    const double upwards = 1.0 - 2.0 * y / height_;
    if (parallel_) {
        return {origin_ + across * right_ + upwards * up_ + near_ * forward_, forward_};
    }
    const Vec3 through = forward_ + across * right_ + upwards * up_;
    return {origin_ + near_ * through, glm::normalize(through)};
}

}  // namespace glint::oracle
