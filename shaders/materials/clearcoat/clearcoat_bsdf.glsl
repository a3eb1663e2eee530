// Reads the parameters of the coat.
#include "hit/surface_values.glsl"

void clearcoatBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    GLINT_RELAXED float factor = GLINT_MATERIAL_CLEARCOAT_FACTOR(hit);
    float roughness = GLINT_MATERIAL_CLEARCOAT_ROUGHNESS_FACTOR(hit);
    if (hasInput(features, GLINT_CLEARCOAT_TEXTURE)) {
        factor *= sampleSlot(hit, kClearcoatTexture, features).r;
    }
    if (hasInput(features, GLINT_CLEARCOAT_ROUGHNESS_TEXTURE)) {
        vec4 texel = sampleSlot(hit, kClearcoatRoughnessTexture, features);
        roughness *= texel.g;
    }
    // The base's normal texture does not affect the coat. Without a normal texture of its own, the coat has the mesh's
    // normal.
    vec3 normal = vec3(0.0, 0.0, 1.0);
    if (hasInput(features, GLINT_CLEARCOAT_NORMAL_TEXTURE)) {
        vec3 mapped = mappedNormal(hit, kClearcoatNormalTexture, GLINT_MATERIAL_CLEARCOAT_NORMAL_SCALE(hit), features);
        normal = directionOr(toSurface(surface, mapped * facing(hit, features)), normal);
    } else if (hasInput(features, GLINT_NORMAL_TEXTURE) && !hasInput(features, GLINT_CLEARCOAT_SHARES_NORMAL)) {
        normal = directionOr(toSurface(surface, hit.normal * facing(hit, features)), normal);
    }
    surface.bsdf.layers.clearcoat = Clearcoat(factor, max(roughness * roughness, kMinAlpha), normal);
}
