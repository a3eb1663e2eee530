#version 460
// Uber shader: traces each ray of the list and shades its hit, whichever of the scene's cases it belongs to.
#define GLINT_CHOOSES_CASES
#define GLINT_MODULE_ALWAYS_LOBES GLINT_HIT_ALWAYS_LOBES
#define GLINT_MODULE_ALWAYS_INPUTS GLINT_HIT_ALWAYS_INPUTS
#define GLINT_MODULE_ANY_LOBES (GLINT_HIT_ALWAYS_LOBES | GLINT_HIT_SOMETIMES_LOBES)
#define GLINT_MODULE_ANY_INPUTS (GLINT_HIT_ALWAYS_INPUTS | GLINT_HIT_SOMETIMES_INPUTS)
#define GLINT_MODULE_MODEL GLINT_HIT_MODEL
#include "hit/corners.glsl"
#include "hit/resolve.glsl"
#include "order/found.glsl"
#include "generated/cases.glsl"

GLINT_RAY_WORKGROUP

void main() {
    uint index = listIndex();
    if (index >= GLINT_FRAME.rayDispatch.data[0].elementCount) {
        return;
    }
    RayRecord ray = listedRay(index);
    GLINT_CLOCK_START
    HitRecord found = hitOfRay(index, ray);
    if (found.geometry == kMissGeometry) {
        resolveMiss(ray.target, ray.direction);
    } else {
        HostGeometry geometry = hostGeometry(found.geometry);
        Hit hit = loadHit(found, ray, geometry, GLINT_HIT_FEATURES(geometry));
#if GLINT_DRAWS_FIRST
        drawLightsFirst(hit, GLINT_HIT_FEATURES(geometry));
#endif
        resolveHit(hit, shadeHit(geometry.shaderId, hit, geometry));
    }
    GLINT_CLOCK_STOP
}
