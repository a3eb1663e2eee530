// The payloads of rays in a ray tracing pipeline.
#include "generated/scene.glsl"
#include "light/passage.glsl"

// The payload of rays that are shaded elsewhere, 20 bytes. A shadow ray reads only the first member, and in packages
// that have it the last one: then the payload has 56 bytes.
struct TracePayload {
    uint geometry;  // kMissGeometry if nothing was hit
    uint primitive;
    vec2 barycentrics;
    float distance;
#if GLINT_SHADOW_GLASS || GLINT_SHADOW_OPAQUE
    LightPassage passage;
#endif
};

// The payload of the strategy hit-shaders, 52 or 56 bytes: the content of a ShadeResult, and the start of the shadow
// ray. On the way to the hit, `radiance` holds the number of the sample (as bits), the cone's width at the ray's start, and its
// spread. In packages whose shadow rays pass glass, a shadow ray to a light that is none of the emissive ones has the
// three members of its LightPassage in the first three here.
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
