// The BSDF of glTF materials: metallic-roughness (glTF 2.0, appendix B) under its extensions, layer on layer:
// clearcoat over sheen over a base that is part metal, part dielectric. A lobe that no key of the case has leaves no code.
#include "generated/scene.glsl"
#include "hit/features.glsl"
#include "bsdf/constants.glsl"
#include "bsdf/exact.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/ggx.glsl"
#include "bsdf/albedo.glsl"
#include "bsdf/sheen.glsl"
#include "bsdf/iridescence.glsl"
#include "bsdf/transmission.glsl"
#include "bsdf/clearcoat.glsl"

// What is GLINT_RELAXED is a share of light in [0, 1] and may have 16 bits (--precision 16). Directions, alphas, and
// losses, which vanish with alpha², keep 32.
// Vectors are in the frame of the surface: z is the shading normal on the viewer's side, x the direction of anisotropy.
struct Bsdf {
    GLINT_RELAXED vec3 diffuse;   // albedo of the diffuse lobe: metal and what is transmitted taken out
    GLINT_RELAXED vec3 f0;        // reflectance at normal incidence
    GLINT_RELAXED float f90;      // and at grazing
    vec2 alpha;     // of the microfacets along x and y, at least kMinAlpha; equal unless the key has anisotropy
    GLINT_RELAXED vec3 transmitted;         // tint and share of light that passes the microfacets
    vec3 eta;                 // n_t / n_i for red, green, blue; read if the key has a volume
    GLINT_RELAXED vec3 diffuseTransmitted;  // albedo of the diffuse lobe on the far side
    GLINT_RELAXED float clearcoat;          // share of the surface that the coat covers
    float clearcoatAlpha;
    vec3 clearcoatNormal;     // unit
    GLINT_RELAXED vec3 sheenColor;
    float sheenAlpha;  // at least kMinSheenAlpha
    // By prepareBsdf(), of the view:
    vec3 view;         // unit, z >= kMinViewCosine
    float viewLoss;    // 1 - E: what single scattering of white microfacets drops
    float viewBias;    // the part of E that (1 - v·h)⁵ weights
    float meanLoss;    // of 2 ∫ (1 - E(μ)) μ dμ
    float meanBias;
    float sheenAlbedo;  // of the white sheen lobe; above 1 near grazing, where the lobe is divided by it
};

// Of Schlick's Fresnel over the hemisphere: 2 ∫ F(μ) μ dμ.
GLINT_RELAXED vec3 meanFresnel(Bsdf b) {
    return b.f0 + (vec3(b.f90) - b.f0) * (1.0 / 21.0);
}

// The multi-scatter lobe is this times (1 - E(v)) (1 - E(l)) / (π (1 - Ē)): Kulla and Conty, "Revisiting Physically
// Based Shading at Imageworks" (2017), with the Fresnel of the second and later bounces after Hill (2018).
GLINT_RELAXED vec3 multiScatterFresnel(Bsdf b) {
    GLINT_RELAXED vec3 mean = meanFresnel(b);
    GLINT_RELAXED float loss = b.meanLoss;
    return mean * mean * (1.0 - loss) / (vec3(1.0) - mean * loss);
}

// What the microfacets reflect at the first bounce of a uniform white sky, by E's loss and bias.
GLINT_RELAXED vec3 singleScatterAlbedo(Bsdf b, GLINT_RELAXED float loss, GLINT_RELAXED float bias) {
    return b.f0 * (1.0 - loss - bias) + vec3(b.f90 * bias);
}

// What they reflect in all: the later bounces, too, if energy compensation is on.
GLINT_RELAXED vec3 specularAlbedo(Bsdf b, GLINT_RELAXED float loss, GLINT_RELAXED float bias) {
    GLINT_RELAXED vec3 single = singleScatterAlbedo(b, loss, bias);
    return GLINT_ENERGY_COMPENSATION != 0 ? single + multiScatterFresnel(b) * loss : single;
}

// 1 - specularAlbedo(), as a sum of terms that are all positive: where nearly all is reflected the difference would lose
// its digits.
GLINT_RELAXED vec3 specularPassed(Bsdf b, GLINT_RELAXED float loss, GLINT_RELAXED float bias) {
    GLINT_RELAXED vec3 absorbed = vec3(1.0) - b.f0;
    GLINT_RELAXED vec3 absorbedAtGrazing = vec3(1.0 - b.f90);
    GLINT_RELAXED vec3 again = vec3(1.0);  // 1 - multiScatterFresnel()
    if (GLINT_ENERGY_COMPENSATION != 0) {
        GLINT_RELAXED vec3 mean = meanFresnel(b);
        GLINT_RELAXED float meanLoss = b.meanLoss;
        GLINT_RELAXED vec3 rest = absorbed * (20.0 / 21.0) + absorbedAtGrazing * (1.0 / 21.0);
        again = rest * (vec3(1.0) + mean * (1.0 - meanLoss)) / (vec3(1.0) - mean * meanLoss);
    }
    return absorbed * (1.0 - loss - bias) + absorbedAtGrazing * bias + again * loss;
}

