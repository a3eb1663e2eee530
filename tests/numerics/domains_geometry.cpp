#include "domains.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace glint::numerics {
namespace {

// The plane through the origin that is perpendicular to a unit vector.
class Plane {
public:
    explicit Plane(const Vector& n) {
        // It starts from the axis along which n is smallest.
        const double least = std::min({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
        u_ = std::abs(n.x) == least   ? Vector{0.0, n.z, -n.y}
             : std::abs(n.y) == least ? Vector{-n.z, 0.0, n.x}
                                      : Vector{n.y, -n.x, 0.0};
        const double length = std::hypot(u_.x, u_.y, u_.z);
        u_ = {u_.x / length, u_.y / length, u_.z / length};
        v_ = {n.y * u_.z - n.z * u_.y, n.z * u_.x - n.x * u_.z, n.x * u_.y - n.y * u_.x};
    }
    Vector at(double u, double v) const {
        return {u * u_.x + v * v_.x, u * u_.y + v * v_.y, u * u_.z + v * v_.z};
    }

private:
    Vector u_;
    Vector v_;
};

}  // namespace

void fillDirection(InputSource& in) {
    in.put(in.direction());
}

// Writes a direction and a normal. Half of the directions are near the plane of the normal, on both sides.
void fillDirectionAndSide(InputSource& in) {
    const Vector side = in.direction();
    if (in.chance(0.5)) {
        in.put(in.direction());
    } else {
        const double height = in.chance(0.1) ? 0.0 : in.pick({-1.0, 1.0}) * in.logUniform(1e-9, 1e-2);
        const double turn = in.uniform(0.0, 2.0 * std::numbers::pi);
        const double flat = std::sqrt(1.0 - height * height);
        const Vector along = Plane(side).at(flat * std::cos(turn), flat * std::sin(turn));
        in.put({along.x + height * side.x, along.y + height * side.y, along.z + height * side.z});
    }
    in.put(side);
}

void fillTransform(InputSource& in) {
    for (int k = 0; k < 15; ++k) {
        in.put(in.coordinate());
    }
}

// Writes a kind of bins and a direction: any direction, one on an edge of the octahedral map's cells,
// including seams, or one with a component of 0.
void fillBinnedDirection(InputSource& in) {
    in.put(in.pick({0.0, 1.0, 2.0}));
    const double kind = in.uniform();
    if (kind < 0.4) {
        in.put(in.direction());
        return;
    }
    if (kind < 0.5) {
        const double turn = in.uniform(0.0, 2.0 * std::numbers::pi);
        const double c = std::cos(turn);
        const double s = std::sin(turn);
        const double flat = in.pick({0.0, -0.0, 1e-40, -1e-40});
        const double axis = in.pick({0.0, 1.0, 2.0});
        in.put(axis == 0.0 ? Vector{flat, c, s} : axis == 1.0 ? Vector{c, flat, s} : Vector{c, s, flat});
        return;
    }
    const double off = in.chance(0.1) ? 0.0 : in.pick({-1.0, 1.0}) * in.logUniform(1e-9, 1e-2);
    const double edge = 0.25 * std::floor(in.uniform(-4.0, 5.0));
    double x = std::clamp(edge + off, -1.0, 1.0);
    double y = in.chance(0.1) ? 0.25 * std::floor(in.uniform(-4.0, 5.0)) : in.uniform(-1.0, 1.0);
    if (in.chance(0.5)) {
        std::swap(x, y);
    }
    const double z = 1.0 - std::abs(x) - std::abs(y);
    const double fold = std::max(-z, 0.0);
    x -= std::copysign(fold, x);
    y -= std::copysign(fold, y);
    const double length = std::hypot(x, y, z);
    in.put({x / length, y / length, z / length});
}

// Writes a ray from a visible point, in clip space of a perspective or orthographic camera, and a share of
// its line. The point is up to 1e9 times as far away as the near plane: from there w cancels to nothing where
// the ray comes back to the plane.
void fillScreenRay(InputSource& in) {
    const double nearest = in.logUniform(1e-3, 1.0);
    const bool orthographic = in.chance(0.2);
    const double farthest = nearest * in.logUniform(10.0, 1e9);
    const bool infinite = !orthographic && in.chance(0.5);
    const double along = in.chance(0.1) ? nearest : nearest * in.logUniform(1.0, farthest / nearest);
    // Depth is reversed, and linear in the distance along the view: 1 at the near plane and 0 at the far one,
    // times w.
    const double range = farthest - nearest;
    const double slope = infinite ? 0.0 : (orthographic ? -1.0 : -nearest) / range;
    const double constant = infinite ? nearest : (orthographic ? farthest : nearest * farthest) / range;
    const double w = orthographic ? 1.0 : along;
    const auto place = [&] {
        // Some points are on the border of the image, or off it by a rounding error.
        return w * (in.chance(0.1) ? in.pick({0.0, 1.0, -1.0, 1.0 + 0x1p-23}) : in.uniform(-1.0, 1.0));
    };
    const double x = place();
    const double y = place();
    for (const double coordinate : {x, y, constant + slope * along, w}) {
        in.put(coordinate);
    }

    const double focal = in.logUniform(0.1, 10.0);
    const double aspect = in.logUniform(0.3, 3.0);
    Vector view = in.direction();
    if (in.chance(0.2)) {
        // A point of the screen, on the line through the eye.
        const double sign = in.pick({-1.0, 1.0});
        view = orthographic ? Vector{0.0, 0.0, sign}
                            : Vector{sign * x / focal, sign * y / (focal * aspect), sign * w};
        const double length = std::hypot(view.x, view.y, view.z);
        view = {view.x / length, view.y / length, view.z / length};
    }
    for (const double coordinate :
         {view.x * focal, view.y * focal * aspect, slope * view.z, orthographic ? 0.0 : view.z}) {
        in.put(coordinate);
    }
    in.put(std::floor(in.logUniform(1.0, 16384.0)));
    in.put(std::floor(in.logUniform(1.0, 16384.0)));
    in.put(in.sample());
}

void fillCounters(InputSource& in) {
    for (int k = 0; k < 5; ++k) {
        in.put(std::floor(in.uniform(0.0, 65536.0)));
    }
}

// The sum cancels except for the rounding of one factor.
void fillSumOfProduct(InputSource& in) {
    const auto b = static_cast<float>(in.uniform(-2.0, 2.0));
    const auto c = static_cast<float>(in.uniform(-2.0, 2.0));
    in.put(in.chance(0.5) ? -static_cast<double>(b) * c : in.uniform(-4.0, 4.0));
    in.put(b);
    in.put(c);
}

void fillProducts(InputSource& in) {
    const auto a = static_cast<float>(in.uniform(-2.0, 2.0));
    const auto b = static_cast<float>(in.uniform(-2.0, 2.0));
    const auto c = static_cast<float>(in.uniform(0.1, 2.0));
    in.put(a);
    in.put(b);
    in.put(c);
    in.put(in.chance(0.5) ? static_cast<double>(a) * b / c : in.uniform(-2.0, 2.0));
}

// Writes two directions that are perpendicular up to rounding, or any two.
void fillDirections(InputSource& in) {
    const Vector a = in.direction();
    const Vector b = in.direction();
    const Vector across{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    const double length = std::sqrt(across.x * across.x + across.y * across.y + across.z * across.z);
    in.put(a);
    in.put(length > 1e-3 && in.chance(0.7) ? Vector{across.x / length, across.y / length, across.z / length}
                                           : b);
}

void fillVector(InputSource& in) {
    const Vector v = in.direction();
    const double length = in.logUniform(1e-15, 1e15);
    in.put({v.x * length, v.y * length, v.z * length});
}

void fillNormalTransform(InputSource& in) {
    for (int k = 0; k < 9; ++k) {
        in.put(in.coordinate());
    }
    in.put(in.direction());
}

// Writes a triangle, and a transform that rotates, scales by 0.1 to 10 along each axis and translates.
void fillPlane(InputSource& in) {
    in.put(in.direction());
    for (int k = 0; k < 12; ++k) {
        in.put(in.coordinate());
    }
    const Vector turn = in.direction();
    const double angle = in.uniform(0.0, 3.0);
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    const double n[3] = {turn.x, turn.y, turn.z};
    const double across[3][3] = {{0.0, -n[2], n[1]}, {n[2], 0.0, -n[0]}, {-n[1], n[0], 0.0}};
    const double scale[3] = {in.logUniform(0.1, 10.0), in.logUniform(0.1, 10.0), in.logUniform(0.1, 10.0)};
    double rotation[3][3];
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            rotation[row][column] =
                (row == column ? c : 0.0) + s * across[row][column] + (1.0 - c) * n[row] * n[column];
            in.put(rotation[row][column] * scale[column]);
        }
        in.put(in.coordinate());
    }
    // The cofactors of a rotation times a scale: each column is multiplied by the other two scales.
    for (const auto& row : rotation) {
        for (int column = 0; column < 3; ++column) {
            in.put(row[column] * scale[(column + 1) % 3] * scale[(column + 2) % 3]);
        }
    }
}

// Writes a ray and a normal at every angle, from parallel to perpendicular.
void fillConeOnPlane(InputSource& in) {
    const Vector n = in.direction();
    const Plane plane(n);
    const double cosine = in.pick({-1.0, 1.0}) * in.cosine();
    const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    const double turn = in.uniform(0.0, 2.0 * std::numbers::pi);
    const Vector across = plane.at(sine * std::cos(turn), sine * std::sin(turn));
    in.put({across.x + cosine * n.x, across.y + cosine * n.y, across.z + cosine * n.z});
    in.put(n);
}

// Writes a vector in the plane of a triangle that is no sliver, with sizes from 1e-12 to 1e12.
void fillTriangle(InputSource& in) {
    const Plane plane(in.direction());
    const double width = in.logUniform(1e-12, 1e12);
    const double length = width * in.logUniform(1e-4, 1e2);
    const double turn = in.uniform(0.0, 2.0 * std::numbers::pi);
    in.put(plane.at(length * std::cos(turn), length * std::sin(turn)));
    const double tilt = in.uniform(0.0, 2.0 * std::numbers::pi);
    const double corner = tilt + in.uniform(0.2, 2.9);
    const double height = width * in.uniform(0.3, 3.0);
    in.put(plane.at(width * std::cos(tilt), width * std::sin(tilt)));
    in.put(plane.at(height * std::cos(corner), height * std::sin(corner)));
}

// Writes an ellipse up to 100 times as long as wide on a triangle that is no sliver, with a texture that it
// does not squeeze into a line.
void fillFootprint(InputSource& in) {
    const double corner = in.uniform(0.2, 2.9);
    const double height = in.uniform(0.3, 3.0);
    const double axis = in.uniform(0.0, 2.0 * std::numbers::pi);
    const double width = in.logUniform(1e-4, 1e2);
    const double length = width * in.logUniform(1.0, 100.0);
    // Uses Cramer's rule with the edges (1, 0) and height (cos corner, sin corner).
    const auto putInEdges = [&](double x, double y) {
        in.put(x - y * std::cos(corner) / std::sin(corner));
        in.put(y / (height * std::sin(corner)));
    };
    putInEdges(-width * std::sin(axis), width * std::cos(axis));
    putInEdges(length * std::cos(axis), length * std::sin(axis));
    const double uvWidth = in.logUniform(1e-3, 10.0);
    const double turn = in.uniform(0.0, 2.0 * std::numbers::pi);
    const double uvCorner = turn + in.pick({-1.0, 1.0}) * in.uniform(0.2, 2.9);
    in.put(uvWidth * std::cos(turn));
    in.put(uvWidth * std::sin(turn));
    in.put(uvWidth * height * std::cos(uvCorner));
    in.put(uvWidth * height * std::sin(uvCorner));
    in.put(std::exp2(std::floor(in.uniform(0.0, 14.0))));
    in.put(std::exp2(std::floor(in.uniform(0.0, 14.0))));
    in.put(in.pick({1.0, 2.0, 8.0, 16.0}));
}

void fillLight(InputSource& in) {
    const Vector axis = in.direction();
    const double outer = std::cos(in.uniform(0.01, 1.5));
    const double inner = outer + (1.0 - outer) * in.uniform();
    const double scale = 1.0 / std::max(0.001, inner - outer);
    const Vector position{in.uniform(-100.0, 100.0), in.uniform(-100.0, 100.0), in.uniform(-100.0, 100.0)};
    const Vector away = in.direction();
    const double distance = in.chance(0.05) ? in.pick({0.0, 1e-4, 1e-3}) : in.logUniform(1e-2, 1e4);
    in.put(position);
    in.put(in.pick({0.0, 1.0, 2.0}));
    in.put(axis);
    in.put(in.chance(0.5) ? 0.0 : distance * in.logUniform(0.1, 1e3));
    for (int k = 0; k < 3; ++k) {
        in.put(in.colour());
    }
    in.put(scale);
    in.put(-outer * scale);
    in.put({position.x + distance * away.x, position.y + distance * away.y, position.z + distance * away.z});
}

void fillSamples(InputSource& in) {
    in.put(std::floor(in.uniform(0.0, 1e6)));
    in.put(in.logUniform(1e-3, 1e3));
    in.put(100000.0);
    in.put(in.chance(0.5) ? in.pick({0.0, 1.0}) : in.logUniform(1e-4, 1.0));
}

}  // namespace glint::numerics
