// Makes a Surface of a hit and its material. Roughness and thickness are compared with limits and wavelengths, so they
// keep 32 bits whatever the precision.
#include "hit/surface.glsl"
#include "hit/texture.glsl"

GLINT_RELAXED vec4 baseColor(Hit hit, Features features) {
    GLINT_RELAXED vec4 color = GLINT_MATERIAL_BASE_COLOR_FACTOR(hit);
    if (hasInput(features, GLINT_BASE_COLOR_TEXTURE)) {
        color *= sampleSlot(hit, kBaseColorTexture, features);
    }
    if (hasInput(features, GLINT_VERTEX_COLOR)) {
        // glTF 2.0, section 3.7.2.1, bounds vertex colours. Values beyond would overflow in 16 bits.
        color *= GLINT_PRECISION == 16 ? clamp(hit.color, vec4(0.0), vec4(1.0)) : hit.color;
    }
    return color;
}

// The normals of double-sided materials turn to the viewer.
float facing(Hit hit, Features features) {
    return hasInput(features, GLINT_DOUBLE_SIDED) && !hit.frontFace ? -1.0 : 1.0;
}

vec3 emission(Hit hit, Features features) {
    vec3 emitted = GLINT_MATERIAL_EMISSIVE_FACTOR(hit);
    if (hasInput(features, GLINT_EMISSIVE_TEXTURE)) {
        emitted *= sampleSlot(hit, kEmissiveTexture, features).rgb;
    }
    if (hasInput(features, GLINT_EMISSIVE_STRENGTH)) {
        emitted *= GLINT_MATERIAL_EMISSIVE_STRENGTH(hit);
    }
    return emitted;
}

// The base's colour, for the extensions on top of it.
struct Base {
    GLINT_RELAXED vec3 color;
    GLINT_RELAXED float metallic;
    float roughness;
};

// Metallic-roughness: glTF 2.0, section 3.9.2 and appendix B.3.5. The dielectric's reflectance follows
// KHR_materials_ior and KHR_materials_specular. The fields of other lobes are not changed.
void metallicRoughnessBase(Hit hit, Features features, inout Bsdf bsdf, out Base base) {
    base.color = baseColor(hit, features).rgb;
    base.metallic = GLINT_MATERIAL_METALLIC_FACTOR(hit);
    base.roughness = GLINT_MATERIAL_ROUGHNESS_FACTOR(hit);
    if (hasInput(features, GLINT_METALLIC_ROUGHNESS_TEXTURE)) {
        vec4 texel = sampleSlot(hit, kMetallicRoughnessTexture, features);
        base.roughness *= texel.g;
        GLINT_RELAXED float metallic = texel.b;
        base.metallic *= metallic;
    }
    GLINT_RELAXED vec3 f0 = vec3(hasLobe(features, GLINT_IOR) ? dielectricF0(GLINT_MATERIAL_IOR(hit)) : 0.04);
    GLINT_RELAXED float f90 = 1.0;
    if (hasLobe(features, GLINT_SPECULAR)) {
        GLINT_RELAXED float specular = GLINT_MATERIAL_SPECULAR_FACTOR(hit);
        vec3 specularColor = GLINT_MATERIAL_SPECULAR_COLOR_FACTOR(hit);
        if (hasInput(features, GLINT_SPECULAR_TEXTURE)) {
            specular *= sampleSlot(hit, kSpecularTexture, features).a;
        }
        if (hasInput(features, GLINT_SPECULAR_COLOR_TEXTURE)) {
            specularColor *= sampleSlot(hit, kSpecularColorTexture, features).rgb;
        }
        f0 = min(f0 * specularColor, vec3(1.0)) * specular;
        f90 = specular;
    }
    bsdf.diffuse = base.color * (1.0 - base.metallic);
    bsdf.metalF0 = base.color;
    bsdf.metallic = base.metallic;
    bool both = hasInput(features, GLINT_PARTIAL_METAL);
    bsdf.f0 = both ? f0 : mix(f0, base.color, base.metallic);
    bsdf.f90 = both ? f90 : mix(f90, 1.0, base.metallic);
}

