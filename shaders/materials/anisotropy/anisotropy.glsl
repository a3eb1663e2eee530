// KHR_materials_anisotropy: the alphas along the direction of anisotropy and across it. That direction becomes the
// frame's x.
#include "hit/surface_values.glsl"

void anisotropyBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    vec2 direction = GLINT_MATERIAL_ANISOTROPY_DIRECTION(hit);
    float strength = GLINT_MATERIAL_ANISOTROPY_STRENGTH(hit);
    if (hasInput(features, GLINT_ANISOTROPY_TEXTURE)) {
        vec4 packedDirection = sampleSlot(hit, kAnisotropyTexture, features);
        vec3 texel = packedDirection.rgb;
        vec2 turned = texel.rg * 2.0 - 1.0;
        direction = vec2(direction.x * turned.x - direction.y * turned.y,
                         direction.y * turned.x + direction.x * turned.y);
        strength *= texel.b;
    }
    uint slot = hasInput(features, GLINT_ANISOTROPY_TEXTURE) ? kAnisotropyTexture : kNormalTexture;
    vec3 tangent;
    vec3 bitangent;
    tangentFrame(hit, slot, features, tangent, bitangent);
    vec3 along = tangent * direction.x + bitangent * direction.y;
    surface.tangent = directionOr(along - surface.normal * dot(surface.normal, along), surface.tangent);
    surface.bitangent = cross(surface.normal, surface.tangent);
    float alpha = surface.bsdf.base.alpha.y;
    surface.bsdf.base.alpha.x = mix(alpha, 1.0, strength * strength);
    surface.roughness = sqrt(surface.bsdf.base.alpha.x);
}
