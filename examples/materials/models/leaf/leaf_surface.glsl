// Reads the parameters of leaf.
#include "hit/surface_values.glsl"
#include "materials/metallic_roughness/metallic_roughness.glsl"

void leafSurface(Hit hit, Features features, inout SurfaceValues values) {
    values.color = texturedBaseColor(hit, features);
}

void leafBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    GLINT_RELAXED vec3 passed = GLINT_MATERIAL_LEAF_PASSED(hit);
    surface.bsdf.diffuse = values.color.rgb * (1.0 - passed);
    surface.bsdf.diffuseTransmitted = values.color.rgb * passed;
    surface.bsdf.layers.leaf = Leaf(surface.bsdf.diffuse, surface.bsdf.diffuseTransmitted);
}
