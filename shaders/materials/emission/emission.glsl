// Emission.
#include "hit/surface_values.glsl"

void emissionEmission(Hit hit, Features features, inout vec3 emitted) {
#if GLINT_USES_MODELS
    if (isOfPack(features) && !hasInput(features, GLINT_MODEL_EMISSION)) {
        return;
    }
#endif
    vec3 own = GLINT_MATERIAL_EMISSIVE_FACTOR(hit);
    if (hasInput(features, GLINT_EMISSIVE_TEXTURE)) {
        own *= sampleSlot(hit, kEmissiveTexture, features).rgb;
    }
    emitted += own;
}
