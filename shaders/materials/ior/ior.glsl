// KHR_materials_ior.
#include "hit/surface_values.glsl"

void iorSurface(Hit hit, Features features, inout SurfaceValues values) {
    values.f0 = vec3(dielectricF0(GLINT_MATERIAL_IOR(hit)));
}

const float kDefaultIor = 1.5;

// The index of the surface's own medium.
float mediumIor(Hit hit, Features features) {
    return hasLobe(features, GLINT_IOR) ? GLINT_MATERIAL_IOR(hit) : kDefaultIor;
}
