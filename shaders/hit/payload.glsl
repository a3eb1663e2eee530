// The payloads of rays in a ray tracing pipeline.
#include "generated/scene.glsl"
#include "light/passage.glsl"

// The payload of rays that are shaded elsewhere, 20 bytes. A shadow ray reads only the first member and, in packages
// that have it, the last one. The payload then has 56 bytes.
struct TracePayload {
    uint geometry;  // kMissGeometry if nothing was hit
    uint primitive;
    vec2 barycentrics;
    float distance;
#if GLINT_SHADOW_GLASS || GLINT_SHADOW_OPAQUE
    LightPassage passage;
#endif
};
