// Reads the parameters of the coat, and colours and darkens what is below it: OpenPBR 1.1, "Coat", with the draft's
// names.
#include "hit/surface_values.glsl"

// The normal of the coat in the frame of the base. The base's normal texture does not affect it.
vec3 coatNormal(Hit hit, Features features, Surface surface) {
    vec3 normal = vec3(0.0, 0.0, 1.0);
    if (GLINT_HAS_COAT_NORMAL_TEXTURE(features)) {
        vec3 mapped = mappedNormal(hit, kCoatNormalTexture, GLINT_MATERIAL_COAT_NORMAL_SCALE(hit), features);
        normal = directionOr(toSurface(surface, mapped * facing(hit, features)), normal);
    } else if (GLINT_HAS_NORMAL_TEXTURE(features)) {
        normal = directionOr(toSurface(surface, hit.normal * facing(hit, features)), normal);
    }
    return normal;
}

// Sets the coat's tangent and both alphas, as KHR_materials_anisotropy does for the base.
void coatGrooves(Hit hit, Features features, Surface surface, float alpha, inout Coat coat) {
    coat.alpha = vec2(alpha);
    coat.tangent = directionOr(vec3(1.0, 0.0, 0.0) - coat.normal * coat.normal.x, vec3(0.0, 1.0, 0.0));
    if (GLINT_HAS_COAT_ANISOTROPY(features)) {
        vec2 direction = GLINT_MATERIAL_COAT_ANISOTROPY_DIRECTION(hit);
        float strength = GLINT_MATERIAL_COAT_ANISOTROPY_STRENGTH(hit);
        uint slot = kNormalTexture;
        if (GLINT_HAS_COAT_ANISOTROPY_TEXTURE(features)) {
            slot = kCoatAnisotropyTexture;
            vec3 texel = sampleSlot(hit, slot, features).rgb;
            vec2 turned = texel.rg * 2.0 - 1.0;
            direction = vec2(direction.x * turned.x - direction.y * turned.y,
                             direction.y * turned.x + direction.x * turned.y);
            strength *= texel.b;
        }
        vec3 tangent;
        vec3 bitangent;
        tangentFrame(hit, slot, features, tangent, bitangent);
        vec3 along = toSurface(surface, tangent * direction.x + bitangent * direction.y);
        coat.tangent = directionOr(along - coat.normal * dot(coat.normal, along), coat.tangent);
        coat.alpha.x = mix(alpha, 1.0, strength * strength);
    }
}

void coatBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    float factor = GLINT_MATERIAL_COAT_FACTOR(hit);
    float roughness = GLINT_MATERIAL_COAT_ROUGHNESS_FACTOR(hit);
    vec3 color = GLINT_MATERIAL_COAT_COLOR_FACTOR(hit);
    if (GLINT_HAS_COAT_TEXTURE(features)) {
        factor *= sampleSlot(hit, kCoatTexture, features).r;
    }
    if (GLINT_HAS_COAT_ROUGHNESS_TEXTURE(features)) {
        roughness *= sampleSlot(hit, kCoatRoughnessTexture, features).g;
    }
    if (GLINT_HAS_COAT_COLOR_TEXTURE(features)) {
        color *= sampleSlot(hit, kCoatColorTexture, features).rgb;
    }
    float ior = GLINT_MATERIAL_COAT_IOR(hit);
    float f0 = GLINT_MATERIAL_COAT_F0(hit);
    Coat coat;
    coat.factor = factor;
    coat.f0 = f0;
    coat.normal = coatNormal(hit, features, surface);
    coatGrooves(hit, features, surface, max(roughness * roughness, kMinAlpha), coat);
    coat.view = vec3(0.0);
    coat.albedo = 0.0;
    surface.bsdf.layers.coat = coat;

    // The colour is that of light which passes straight down and up. A slanted way through the coat is longer.
    float cosine = dot(surface.normal, hit.view);
    float sine2 = (1.0 - cosine * cosine) / (ior * ior);
    float way = 0.5 + 0.5 / sqrt(max(1.0 - sine2, 1e-4));
    vec3 tint = pow(color, vec3(way));
    // Light that the coat's inner side reflects meets the base again and again. K is the share of it for diffuse light,
    // and for light that a smooth base mirrors the Fresnel reflectance: the roughness of the base chooses between them.
    float inner = 1.0 - (1.0 - f0) / (ior * ior);
    vec3 base = mix(surface.bsdf.diffuse + surface.bsdf.base.f0 * (1.0 - surface.bsdf.diffuse), values.color.rgb,
                    values.metallic);
    float k = mix(f0, inner, values.roughness);
    vec3 darkening = mix(vec3(1.0), (1.0 - k) / (vec3(1.0) - clamp(base, 0.0, 1.0) * k),
                         GLINT_MATERIAL_COAT_DARKENING_FACTOR(hit));
    vec3 below = mix(vec3(1.0), tint * darkening, factor);
    surface.bsdf.diffuse *= below;
    surface.bsdf.base.f0 *= below;
    surface.bsdf.base.f90 *= largest(below);
    surface.bsdf.base.metalF0 *= below;
}
