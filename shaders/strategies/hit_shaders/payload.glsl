// The payload of rays that closest-hit shaders shade, 52 or 56 bytes: the content of a ShadeResult, and the start of
// the shadow ray. On the way to the hit, `radiance` holds the number of the sample (as bits), the cone's width at the
// ray's start, and its spread. In packages whose shadow rays pass glass, a shadow ray to a light has the three members
// of its LightPassage in the first three here.
#include "generated/scene.glsl"
#include "light/passage.glsl"

struct HitPayload {
    vec3 radiance;
    vec3 direct;
    vec3 shadowOrigin;
    vec3 shadowDirection;
    float shadowDistance;  // 0: no shadow ray; negative: the ray left the scene
#if GLINT_SHARED_LIGHTS
    uint shadowSees;
#endif
};
