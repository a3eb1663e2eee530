// Reads the parameters of satin.
#include "hit/surface_values.glsl"
#include "materials/metallic_roughness/metallic_roughness.glsl"

void satinSurface(Hit hit, Features features, inout SurfaceValues values) {
    values.color = texturedBaseColor(hit, features);
}

void satinBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    Satin model = Satin(values.color.rgb, GLINT_MATERIAL_SATIN_MIRROR(hit), GLINT_MATERIAL_SATIN_GLOSS(hit));
    float cosine = clamp(dot(surface.normal, hit.view), 0.0, 1.0);
    vec3 mirrored = satinMirrored(model, cosine);
    float above = 1.0 - 0.5 * exp(-1.6 * cosine * sqrt(model.gloss));  // share of the lobe above the horizon
    surface.bsdf.layers.satin = model;
    surface.bsdf.diffuse = satinScattered(model, mirrored) + mirrored * above;
}