// KHR_materials_pbrSpecularGlossiness: diffuse and specular colours. Surfaces reflect at most all of the light.
void specularGlossinessBase(Hit hit, Features features, inout Bsdf bsdf, out Base base) {
    base.color = baseColor(hit, features).rgb;
    base.metallic = 0.0;
    GLINT_RELAXED vec3 specular = GLINT_MATERIAL_GLOSSY_SPECULAR_FACTOR(hit);
    float glossiness = GLINT_MATERIAL_GLOSSINESS_FACTOR(hit);
    if (hasInput(features, GLINT_METALLIC_ROUGHNESS_TEXTURE)) {
        vec4 texel = sampleSlot(hit, kMetallicRoughnessTexture, features);
        GLINT_RELAXED vec3 tint = texel.rgb;
        specular *= tint;
        glossiness *= texel.a;
    }
    base.roughness = 1.0 - glossiness;
    bsdf.diffuse = base.color * (1.0 - largest(specular));
    bsdf.f0 = specular;
    bsdf.f90 = 1.0;
    bsdf.metalF0 = vec3(0.0);
    bsdf.metallic = 0.0;
}

// KHR_materials_anisotropy: the alphas along the direction of anisotropy and across it. That direction becomes the
// frame's x.
void applyAnisotropy(Hit hit, Features features, inout Surface surface) {
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
    float alpha = surface.bsdf.alpha.y;
    surface.bsdf.alpha.x = mix(alpha, 1.0, strength * strength);
}

// The f0 of a base under a film of the given coverage and thickness. The film's reflectance is turned into the f0 with
// which Schlick's approximation gives it, so that the albedos of the lobe are still known.
GLINT_RELAXED vec3 filmF0(GLINT_RELAXED vec3 f0, GLINT_RELAXED float f90, float nDotV, float ior, float thickness,
                          GLINT_RELAXED float coverage) {
    vec3 film = iridescentFresnel(nDotV, f0, ior, thickness);
    return mix(f0, min(schlickF0(film, f90, nDotV), vec3(f90)), coverage);
}

// KHR_materials_iridescence: a film on each base. As in the reference renderer, the angle of the view serves for all
// lights.
void applyIridescence(Hit hit, Features features, float nDotV, inout Bsdf bsdf) {
    GLINT_RELAXED float factor = GLINT_MATERIAL_IRIDESCENCE_FACTOR(hit);
    float thickness = GLINT_MATERIAL_IRIDESCENCE_THICKNESS_MAXIMUM(hit);
    if (hasInput(features, GLINT_IRIDESCENCE_TEXTURE)) {
        factor *= sampleSlot(hit, kIridescenceTexture, features).r;
    }
    if (hasInput(features, GLINT_IRIDESCENCE_THICKNESS_TEXTURE)) {
        float thinnest = GLINT_MATERIAL_IRIDESCENCE_THICKNESS_MINIMUM(hit);
        vec4 texel = sampleSlot(hit, kIridescenceThicknessTexture, features);
        thickness = mix(thinnest, thickness, texel.g);
    }
    float filmIor = GLINT_MATERIAL_IRIDESCENCE_IOR(hit);
    bsdf.f0 = filmF0(bsdf.f0, bsdf.f90, nDotV, filmIor, thickness, factor);
    if (hasInput(features, GLINT_PARTIAL_METAL)) {
        bsdf.metalF0 = filmF0(bsdf.metalF0, 1.0, nDotV, filmIor, thickness, factor);
    }
}

