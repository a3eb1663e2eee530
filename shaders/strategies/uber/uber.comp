#version 460
// Uber shader: traces each ray of the list and shades its hit, whichever of the scene's cases it belongs to.
#define GLINT_MODULE_ALWAYS_LOBES GLINT_HIT_ALWAYS_LOBES
#define GLINT_MODULE_ALWAYS_INPUTS GLINT_HIT_ALWAYS_INPUTS
#define GLINT_MODULE_ANY_LOBES (GLINT_HIT_ALWAYS_LOBES | GLINT_HIT_SOMETIMES_LOBES)
#define GLINT_MODULE_ANY_INPUTS (GLINT_HIT_ALWAYS_INPUTS | GLINT_HIT_SOMETIMES_INPUTS)
#include "hit/corners.glsl"
#include "hit/resolve.glsl"
#include "hit/path_ray.glsl"
#include "generated/cases.glsl"

GLINT_RAY_WORKGROUP

void main() {
    uint index = listIndex();
    if (index >= GLINT_FRAME.rayDispatch.data[0].elementCount) {
        return;
    }
    RayRecord ray = GLINT_FRAME.rays.data[index];
    HitRecord record = traceRay(ray, index, rayFlags(ray.target));
    if (record.geometry == kMissGeometry) {
        resolveMiss(record.target, ray.direction);
    } else {
        HostGeometry geometry = hostGeometry(record.geometry);
        Hit hit = loadHit(record, ray.direction, geometry, GLINT_HIT_FEATURES(geometry));
        resolveHit(hit, shadeHit(geometry.shaderId, hit, geometry));
    }
}
