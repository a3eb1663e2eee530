// The volumes that a ray is in, the innermost last: KHR_materials_volume, KHR_materials_dispersion.
#pragma once

#include "gltf/scene.h"
#include "oracle/scene/geometry.h"

#include <vector>

namespace glint::oracle {

// What a volume's material does to light within it.
struct Medium {
    Vec3 ior{1.0};         // of red, green, blue
    Vec3 absorption{0.0};  // per metre
};
Medium mediumOf(const materials::Material& material);

// Surfaces with their front to the ray begin a medium, and backs end the innermost one of their material. A
// back whose front the ray never met ends nothing.
class Media {
public:
    // `all` has a medium for each material, and must outlive the object.
    explicit Media(const std::vector<Medium>& all) : all_(&all) {}

    bool empty() const {
        return inside_.empty();
    }
    // Returns the share of light that passes along a distance, which may be infinite.
    Vec3 transmittance(double distance) const;
    // Returns the medium on the other side of a surface's own: for a front, the one that the ray is in; for a
    // back, the one that the ray is in once it has left. Sets whether it is a medium of the scene.
    Vec3 outside(const SurfacePoint& point, bool& nested) const;
    // Passes the surface.
    void cross(const SurfacePoint& point);

private:
    // Returns the place of a material counted from 1; 0 if the ray is not in it.
    std::size_t placeOf(int material) const;

    const std::vector<Medium>* all_;
    std::vector<int> inside_;  // materials
};

}  // namespace glint::oracle
