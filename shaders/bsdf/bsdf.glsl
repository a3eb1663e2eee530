// The BSDF of glTF materials: metallic-roughness (glTF 2.0, appendix B) and its extensions, in layers over a base that
// is part metal, part dielectric. A lobe leaves no code if no key of the case has it.
//
// A key with a model of a pack has that in place of the base (bsdf/model.glsl), whose functions then give 0: no
// microfacets, and the diffuse lobes stand for all that the model reflects and lets through.
//
// Appendix B.1 mixes two BRDFs: mix(dielectric, metal, metallic). Both have the same microfacets. A key with
// GLINT_PARTIAL_METAL has both bases; in any other key the base is all metal or all dielectric.
#include "generated/scene.glsl"
#include "bsdf/features.glsl"
#include "bsdf/constants.glsl"
#include "bsdf/exact.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/ggx.glsl"
#include "bsdf/albedo.glsl"
#include "bsdf/transmission.glsl"
#include "generated/layers.glsl"

// GLINT_RELAXED values are shares of light in [0, 1] and may have 16 bits (--precision 16). Directions, alphas, and
// losses, which vanish with alpha², keep 32 bits. Vectors are in the frame of the surface: z is the shading normal on
// the viewer's side, x the direction of anisotropy.
struct Bsdf {
    GLINT_RELAXED vec3 diffuse;   // albedo of the diffuse lobe, without metal and without what is transmitted
    GLINT_RELAXED vec3 f0;        // reflectance at normal incidence: of the dielectric if the key has both bases
    GLINT_RELAXED float f90;      // reflectance at grazing angles, of the same base as f0
    GLINT_RELAXED vec3 metalF0;   // reflectance of the metal at normal incidence; it is 1 at grazing angles
    GLINT_RELAXED float metallic; // share of the metal; this and metalF0 are read if the key has both bases
    vec2 alpha;     // of the microfacets along x and y, at least kMinAlpha; equal unless the key has anisotropy, where x is
                    // no smaller
    GLINT_RELAXED vec3 transmitted;         // tint and share of light that passes the microfacets
    vec3 eta;                 // n_t / n_i for red, green, blue; read if the key has a volume
    GLINT_RELAXED vec3 diffuseTransmitted;  // albedo of the diffuse lobe on the far side
    Layers layers;
#if GLINT_SHARED_LIGHTS
    float mirrored;           // share of the microfacets' first reflection, or of a model's light, that counts; 1
                              // unless rays bring the rest
#endif
    // prepareBsdf() sets the following members, which depend on the view:
    vec3 view;         // unit, z >= kMinViewCosine
    float viewLoss;    // 1 - E: the share that white microfacets lose by single scattering
    float viewBias;    // the part of E that (1 - v·h)⁵ weights
    float meanLoss;    // 2 ∫ (1 - E(μ)) μ dμ
    float meanBias;
};

// Returns a quantity of both bases together, given that of each.
GLINT_RELAXED vec3 withMetal(Bsdf b, Features features, GLINT_RELAXED vec3 dielectric, GLINT_RELAXED vec3 metal) {
    return hasBothBases(features) ? mix(dielectric, metal, b.metallic) : dielectric;
}

// The mean of Schlick's Fresnel over the hemisphere: 2 ∫ F(μ) μ dμ.
GLINT_RELAXED vec3 meanFresnel(GLINT_RELAXED vec3 f0, GLINT_RELAXED float f90) {
    return f0 + (vec3(f90) - f0) * (1.0 / 21.0);
}

// The multi-scatter lobe is this times (1 - E(v)) (1 - E(l)) / (π (1 - Ē)): Kulla and Conty, "Revisiting Physically
// Based Shading at Imageworks" (2017). The Fresnel of the second and later bounces is that of Hill (2018).
GLINT_RELAXED vec3 multiScatterOf(GLINT_RELAXED vec3 f0, GLINT_RELAXED float f90, float loss) {
    GLINT_RELAXED vec3 mean = meanFresnel(f0, f90);
    return mean * mean * (1.0 - loss) / (vec3(1.0) - mean * loss);
}

// Returns the same for both bases together. A bounce between facets of the same base is not linear in its reflectance.
GLINT_RELAXED vec3 multiScatterFresnel(Bsdf b, Features features) {
    return withMetal(b, features, multiScatterOf(b.f0, b.f90, b.meanLoss), multiScatterOf(b.metalF0, 1.0, b.meanLoss));
}

