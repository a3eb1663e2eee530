#include "oracle/view.h"

namespace glint::oracle {
namespace {

Vec3 column(const Matrix4& m, std::size_t index) {
    return {m[4 * index], m[4 * index + 1], m[4 * index + 2]};
}

}  // namespace

View::View(const Camera& camera, std::uint32_t width, std::uint32_t height)
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

Ray View::ray(double x, double y) const {
    const double across = 2.0 * x / width_ - 1.0;
    const double upwards = 1.0 - 2.0 * y / height_;
    return {origin_, glm::normalize(forward_ + across * right_ + upwards * up_)};
}

}  // namespace glint::oracle