GLINT_RELAXED float smallest(GLINT_RELAXED vec3 v) {
    return min(v.x, min(v.y, v.z));
}

// How much of the fitted loss counts where the lobe is anisotropic: the fits are of isotropic lobes, and an anisotropic one
// loses less than either of its alphas along some azimuths. The thousands of lobes of the furnace test make no light so.
float lossShare(Bsdf b) {
    return 0.75 + 0.25 * min(b.alpha.x, b.alpha.y) / max(b.alpha.x, b.alpha.y);
}

// ggxAlbedo() of a lobe that may be anisotropic. E falls with alpha but for views near grazing, where it rises: with the
// lesser loss of either alpha, and the greater bias, no energy is made.
vec2 lobeAlbedo(Bsdf b, Features features, float cosine) {
    vec2 albedo = ggxAlbedo(cosine, b.alpha.x);
    if (hasLobe(features, GLINT_ANISOTROPY)) {
        vec2 other = ggxAlbedo(cosine, b.alpha.y);
        float loss = min(albedo.x, other.x) * lossShare(b);
        albedo = vec2(loss, min(max(albedo.y, other.y), 1.0 - loss));
    }
    return albedo;
}

// Takes the view, unit, in the frame of the surface.
void prepareBsdf(inout Bsdf b, Features features, vec3 view) {
    b.view = view;
    if (view.z < kMinViewCosine) {
        vec2 across = view.xy;
        float length2 = dot(across, across);
        b.view = vec3(length2 > 0.0 ? across * inversesqrt(length2) : vec2(1.0, 0.0), kMinViewCosine);
    }
    vec2 lossBias = lobeAlbedo(b, features, b.view.z);
    b.viewLoss = lossBias.x;
    b.viewBias = lossBias.y;
    vec2 mean = ggxMeanAlbedo(b.alpha.x);
    if (hasLobe(features, GLINT_ANISOTROPY)) {
        vec2 other = ggxMeanAlbedo(b.alpha.y);
        mean = vec2(min(mean.x, other.x) * lossShare(b), max(mean.y, other.y));
    }
    b.meanLoss = mean.x;
    b.meanBias = mean.y;
    b.sheenAlbedo = 0.0;
    if (hasLobe(features, GLINT_SHEEN)) {
        b.sheenAlbedo = sheenAlbedo(b.view.z, b.sheenAlpha);
    }
}

// Whether light passes without bending: then the facets that reflect and those that let through part ways, and the view
// alone decides between the two.
bool passesStraight(Features features, float eta) {
    return hasLobe(features, GLINT_VOLUME) && !refracts(eta);
}

// Whether the viewer is on the denser side of a volume's surface.
bool seenFromWithin(Bsdf b, Features features) {
    return hasLobe(features, GLINT_VOLUME) && b.eta.y < 1.0 && refracts(b.eta.y);
}

// What of a diffuse lobe the microfacets above it let in and out. With compensation, reciprocal and such that the whole
// reflects what comes in at most: Kelemen and Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model"
// (2001). Without it, glTF 2.0, appendix B.3.5: light by the Fresnel of the half vector.
GLINT_RELAXED float diffuseShare(Bsdf b, Features features, float lightCosine, GLINT_RELAXED float fresnel) {
    if (seenFromWithin(b, features)) {
        // Total reflection is no part of E: what the smooth interface lets through, both ways.
        vec2 view2 = exactSquare(vec2(b.view.z, 0.0));
        vec2 light2 = exactSquare(vec2(lightCosine, 0.0));
        return interfacePassed(b.f0, b.f90, view2, b.eta.y) * interfacePassed(b.f0, b.f90, light2, b.eta.y);
    }
    if (GLINT_ENERGY_COMPENSATION == 0) {
        return 1.0 - fresnel;
    }
    vec2 light = lobeAlbedo(b, features, lightCosine);
    float in1 = smallest(specularPassed(b, b.viewLoss, b.viewBias));
    float out1 = smallest(specularPassed(b, light.x, light.y));
    // Where all is reflected both vanish with the mean.
    float mean = max(smallest(specularPassed(b, b.meanLoss, b.meanBias)), 1e-6);
    return max(in1, 0.0) * max(out1, 0.0) / mean;
}

// Fresnel of the facet between view and light, and its normal.
GLINT_RELAXED vec3 facetFresnel(Bsdf b, Features features, vec3 l, out vec3 h) {
    // |v + l| is twice the cosine of v and h, and keeps its digits where facets are seen from the side.
    vec3 sum = b.view + l;
    float size = sqrt(dot(sum, sum));
    h = sum / size;
    return seenFromWithin(b, features) ? fresnelInterface(b.f0, b.f90, halfCosine2(b.view, l), b.eta.y)
                                       : fresnelSchlick(b.f0, b.f90, min(0.5 * size, 1.0));
}

