// A ray answered with the light that comes back along it.
#include "host/sky.glsl"
#include "hit/samples.glsl"

// The light that leaves the hit towards the viewer. `direct` counts only if nothing blocks the shadow ray. The caller
// of shade() traces that ray, so that one ray query serves every case.
struct ShadeResult {
    vec3 radiance;
    vec3 direct;
    vec3 shadowDirection;  // unit vector
    float shadowDistance;  // metres; 0 if no light reaches the surface and no ray is needed
};

// The colour of a hit with an unknown shader ID. It occurs only if scene and package disagree.
ShadeResult shadeUnknown() {
    return ShadeResult(vec3(1.0, 0.0, 1.0), vec3(0.0), vec3(0.0), 0.0);
}

void resolveMiss(uint target, vec3 direction) {
    storeRadiance(target, hostSky(direction), kPathMiss);
}

void resolveUnknown(uint target) {
    storeRadiance(target, shadeUnknown().radiance, kPathHit);
}
