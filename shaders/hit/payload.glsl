// The payloads of rays in a ray tracing pipeline.
#include "generated/scene.glsl"

// The payload of rays that are shaded elsewhere, 20 bytes. A shadow ray reads only the first member.
struct TracePayload {
    uint geometry;  // kMissGeometry if nothing was hit
    uint primitive;
    vec2 barycentrics;
    float distance;
};

// The payload of the strategy hit-shaders, 52 or 56 bytes: the content of a ShadeResult, and the start of the shadow
// ray. On the way to the hit, `radiance` holds the number of the sample (as bits), the cone's width at the ray's start, and its
// spread.
struct HitPayload {
    vec3 radiance;
    vec3 direct;
    vec3 shadowOrigin;
    vec3 shadowDirection;
    float shadowDistance;  // 0: no shadow ray; negative: the ray left the scene
#if GLINT_EMISSIVE_LIGHTS
    uint shadowSees;
#endif
};