// The share of a uniform white sky that the microfacets reflect at the first bounce, from E's loss and bias.
GLINT_RELAXED vec3 singleScatterAlbedo(Bsdf b, Features features, GLINT_RELAXED float loss, GLINT_RELAXED float bias) {
    if (hasModel(features)) {
        return vec3(0.0);
    }
    GLINT_RELAXED vec3 dielectric = b.f0 * (1.0 - loss - bias) + vec3(b.f90 * bias);
    return withMetal(b, features, dielectric, b.metalF0 * (1.0 - loss - bias) + vec3(bias));
}

// The share that the microfacets reflect in all. With energy compensation this includes the later bounces.
GLINT_RELAXED vec3 specularAlbedo(Bsdf b, Features features, GLINT_RELAXED float loss, GLINT_RELAXED float bias) {
    if (hasModel(features)) {
        return vec3(0.0);
    }
    GLINT_RELAXED vec3 single = singleScatterAlbedo(b, features, loss, bias);
    return GLINT_ENERGY_COMPENSATION != 0 ? single + multiScatterFresnel(b, features) * loss : single;
}

// The share of the light that single scattering loses and that passes the dielectric's microfacets in the end: 1 -
// multiScatterFresnel(), or all of it without compensation.
GLINT_RELAXED vec3 passedAgain(Bsdf b) {
    if (GLINT_ENERGY_COMPENSATION == 0) {
        return vec3(1.0);
    }
    GLINT_RELAXED vec3 absorbed = vec3(1.0) - b.f0;
    GLINT_RELAXED vec3 absorbedAtGrazing = vec3(1.0 - b.f90);
    GLINT_RELAXED vec3 mean = meanFresnel(b.f0, b.f90);
    GLINT_RELAXED float meanLoss = b.meanLoss;
    GLINT_RELAXED vec3 rest = absorbed * (20.0 / 21.0) + absorbedAtGrazing * (1.0 / 21.0);
    return rest * (vec3(1.0) + mean * (1.0 - meanLoss)) / (vec3(1.0) - mean * meanLoss);
}

// The share that the microfacets of the dielectric do not reflect: 1 - specularAlbedo() without metal. It is a sum of
// positive terms; the difference would lose its digits where nearly all light is reflected.
GLINT_RELAXED vec3 specularPassed(Bsdf b, GLINT_RELAXED float loss, GLINT_RELAXED float bias) {
    GLINT_RELAXED vec3 absorbed = vec3(1.0) - b.f0;
    GLINT_RELAXED vec3 absorbedAtGrazing = vec3(1.0 - b.f90);
    return absorbed * (1.0 - loss - bias) + absorbedAtGrazing * bias + passedAgain(b) * loss;
}

// The part of specularPassed() that a white lobe lets through at the first bounce: the albedo of thinTransmission()
// with Fresnel.
GLINT_RELAXED float passedOnce(Bsdf b) {
    return (1.0 - largest(b.f0)) * (1.0 - b.viewLoss - b.viewBias) + (1.0 - b.f90) * b.viewBias;
}

// The loss 1 - E and the bias of the microfacets in a direction of the upper hemisphere.
vec2 lobeAlbedo(Bsdf b, Features features, vec3 direction) {
    if (isAnisotropic(features)) {
        return anisotropicGgxAlbedo(direction, b.alpha);
    }
    return ggxAlbedo(direction.z, b.alpha.x);
}

// Prepares the BSDF for a view, which is a unit vector in the frame of the surface.
void prepareBsdf(inout Bsdf b, Features features, vec3 view) {
    b.view = view;
    if (view.z < kMinViewCosine) {
        vec2 across = view.xy;
        float length2 = dot(across, across);
        b.view = vec3(length2 > 0.0 ? across * inversesqrt(length2) : vec2(1.0, 0.0), kMinViewCosine);
    }
#if GLINT_MODELS
    if (hasModel(features)) {
        b.viewLoss = b.viewBias = b.meanLoss = b.meanBias = 0.0;
        prepareModel(b.layers, features, b.view);
        prepareLayers(b.layers, features, b.view);
        return;
    }
#endif
    vec2 lossBias = lobeAlbedo(b, features, b.view);
    b.viewLoss = lossBias.x;
    b.viewBias = lossBias.y;
    vec2 mean = isAnisotropic(features) ? anisotropicGgxMeanAlbedo(b.alpha) : ggxMeanAlbedo(b.alpha.x);
    b.meanLoss = mean.x;
    b.meanBias = mean.y;
    prepareLayers(b.layers, features, b.view);
}

// These are macros, as hasLobe() is, so that what a module decides is known before functions are inlined.

