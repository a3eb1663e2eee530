// A material at a vertex of a path, in double precision: the shaders' own BSDF, compiled as C++
// (tests/numerics), with one sampling decision over all its lobes. Everything else about paths is the
// oracle's own.
#pragma once

#include "oracle/scene/texture.h"

#include <memory>

namespace glint::oracle {

// A direction in which a path goes on.
struct PathSample {
    Vec3 direction{0.0};   // unit
    Vec3 weight{0.0};      // BSDF |cosine| / density
    double density = 0.0;  // by solid angle; 0 if the path ends here
    bool below =
        false;  // a lobe chose a direction on the other side of the triangle, which was reflected there
};

class PathSurface {
public:
    // The surface is seen along `incoming`. `outsideIor` has the indices of the medium around the surface,
    // for red, green and blue; `nested` says that it is not the air. Light in volumes is absorbed on its way,
    // not here.
    PathSurface(const Textures& textures, const SurfacePoint& point, const Vec3& incoming,
                const Vec3& outsideIor, bool nested);
    ~PathSurface();
    PathSurface(const PathSurface&) = delete;
    PathSurface& operator=(const PathSurface&) = delete;

    bool unlit() const;
    Vec3 baseColor() const;
    Vec3 emission() const;
    // Returns the BSDF times |cosine|, reflected or transmitted; 0 if normal and geometric normal disagree
    // about the side of the light.
    Vec3 scattered(const Vec3& toLight) const;
    // Returns the density by solid angle with which sample() chooses a direction.
    double density(const Vec3& direction) const;
    // Chooses a direction; `point` is uniform in the unit cube. Where normal and geometric normal disagree
    // about its side, the light is lost, or with `reflectsBelow` reflected at the plane of the triangle, as
    // the shaders do.
    PathSample sample(const Vec3& point, bool reflectsBelow = false) const;
    // Returns whether light passes without scattering: KHR_materials_transmission.
    bool clear() const;
    // Returns whether it bounds a volume: KHR_materials_volume.
    bool volume() const;
    // Returns what passes an interface on a straight line: the tint times 1 - F at the angle of the line.
    Vec3 straightThrough() const;
    Vec3 geometricNormal() const;  // on the viewer's side

private:
    struct Lobes;
    std::unique_ptr<Lobes> lobes_;
};

}  // namespace glint::oracle