// Reflected by the base, times n·l; l.z > 0.
vec3 baseReflection(Bsdf b, Features features, vec3 l) {
    vec3 h;
    GLINT_RELAXED vec3 fresnel = facetFresnel(b, features, l, h);
    vec3 specular = fresnel * (ggxDistribution(h, b.alpha) * ggxVisibility(l, b.view, b.alpha));
    if (GLINT_ENERGY_COMPENSATION != 0) {
        float lightLoss = lobeAlbedo(b, features, l.z).x;
        specular += multiScatterFresnel(b) * (b.viewLoss * lightLoss * kInversePi / max(b.meanLoss, 1e-12));
    }
    GLINT_RELAXED vec3 diffuse = b.diffuse * (kInversePi * diffuseShare(b, features, l.z, largest(fresnel)));
    return (diffuse + specular) * l.z;
}

// Passed by the microfacets at the index of one channel, times |n·l|; l.z < 0.
float specularTransmission(Bsdf b, Features features, vec3 l, float eta) {
    float cosine;
    float lobe;
    GLINT_RELAXED float passed;
    if (passesStraight(features, eta)) {
        // Nothing bends, whatever the facets: as sharp as lobes get, with the view's own Fresnel.
        lobe = thinTransmission(b.view, l, vec2(kMinAlpha), cosine);
        passed = schlickPassed(b.f0, b.f90, b.view.z);
    } else if (hasLobe(features, GLINT_VOLUME)) {
        lobe = refractedTransmission(b.view, l, b.alpha, eta, cosine);
        passed = schlickPassed(b.f0, b.f90, cosine);
    } else {
        lobe = thinTransmission(b.view, l, b.alpha, cosine);
        passed = schlickPassed(b.f0, b.f90, cosine);
    }
    return lobe * passed;
}

// Passed by the base, times |n·l|; l.z < 0.
vec3 baseTransmission(Bsdf b, Features features, vec3 l) {
    vec3 result = vec3(0.0);
    if (hasLobe(features, GLINT_TRANSMISSION)) {
        vec3 lobe = vec3(specularTransmission(b, features, l, b.eta.y));
        if (hasLobe(features, GLINT_DISPERSION)) {
            lobe.x = specularTransmission(b, features, l, b.eta.x);
            lobe.z = specularTransmission(b, features, l, b.eta.z);
        }
        result += b.transmitted * lobe;
    }
    if (hasLobe(features, GLINT_DIFFUSE_TRANSMISSION)) {
        // Light leaves on the other side: the half vector tells nothing, the view's own Fresnel does.
        GLINT_RELAXED float fresnel = largest(fresnelSchlick(b.f0, b.f90, b.view.z));
        result += b.diffuseTransmitted * (kInversePi * diffuseShare(b, features, -l.z, fresnel) * -l.z);
    }
    return result;
}

// Share of the base below the sheen, for light of one cosine: KHR_materials_sheen, albedo scaling.
GLINT_RELAXED float belowSheen(Bsdf b, float albedo) {
    GLINT_RELAXED float color = largest(b.sheenColor);
    GLINT_RELAXED float reflected = min(albedo, 1.0);
    return max(1.0 - color * reflected, 0.0);
}

// Cosine of the view to the coat's normal.
float coatViewCosine(Bsdf b) {
    return clamp(accurateDot(b.clearcoatNormal, b.view), kMinViewCosine, 1.0);
}

// BSDF times |n·l|, prepared for a view. l is unit, in the frame of the surface; l.z < 0 is on the far side.
vec3 evaluateBsdf(Bsdf b, Features features, vec3 l) {
    bool transmits = hasLobe(features, GLINT_TRANSMISSION) || hasLobe(features, GLINT_DIFFUSE_TRANSMISSION);
    vec3 result = vec3(0.0);
    if (l.z > 0.0) {
        result = baseReflection(b, features, l);
    } else if (transmits && l.z < 0.0) {
        result = baseTransmission(b, features, l);
    }
    if (hasLobe(features, GLINT_SHEEN)) {
        GLINT_RELAXED float below = belowSheen(b, b.sheenAlbedo);
        if (l.z > 0.0) {
            float lightAlbedo = sheenAlbedo(l.z, b.sheenAlpha);
            below = min(below, belowSheen(b, lightAlbedo));
            vec3 h = normalize(b.view + l);
            float lobe = sheenDistribution(h.x * h.x + h.y * h.y, b.sheenAlpha) *
                         sheenVisibility(l.z, b.view.z, b.sheenAlpha) /
                         max(max(b.sheenAlbedo, lightAlbedo), 1.0);
            result = result * below + b.sheenColor * (lobe * l.z);
        } else {
            result *= below;
        }
    }
    if (hasLobe(features, GLINT_CLEARCOAT)) {
        float nDotV = coatViewCosine(b);
        float nDotL = accurateDot(b.clearcoatNormal, l);
        GLINT_RELAXED float coat = clearcoatFresnel(b.clearcoat, nDotV);
        result *= clearcoatPassed(b.clearcoat, nDotV);
        if (l.z > 0.0 && nDotL > 0.0) {
            result += vec3(coat * nDotL *
                           clearcoatLobe(b.clearcoatNormal, nDotL, nDotV, b.view, l, b.clearcoatAlpha));
        }
    }
    return result;
}
