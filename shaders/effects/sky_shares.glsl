#include "generated/scene.glsl"
#include "generated/layers.glsl"

// The shares of the sky's light on a surface that remain. Light that an effect traces no longer comes from the sky.
struct SkyShares {
    GLINT_RELAXED float mirrored;     // of the base's reflection at the first bounce
    LayerShares layers;               // of the reflection of each layer that rays may trace
    GLINT_RELAXED float transmitted;  // of the light that passes the microfacets
    GLINT_RELAXED float diffuse;      // of the light that diffuse lobes scatter on the viewer's side
    GLINT_RELAXED float behind;       // of the light from behind that they let through
    GLINT_RELAXED float open;         // of all light from outside: the part that nothing occludes
};

SkyShares wholeSky() {
    return SkyShares(1.0, wholeLayerShares(), 1.0, 1.0, 1.0, 1.0);
}
