// Emission.
#include "hit/surface_values.glsl"

void emissionEmission(Hit hit, Features features, inout vec3 emitted) {
    emitted = GLINT_MATERIAL_EMISSIVE_FACTOR(hit);
    if (hasInput(features, GLINT_EMISSIVE_TEXTURE)) {
        emitted *= sampleSlot(hit, kEmissiveTexture, features).rgb;
    }
}
