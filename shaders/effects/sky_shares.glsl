#include "generated/scene.glsl"

// How much of the sky's light on a surface its effects leave: what an effect traces, the sky no longer brings.
struct SkyShares {
    GLINT_RELAXED float mirrored;     // of what the base reflects at the first bounce
    GLINT_RELAXED float coated;       // of what the coat reflects
    GLINT_RELAXED float transmitted;  // of what passes the microfacets
    GLINT_RELAXED float diffuse;      // of what diffuse lobes scatter, on either side
    GLINT_RELAXED float open;         // of all that comes from outside: what nothing occludes
};

SkyShares wholeSky() {
    return SkyShares(1.0, 1.0, 1.0, 1.0, 1.0);
}
