// Reads the parameters of the fibres.
#include "hit/surface_values.glsl"

void fibreBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    vec3 tangent;
    vec3 bitangent;
    tangentFrame(hit, kNormalTexture, features, tangent, bitangent);
    float angle = GLINT_MATERIAL_FIBRE_ROTATION(hit);
    vec3 along = toSurface(surface, cos(angle) * tangent + sin(angle) * bitangent);
    float squared = dot(along.xy, along.xy);
    vec2 direction = squared > 0.0 ? along.xy * inversesqrt(squared) : vec2(1.0, 0.0);
    surface.bsdf.layers.fibre = Fibre(GLINT_MATERIAL_FIBRE_COLOR(hit), GLINT_MATERIAL_FIBRE_FACTOR(hit),
                                      GLINT_MATERIAL_FIBRE_WIDTH(hit), direction);
}
