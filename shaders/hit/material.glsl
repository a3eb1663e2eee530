// From a hit and its material to a Surface.
#include "bsdf/surface.glsl"
#include "hit/texture.glsl"

vec4 baseColor(Hit hit, MaterialRecord material, Features features) {
    vec4 color = material.baseColorFactor;
    if (hasInput(features, GLINT_BASE_COLOR_TEXTURE)) {
        color *= sampleSlot(hit, kTextureBaseColor, features);
    }
    if (hasInput(features, GLINT_VERTEX_COLOR)) {
        color *= hit.color;
    }
    return color;
}

// The shading normal, on the viewer's side where the material is double-sided.
vec3 shadingNormal(Hit hit, MaterialRecord material, Features features) {
    vec3 normal = hit.normal;
    if (hasInput(features, GLINT_NORMAL_TEXTURE)) {
        vec3 texel = sampleSlot(hit, kTextureNormal, features).xyz * 2.0 - 1.0;
        vec3 tangent;
        vec3 bitangent;
        tangentFrame(hit, features, tangent, bitangent);
        vec3 scaled = texel * vec3(material.normalScale, material.normalScale, 1.0);
        normal = directionOr(scaled.x * tangent + scaled.y * bitangent + scaled.z * hit.normal, hit.normal);
    }
    if (hasInput(features, GLINT_DOUBLE_SIDED) && !hit.frontFace) {
        normal = -normal;
    }
    return normal;
}

vec3 emission(Hit hit, MaterialRecord material, Features features) {
    vec3 emitted = material.emissiveFactor;
    if (hasInput(features, GLINT_EMISSIVE_TEXTURE)) {
        emitted *= sampleSlot(hit, kTextureEmissive, features).rgb;
    }
    if (hasInput(features, GLINT_EMISSIVE_STRENGTH)) {
        emitted *= material.emissiveStrength;
    }
    return emitted;
}

// Metallic-roughness: glTF 2.0, section 3.9.2 and appendix B.3.5. Requires a lit key.
Surface evaluateSurface(Hit hit, Features features) {
    MaterialRecord material = GLINT_FRAME.materials.data[hit.material];
    vec3 color = baseColor(hit, material, features).rgb;

    float metallic = material.metallicFactor;
    float roughness = material.roughnessFactor;
    if (hasInput(features, GLINT_METALLIC_ROUGHNESS_TEXTURE)) {
        vec4 texel = sampleSlot(hit, kTextureMetallicRoughness, features);
        roughness *= texel.g;
        metallic *= texel.b;
    }

    Surface surface;
    surface.diffuseAlbedo = color * (1.0 - metallic);
    surface.f0 = mix(vec3(0.04), color, metallic);
    surface.roughness = roughness;
    surface.alpha = max(roughness * roughness, kMinAlpha);
    surface.normal = shadingNormal(hit, material, features);
    surface.emission = emission(hit, material, features);
    surface.occlusion = 1.0;
    if (hasInput(features, GLINT_OCCLUSION_TEXTURE)) {
        float texel = sampleSlot(hit, kTextureOcclusion, features).r;
        surface.occlusion = 1.0 + material.occlusionStrength * (texel - 1.0);
    }
    return surface;
}