// Whether light passes without bending. The facets that reflect and those that let light through then differ, and the
// view alone decides between the two.
#define passesStraight(features, eta) (boundsMedium(features) && !refracts(eta))

// Whether the viewer is on the denser side of a volume's surface.
#define seenFromWithin(b, features)                                                                             \
    (boundsMedium(features) && (b).eta.y < 1.0 && refracts((b).eta.y))

// Whether light that the facets of a volume block still leaves along their own directions, as in the walk of refracted
// rays: mirrored at the plane if these point to its other side. Then an interface loses nothing. The albedo of a lobe
// that bends, by which its light could be divided instead, is not known in closed form.
#define keepsBlocked(features, eta)                                                                             \
    (GLINT_ENERGY_COMPENSATION != 0 && boundsMedium(features) && !passesStraight(features, eta))

// The share of a diffuse lobe that the microfacets above it let in and out. With compensation it is reciprocal, and the
// whole gains no energy: Kelemen and Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model" (2001).
// Without it, light enters by the Fresnel of the half vector: glTF 2.0, appendix B.3.5. l.z > 0; light on the far side
// is mirrored.
GLINT_RELAXED float diffuseShare(Bsdf b, Features features, vec3 l, GLINT_RELAXED float fresnel) {
    if (seenFromWithin(b, features)) {
        if (keepsBlocked(features, b.eta.y)) {
            return 0.0;  // The facets take all: volumeBsdf() removes the diffuse lobes from within.
        }
        // E does not include total reflection, so this uses the light that the smooth interface lets through, in both
        // directions.
        vec2 view2 = exactSquare(vec2(b.view.z, 0.0));
        vec2 light2 = exactSquare(vec2(l.z, 0.0));
        return interfacePassed(b.f0, b.f90, view2, b.eta.y) * interfacePassed(b.f0, b.f90, light2, b.eta.y);
    }
    if (GLINT_ENERGY_COMPENSATION == 0) {
        return 1.0 - fresnel;
    }
    vec2 light = lobeAlbedo(b, features, l);
    float in1 = smallest(specularPassed(b, b.viewLoss, b.viewBias));
    float out1 = smallest(specularPassed(b, light.x, light.y));
    // If all light is reflected, both factors vanish together with the mean.
    float mean = max(smallest(specularPassed(b, b.meanLoss, b.meanBias)), 1e-6);
    return max(in1, 0.0) * max(out1, 0.0) / mean;
}

// The Fresnel reflectance of the facet between view and light.
struct Facet {
    vec3 h;  // the facet's normal
    GLINT_RELAXED vec3 fresnel;            // of both bases
    GLINT_RELAXED vec3 dielectricFresnel;  // of the dielectric, below which light reaches the diffuse lobe
};

Facet facetBetween(Bsdf b, Features features, vec3 l) {
    // |v + l| is twice the cosine between v and h. It keeps its digits if a facet is seen from the side.
    vec3 sum = b.view + l;
    float size = sqrt(dot(sum, sum));
    float cosine = min(0.5 * size, 1.0);
    Facet facet;
    facet.h = sum / size;
    facet.dielectricFresnel = seenFromWithin(b, features)
                                  ? fresnelInterface(b.f0, b.f90, halfCosine2(b.view, l), b.eta.y)
                                  : fresnelSchlick(b.f0, b.f90, cosine);
    facet.fresnel = withMetal(b, features, facet.dielectricFresnel, fresnelSchlick(b.metalF0, 1.0, cosine));
    return facet;
}

// Whether a thin wall lets light that its facets block through in a lobe of its own.
#define scattersPassage(features)                                                                               \
    (GLINT_ENERGY_COMPENSATION != 0 && passesFacets(features) && !boundsMedium(features))

// The density with which visible facets send the view to l, or with l.z < 0 to below the plane: mirroredPdf(). It is 0
// where rounding leaves no half vector.
float facetDensity(Bsdf b, vec3 l) {
    vec3 sum = b.view + l;
    float size = sqrt(dot(sum, sum));
    vec3 h = sum / max(size, 1e-12);
    // v·h is half of the size.
    return h.z > 0.0 && dot(b.view, h) < size ? mirroredPdf(b.view, h, b.alpha) : 0.0;
}

// Light that the facets of a volume's surface reflect to l within it, where l may be below the plane.
vec3 facetReflection(Bsdf b, vec3 l) {
    return fresnelInterface(b.f0, b.f90, halfCosine2(b.view, l), b.eta.y) * facetDensity(b, l);
}

