// Reads the parameters of toon.
#include "hit/surface_values.glsl"
#include "materials/metallic_roughness/metallic_roughness.glsl"

void toonSurface(Hit hit, Features features, inout SurfaceValues values) {
    values.color = texturedBaseColor(hit, features);
}

void toonBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    surface.bsdf.layers.toon = Toon(values.color.rgb, floor(GLINT_MATERIAL_TOON_BANDS(hit)));
}
