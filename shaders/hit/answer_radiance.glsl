// A ray answered with the light that comes back along it.
#include "host/sky.glsl"
#include "hit/samples.glsl"
#if GLINT_PATHS
#include "hit/path.glsl"
#endif

// The light that leaves the hit towards the viewer. `direct` counts only if nothing blocks the shadow ray. The caller
// of shade() traces that ray, so that one ray query serves every case.
struct ShadeResult {
    vec3 radiance;
    vec3 direct;
    vec3 shadowDirection;  // unit vector
    float shadowDistance;  // metres; 0 if no light reaches the surface and no ray is needed
#if GLINT_SHARED_LIGHTS
    uint shadowSees;       // kShadow*
#endif
#if GLINT_PATHS
    PathStep path;
#endif
};

// The answer of a hit that no light leaves.
ShadeResult darkness() {
    ShadeResult result;
    result.radiance = vec3(0.0);
    result.direct = vec3(0.0);
    result.shadowDirection = vec3(0.0);
    result.shadowDistance = 0.0;
#if GLINT_SHARED_LIGHTS
    result.shadowSees = kShadowOfLight;
#endif
#if GLINT_PATHS
    result.path = endOfPath();
#endif
    return result;
}

// The colour of a hit with an unknown shader ID. It occurs only if scene and package disagree.
ShadeResult shadeUnknown() {
    ShadeResult result = darkness();
    result.radiance = vec3(1.0, 0.0, 1.0);
    return result;
}

// Stores the light of a ray that ends without a surface to shade.
void resolveEnd(uint target, vec3 radiance, uint path) {
#if GLINT_PATHS
    uint place = samplePlace(target);
    storeRadiance(target, radiance * pathSoFar(place).throughput, path);
    endPath(place);
#else
    storeRadiance(target, radiance, path);
#endif
}

void resolveMiss(uint target, vec3 direction) {
#if GLINT_SKY_LIGHT
    resolveEnd(target, hostSky(direction) * storedSkyShare(target), kPathMiss);
#else
    resolveEnd(target, hostSky(direction), kPathMiss);
#endif
}

void resolveUnknown(uint target) {
    resolveEnd(target, shadeUnknown().radiance, kPathHit);
}