// KHR_materials_transmission, KHR_materials_diffuse_transmission, KHR_materials_volume, KHR_materials_dispersion: the
// light that passes the surface is taken from the diffuse lobe.
void applyTransmission(Hit hit, Features features, Base base, inout Bsdf bsdf) {
    GLINT_RELAXED float transmission = 0.0;
    if (hasLobe(features, GLINT_TRANSMISSION)) {
        transmission = GLINT_MATERIAL_TRANSMISSION_FACTOR(hit);
        if (hasInput(features, GLINT_TRANSMISSION_TEXTURE)) {
            transmission *= sampleSlot(hit, kTransmissionTexture, features).r;
        }
        bsdf.transmitted = base.color * (1.0 - base.metallic) * transmission;
        bsdf.diffuse *= 1.0 - transmission;
    }
    if (hasLobe(features, GLINT_DIFFUSE_TRANSMISSION)) {
        GLINT_RELAXED float share = GLINT_MATERIAL_DIFFUSE_TRANSMISSION_FACTOR(hit);
        GLINT_RELAXED vec3 color = GLINT_MATERIAL_DIFFUSE_TRANSMISSION_COLOR_FACTOR(hit);
        if (hasInput(features, GLINT_DIFFUSE_TRANSMISSION_TEXTURE)) {
            share *= sampleSlot(hit, kDiffuseTransmissionTexture, features).a;
        }
        if (hasInput(features, GLINT_DIFFUSE_TRANSMISSION_COLOR_TEXTURE)) {
            color *= sampleSlot(hit, kDiffuseTransmissionColorTexture, features).rgb;
        }
        bsdf.diffuseTransmitted = color * (share * (1.0 - transmission) * (1.0 - base.metallic));
        bsdf.diffuse *= 1.0 - share;
    }
    if (hasLobe(features, GLINT_VOLUME)) {
        float ior = hasLobe(features, GLINT_IOR) ? GLINT_MATERIAL_IOR(hit) : 1.5;
        vec3 iors = vec3(ior);
        if (hasLobe(features, GLINT_DISPERSION)) {
            iors = dispersedIor(ior, GLINT_MATERIAL_DISPERSION(hit));
        }
        bool inside = hasInput(features, GLINT_DOUBLE_SIDED) && !hit.frontFace;
        bsdf.eta = inside ? vec3(1.0) / iors : iors;
        if (inside) {
            // From within, more is reflected than the albedos of the outside say, so the diffuse lobe is removed.
            bsdf.diffuse = vec3(0.0);
            bsdf.diffuseTransmitted = vec3(0.0);
        }
    }
    if (hasLobe(features, GLINT_ATTENUATION)) {
        float thickness = GLINT_MATERIAL_THICKNESS_FACTOR(hit) * hit.scale;
        if (hasInput(features, GLINT_THICKNESS_TEXTURE)) {
            vec4 texel = sampleSlot(hit, kThicknessTexture, features);
            thickness *= texel.g;
        }
        GLINT_RELAXED vec3 transmittance = volumeTransmittance(GLINT_MATERIAL_ABSORPTION(hit), thickness);
        bsdf.transmitted *= transmittance;
        bsdf.diffuseTransmitted *= transmittance;
    }
}

void applySheen(Hit hit, Features features, inout Bsdf bsdf) {
    float roughness = GLINT_MATERIAL_SHEEN_ROUGHNESS_FACTOR(hit);
    bsdf.sheenColor = GLINT_MATERIAL_SHEEN_COLOR_FACTOR(hit);
    if (hasInput(features, GLINT_SHEEN_COLOR_TEXTURE)) {
        bsdf.sheenColor *= sampleSlot(hit, kSheenColorTexture, features).rgb;
    }
    if (hasInput(features, GLINT_SHEEN_ROUGHNESS_TEXTURE)) {
        vec4 texel = sampleSlot(hit, kSheenRoughnessTexture, features);
        roughness *= texel.a;
    }
    bsdf.sheenAlpha = max(roughness * roughness, kMinSheenAlpha);
}