// Light that metal reflects, times n·l.
vec3 metalReflection(Bsdf b, Features features, vec3 l) {
    vec3 h = normalize(b.view + l);
    vec3 once = fresnelSchlick(b.metalF0, 1.0, min(dot(b.view, h), 1.0)) *
                (ggxDistribution(h, b.alpha) * ggxVisibility(l, b.view, b.alpha));
    float lightLoss = lobeAlbedo(b, features, l).x;
    return (once + multiScatterOf(b.metalF0, 1.0, b.meanLoss) *
                       (b.viewLoss * lightLoss * kInversePi / max(b.meanLoss, 1e-12))) * l.z;
}

// Light that the base reflects, times n·l; l.z > 0.
vec3 baseReflection(Bsdf b, Features features, vec3 l) {
    // One lobe after the other, so that what one needs does not wait in registers while another is computed.
    GLINT_RELAXED float fresnel =
        GLINT_ENERGY_COMPENSATION != 0 ? 0.0 : largest(facetBetween(b, features, l).dielectricFresnel);
    GLINT_RELAXED vec3 diffuse = diffuseLobe(b.layers, features, b.diffuse, b.view, l) *
                                 (kInversePi * diffuseShare(b, features, l, fresnel));
    if (seenFromWithin(b, features) && keepsBlocked(features, b.eta.y)) {
        vec3 within = facetReflection(b, l) + facetReflection(b, vec3(l.xy, -l.z));
        if (hasBothBases(features)) {
            within = mix(within, metalReflection(b, features, l), b.metallic);
        }
        return diffuse * l.z + within;
    }
    vec3 reflected = diffuse;
    if (GLINT_ENERGY_COMPENSATION != 0) {
        float lightLoss = lobeAlbedo(b, features, l).x;
        reflected += multiScatterFresnel(b, features) * (b.viewLoss * lightLoss * kInversePi / max(b.meanLoss, 1e-12));
    }
    Facet facet = facetBetween(b, features, l);
    vec3 specular = facet.fresnel * (ggxDistribution(facet.h, b.alpha) * ggxVisibility(l, b.view, b.alpha));
#if GLINT_SHARED_LIGHTS
    specular *= b.mirrored;
#endif
    return (reflected + specular) * l.z;
}

// Light that the microfacets pass, at the index of one channel, times |n·l|; l.z < 0.
float specularTransmission(Bsdf b, Features features, vec3 l, float eta) {
    float cosine;
    float lobe;
    GLINT_RELAXED float passed;
    if (passesStraight(features, eta)) {
        // Nothing bends, whatever the facets are: the lobe is as narrow as lobes get, with the Fresnel of the view.
        lobe = thinTransmission(b.view, l, vec2(kMinAlpha), cosine);
        passed = schlickPassed(b.f0, b.f90, b.view.z);
    } else if (boundsMedium(features)) {
        lobe = refractedTransmission(b.view, l, b.alpha, eta, cosine);
        passed = schlickPassed(b.f0, b.f90, cosine);
    } else {
        lobe = thinTransmission(b.view, l, b.alpha, cosine);
        passed = schlickPassed(b.f0, b.f90, cosine);
    }
    return lobe * passed;
}

// All light that a volume's facets pass from outside, over the light that they pass at the first bounce if none blocks
// another.
GLINT_RELAXED float passedShare(Bsdf b) {
    // The mean of (1 - v·h)^5 over visible facets: over those whose reflection leaves it is the bias, and those whose
    // reflection is blocked have about this cosine. Facets block each other by their slopes towards the view.
    vec2 along = b.view.xy * b.view.xy + 1e-4;
    float alpha = sqrt(dot(along, b.alpha * b.alpha) / (along.x + along.y));
    vec2 blocked = vec2(0.65 * alpha / (1.0 + 0.62 * alpha * alpha), (0.64 - 0.38 * alpha) * b.view.z);
    float rest = 1.0 - min(sqrt(dot(blocked, blocked)), 1.0);
    float mean = b.viewBias + b.viewLoss * rest * rest * rest * rest * rest;
    GLINT_RELAXED float reflected = mix(largest(b.f0), b.f90, mean);
    return max(smallest(specularPassed(b, b.viewLoss, b.viewBias)), 0.0) / max(1.0 - reflected, 1e-3);
}

// The density with which visible facets bend the view to l, for the index of one channel, times their transmittance.
float bentLight(Bsdf b, vec3 l, float eta) {
    RefractingFacet facet;
    if (!refractionHalfVector(b.view, l, eta, facet)) {
        return 0.0;
    }
    float passed = eta < 1.0 ? schlickPassed(b.f0, b.f90, facet.cosineL)
                             : schlickPassed(b.f0, b.f90, facet.cosineV) * passedShare(b);
    return passed * visibleNormalPdf(b.view, facet.h, b.alpha) * facet.spread * facet.cosineL;
}

