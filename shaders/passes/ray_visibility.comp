#version 460
// Answers rays of a host's own that only ask whether light arrives along them.
#include "light/ray.glsl"
#include "hit/list.glsl"

GLINT_RAY_WORKGROUP

void main() {
    uint index = listIndex();
    if (index >= GLINT_FRAME.rayDispatch.data[0].elementCount) {
        return;
    }
    VisibilityRay ray = GLINT_FRAME.visibilityRays.data[index];
    vec3 light = vec3(1.0);
    if (!lightArrivesTo(kShadowOfLight, ray.origin, ray.direction, ray.distance, light)) {
        light = vec3(0.0);
    }
#if GLINT_SHADOW_GLASS
    GLINT_FRAME.visibilities.data[3u * ray.target] = light.r;
    GLINT_FRAME.visibilities.data[3u * ray.target + 1u] = light.g;
    GLINT_FRAME.visibilities.data[3u * ray.target + 2u] = light.b;
#else
    GLINT_FRAME.visibilities.data[ray.target] = light.r;
#endif
}
