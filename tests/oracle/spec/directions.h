// Changes of variables that put the points of a quadrature where lobes are: each maps a point of the unit
// square to a direction, and says which solid angle the square's measure stands for there.
#pragma once

#include "oracle/vectors.h"

namespace glint::spec {

using oracle::Vec2;
using oracle::Vec3;

// The unit vector at this cosine to z, turned by the azimuth from x.
Vec3 polarDirection(double cosine, double azimuth);

struct Direction {
    Vec3 l{0.0};
    double solidAngle = 0.0;  // of the unit square; 0 where no light passes
};

// Cosine-weighted about z.
Direction cosineDirection(const Vec2& point);

// The facet normal of a point, with the density of normals that are visible from v (v.z > 0): Heitz 2018,
// "Sampling the GGX Distribution of Visible Normals".
Vec3 visibleNormal(const Vec3& v, const Vec2& alpha, const Vec2& point);
// Its density by solid angle: masking D(h) (v·h) / (n·v).
double visibleNormalDensity(const Vec3& v, const Vec3& h, const Vec2& alpha);

// The mirror image of v about a visible normal, and the same on the far side of a thin wall.
Direction reflectedDirection(const Vec3& v, const Vec2& alpha, const Vec2& point);
// The direction beyond a visible normal by Snell's law; eta is the index of the far side over that of v's.
Direction refractedDirection(const Vec3& v, const Vec2& alpha, double eta, const Vec2& point);

// The mean of f over the midpoints of rows × columns cells of the unit square. Rows divide the first
// coordinate.
template <typename Value, typename Function>
Value midpoints(int rows, int columns, Value sum, const Function& f) {
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            sum += f(Vec2((row + 0.5) / rows, (column + 0.5) / columns));
        }
    }
    return sum / (static_cast<double>(rows) * columns);
}

}  // namespace glint::spec