// specularTransmission() with the light that a volume's facets block.
float wholeTransmission(Bsdf b, Features features, vec3 l, float eta) {
    if (!keepsBlocked(features, eta)) {
        return specularTransmission(b, features, l, eta);
    }
    float bent = 0.0;
    for (int side = 0; side < 2; ++side) {
        bent += bentLight(b, vec3(l.xy, side == 0 ? l.z : -l.z), eta);
    }
    return bent;
}

// Light that the base passes, times |n·l|; l.z < 0.
vec3 baseTransmission(Bsdf b, Features features, vec3 l) {
    vec3 result = vec3(0.0);
    if (passesFacets(features)) {
        bool spreads = dispersesLight(features);
        vec3 lobe = vec3(0.0);
        for (int channel = spreads ? 0 : 1; channel < (spreads ? 3 : 2); ++channel) {
            lobe = withChannel(lobe, channel, wholeTransmission(b, features, l, channelOf(b.eta, channel)));
        }
        result += b.transmitted * (spreads ? lobe : vec3(lobe.y));
        if (scattersPassage(features)) {
            // Kulla and Conty's lobe of several bounces, on the far side.
            float lightLoss = lobeAlbedo(b, features, vec3(l.xy, -l.z)).x;
            result += b.transmitted * (smallest(passedAgain(b)) * -l.z *
                                       (b.viewLoss * lightLoss * kInversePi / max(b.meanLoss, 1e-12)));
        }
    }
    if (passesDiffusely(features)) {
        // Light leaves on the other side, where the half vector has no meaning, so the Fresnel of the view counts.
        GLINT_RELAXED float fresnel = largest(fresnelSchlick(b.f0, b.f90, b.view.z));
        result += b.diffuseTransmitted * (kInversePi * diffuseShare(b, features, vec3(l.xy, -l.z), fresnel) * -l.z);
    }
    return result;
}

#if GLINT_SHARED_LIGHTS

// Returns π times the light that the diffuse lobes of the base send from l to the view, through the layers above it. It
// is their part of evaluateBsdf(): rays that share the light with samples must bring the same.
vec3 evaluateDiffuse(Bsdf b, Features features, vec3 l) {
    vec3 base = vec3(0.0);
#if GLINT_MODELS
    if (hasModel(features)) {
        if (l.z > 0.0 || transmits(features)) {
            // Both vanish together where light grazes the surface.
            base = evaluateModel(b.layers, features, b.view, l) * (kPi / max(abs(l.z), 1e-6));
        }
    } else
#endif
    if (l.z > 0.0) {
        GLINT_RELAXED float fresnel = largest(facetBetween(b, features, l).dielectricFresnel);
        base = diffuseLobe(b.layers, features, b.diffuse, b.view, l) * diffuseShare(b, features, l, fresnel);
    } else if (passesDiffusely(features)) {
        GLINT_RELAXED float fresnel = largest(fresnelSchlick(b.f0, b.f90, b.view.z));
        base = b.diffuseTransmitted * diffuseShare(b, features, vec3(l.xy, -l.z), fresnel);
    }
    // The layers count without their own reflection. That of mirrors would cost the digits of the difference.
    b.layers.counted = noLayerShares();
    return addLayersAbove(b.layers, features, b.view, l, l.z, base) -
           addLayersAbove(b.layers, features, b.view, l, l.z, vec3(0.0));
}

#endif

// Returns the light that the base reflects or transmits, times |n·l|, without the layers above it.
vec3 evaluateBase(Bsdf b, Features features, vec3 l) {
#if GLINT_MODELS
    if (hasModel(features)) {
        vec3 light = l.z > 0.0 || transmits(features) ? evaluateModel(b.layers, features, b.view, l) : vec3(0.0);
#if GLINT_SHARED_LIGHTS
        light *= b.mirrored;
#endif
        return light;
    }
#endif
    if (l.z > 0.0) {
        return baseReflection(b, features, l);
    }
    return transmits(features) && l.z < 0.0 ? baseTransmission(b, features, l) : vec3(0.0);
}

// Returns the BSDF times |n·l| for the prepared view. l is a unit vector in the frame of the surface; if l.z < 0 it is
// on the far side.
vec3 evaluateBsdf(Bsdf b, Features features, vec3 l) {
    return addLayers(b.layers, features, b.view, l, evaluateBase(b, features, l));
}
