// What rays of a ray tracing pipeline carry.

// Of rays that are shaded elsewhere, 20 bytes. A shadow ray reads the first alone.
struct TracePayload {
    uint geometry;  // kMissGeometry: nothing was hit
    uint primitive;
    vec2 barycentrics;
    float distance;
};

// Of the strategy hit-shaders, 52 bytes: what a ShadeResult holds, and where the shadow ray starts. On the way to the
// hit, `radiance` carries the number of the sample (bits), the width of the cone at the ray's start and its spread.
struct HitPayload {
    vec3 radiance;
    vec3 direct;
    vec3 shadowOrigin;
    vec3 shadowDirection;
    float shadowDistance;  // 0: no shadow ray; negative: the ray left the scene
};
