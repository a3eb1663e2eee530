// KHR_materials_emissive_strength.
#include "hit/surface_values.glsl"

void emissiveStrengthEmission(Hit hit, Features features, inout vec3 emitted) {
    emitted *= GLINT_MATERIAL_EMISSIVE_STRENGTH(hit);
}