void applyClearcoat(Hit hit, Features features, inout Surface surface) {
    GLINT_RELAXED float factor = GLINT_MATERIAL_CLEARCOAT_FACTOR(hit);
    float roughness = GLINT_MATERIAL_CLEARCOAT_ROUGHNESS_FACTOR(hit);
    if (hasInput(features, GLINT_CLEARCOAT_TEXTURE)) {
        factor *= sampleSlot(hit, kClearcoatTexture, features).r;
    }
    if (hasInput(features, GLINT_CLEARCOAT_ROUGHNESS_TEXTURE)) {
        vec4 texel = sampleSlot(hit, kClearcoatRoughnessTexture, features);
        roughness *= texel.g;
    }
    surface.bsdf.clearcoat = factor;
    surface.bsdf.clearcoatAlpha = max(roughness * roughness, kMinAlpha);
    surface.bsdf.clearcoatNormal = vec3(0.0, 0.0, 1.0);
    // The base's normal texture does not affect the coat. Without a normal texture of its own, the coat has the mesh's
    // normal.
    if (hasInput(features, GLINT_CLEARCOAT_NORMAL_TEXTURE)) {
        vec3 normal = mappedNormal(hit, kClearcoatNormalTexture, GLINT_MATERIAL_CLEARCOAT_NORMAL_SCALE(hit), features);
        surface.bsdf.clearcoatNormal = directionOr(toSurface(surface, normal * facing(hit, features)),
                                                   vec3(0.0, 0.0, 1.0));
    } else if (hasInput(features, GLINT_NORMAL_TEXTURE) && !hasInput(features, GLINT_CLEARCOAT_SHARES_NORMAL)) {
        surface.bsdf.clearcoatNormal = directionOr(toSurface(surface, hit.normal * facing(hit, features)),
                                                   vec3(0.0, 0.0, 1.0));
    }
}

// Requires a lit key.
Surface evaluateSurface(Hit hit, Features features) {
    Surface surface;
    surface.normal = hit.normal;
    if (hasInput(features, GLINT_NORMAL_TEXTURE)) {
        surface.normal = mappedNormal(hit, kNormalTexture, GLINT_MATERIAL_NORMAL_SCALE(hit), features);
    }
    surface.normal *= facing(hit, features);
    buildBasis(surface.normal, surface.tangent, surface.bitangent);

    Bsdf bsdf;
    Base base;
    bsdf.transmitted = vec3(0.0);
    bsdf.diffuseTransmitted = vec3(0.0);
    bsdf.eta = vec3(1.0);
    bsdf.clearcoat = 0.0;
    bsdf.clearcoatAlpha = 1.0;
    bsdf.clearcoatNormal = vec3(0.0, 0.0, 1.0);
    bsdf.sheenColor = vec3(0.0);
    bsdf.sheenAlpha = 1.0;
    if (hasLobe(features, GLINT_SPECULAR_GLOSSINESS)) {
        specularGlossinessBase(hit, features, bsdf, base);
    } else {
        metallicRoughnessBase(hit, features, bsdf, base);
    }
    bsdf.alpha = vec2(max(base.roughness * base.roughness, kMinAlpha));
    surface.bsdf = bsdf;
    if (hasLobe(features, GLINT_ANISOTROPY)) {
        applyAnisotropy(hit, features, surface);
    }
    surface.roughness = hasLobe(features, GLINT_ANISOTROPY) ? sqrt(surface.bsdf.alpha.x) : base.roughness;
    vec3 view = toSurface(surface, hit.view);
    if (hasLobe(features, GLINT_IRIDESCENCE)) {
        applyIridescence(hit, features, clamp(view.z, 0.0, 1.0), surface.bsdf);
    }
    applyTransmission(hit, features, base, surface.bsdf);
    if (hasLobe(features, GLINT_SHEEN)) {
        applySheen(hit, features, surface.bsdf);
    }
    if (hasLobe(features, GLINT_CLEARCOAT)) {
        applyClearcoat(hit, features, surface);
    }
    prepareBsdf(surface.bsdf, features, view);
    surface.emission = emission(hit, features) * (1.0 - coatReflectance(surface, features));
    surface.occlusion = 1.0;
    if (hasInput(features, GLINT_OCCLUSION_TEXTURE)) {
        GLINT_RELAXED float texel = sampleSlot(hit, kOcclusionTexture, features).r;
        surface.occlusion = 1.0 + GLINT_MATERIAL_OCCLUSION_STRENGTH(hit) * (texel - 1.0);
    }
    return surface;
}
