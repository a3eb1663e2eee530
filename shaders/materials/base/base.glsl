// Glint's own base: metallic-roughness (glTF 2.0, appendix B) and its extensions. Appendix B.1 mixes the BRDFs of a
// dielectric and a metal with the same microfacets: mix(dielectric, metal, metallic). A key has both if hasBothBases();
// in any other key the base is all metal or all dielectric. As a model of a pack (bsdf/model.glsl), it is a struct with
// functions that prepare, evaluate and sample it. They take the features too, because a lobe leaves no code if no key
// of the case has it.
#include "bsdf/albedo.glsl"
#include "bsdf/features.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/ggx.glsl"
#include "bsdf/layer.glsl"
#include "bsdf/transmission.glsl"

// GLINT_RELAXED values are shares of light in [0, 1] and may have 16 bits (--precision 16). Directions, alphas, and
// losses, which vanish with alpha², keep 32 bits.
struct Base {
    GLINT_RELAXED vec3 f0;           // reflectance at normal incidence: of the dielectric if the key has both bases
    GLINT_RELAXED float f90;         // reflectance at grazing angles, of the same base as f0
    GLINT_RELAXED vec3 metalF0;      // reflectance of the metal at normal incidence; it is 1 at grazing angles
    GLINT_RELAXED float metallic;    // share of the metal; this and metalF0 are read if the key has both bases
    vec2 alpha;                      // of facets along x and y, at least kMinAlpha; x >= y, equal without anisotropy
    GLINT_RELAXED vec3 transmitted;  // tint and share of light that passes the microfacets
    vec3 eta;                        // n_t / n_i for red, green, blue; read if the key has a volume
#if GLINT_SHARED_LIGHTS
    float mirrored;                  // share of the first reflection that counts; 1 unless rays bring the rest
#endif
    // basePrepare() sets the following members, which depend on the view:
    float viewLoss;  // 1 - E: the share that white microfacets lose by single scattering
    float viewBias;  // the part of E that (1 - v·h)⁵ weights
    float meanLoss;  // 2 ∫ (1 - E(μ)) μ dμ
    float meanBias;
};

// Returns a quantity of both bases together, given that of each.
GLINT_RELAXED vec3 withMetal(Base b, Features features, GLINT_RELAXED vec3 dielectric, GLINT_RELAXED vec3 metal) {
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
GLINT_RELAXED vec3 multiScatterFresnel(Base b, Features features) {
    return withMetal(b, features, multiScatterOf(b.f0, b.f90, b.meanLoss), multiScatterOf(b.metalF0, 1.0, b.meanLoss));
}

// The share of a uniform white sky that the microfacets reflect at the first bounce.
GLINT_RELAXED vec3 singleScatterAlbedo(Base b, Features features) {
    GLINT_RELAXED float loss = b.viewLoss;
    GLINT_RELAXED float bias = b.viewBias;
    GLINT_RELAXED vec3 dielectric = b.f0 * (1.0 - loss - bias) + vec3(b.f90 * bias);
    return withMetal(b, features, dielectric, b.metalF0 * (1.0 - loss - bias) + vec3(bias));
}

// The share that the microfacets reflect in all. With energy compensation this includes the later bounces.
GLINT_RELAXED vec3 specularAlbedo(Base b, Features features) {
    GLINT_RELAXED float loss = b.viewLoss;
    GLINT_RELAXED vec3 single = singleScatterAlbedo(b, features);
    return GLINT_ENERGY_COMPENSATION != 0 ? single + multiScatterFresnel(b, features) * loss : single;
}

// The share of the light that single scattering loses and that passes the dielectric's microfacets in the end: 1 -
// multiScatterFresnel(), or all of it without compensation.
GLINT_RELAXED vec3 passedAgain(Base b) {
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

// The share that the microfacets of the dielectric do not reflect, from a loss and a bias: 1 - specularAlbedo() without
// metal. It is a sum of positive terms; the difference would lose its digits where nearly all light is reflected.
GLINT_RELAXED vec3 specularPassed(Base b, GLINT_RELAXED float loss, GLINT_RELAXED float bias) {
    GLINT_RELAXED vec3 absorbed = vec3(1.0) - b.f0;
    GLINT_RELAXED vec3 absorbedAtGrazing = vec3(1.0 - b.f90);
    return absorbed * (1.0 - loss - bias) + absorbedAtGrazing * bias + passedAgain(b) * loss;
}

// The share of a uniform sky's light that the microfacets let through to the diffuse lobes, for the prepared view.
GLINT_RELAXED float diffusePassed(Base b) {
    return max(smallest(specularPassed(b, b.viewLoss, b.viewBias)), 0.0);
}

// The part of diffusePassed() that a white lobe lets through at the first bounce: the albedo of thinTransmission()
// with Fresnel.
GLINT_RELAXED float passedOnce(Base b) {
    return (1.0 - largest(b.f0)) * (1.0 - b.viewLoss - b.viewBias) + (1.0 - b.f90) * b.viewBias;
}

// The loss 1 - E and the bias of the microfacets in a direction of the upper hemisphere.
vec2 lobeAlbedo(Base b, Features features, vec3 direction) {
    if (isAnisotropic(features)) {
        return anisotropicGgxAlbedo(direction, b.alpha);
    }
    return ggxAlbedo(direction.z, b.alpha.x);
}

void basePrepare(inout Base b, Features features, vec3 view) {
    vec2 lossBias = lobeAlbedo(b, features, view);
    b.viewLoss = lossBias.x;
    b.viewBias = lossBias.y;
    vec2 mean = isAnisotropic(features) ? anisotropicGgxMeanAlbedo(b.alpha) : ggxMeanAlbedo(b.alpha.x);
    b.meanLoss = mean.x;
    b.meanBias = mean.y;
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

// The Fresnel reflectance of the facet between view and light.
struct Facet {
    vec3 h;  // the facet's normal
    GLINT_RELAXED vec3 fresnel;            // of both bases
    GLINT_RELAXED vec3 dielectricFresnel;  // of the dielectric, below which light reaches the diffuse lobe
};

Facet facetBetween(Base b, Features features, vec3 view, vec3 l) {
    // |v + l| is twice the cosine between v and h. It keeps its digits if a facet is seen from the side.
    vec3 sum = view + l;
    float size = sqrt(dot(sum, sum));
    float cosine = min(0.5 * size, 1.0);
    Facet facet;
    facet.h = sum / size;
    facet.dielectricFresnel = seenFromWithin(b, features)
                                  ? fresnelInterface(b.f0, b.f90, halfCosine2(view, l), b.eta.y)
                                  : fresnelSchlick(b.f0, b.f90, cosine);
    facet.fresnel = withMetal(b, features, facet.dielectricFresnel, fresnelSchlick(b.metalF0, 1.0, cosine));
    return facet;
}

// The share of a diffuse lobe that the microfacets above it let in and out. With compensation it is reciprocal, and the
// whole gains no energy: Kelemen and Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model" (2001).
// Without it, light enters by the Fresnel of the half vector: glTF 2.0, appendix B.3.5. l.z > 0; light from behind is
// mirrored. There the half vector has no meaning, and the Fresnel of the view counts.
GLINT_RELAXED float diffuseShare(Base b, Features features, vec3 view, vec3 l, bool behind) {
    GLINT_RELAXED vec3 fresnel = vec3(0.0);
    if (GLINT_ENERGY_COMPENSATION == 0) {
        fresnel = behind ? fresnelSchlick(b.f0, b.f90, view.z) : facetBetween(b, features, view, l).dielectricFresnel;
    }
    if (seenFromWithin(b, features)) {
        if (keepsBlocked(features, b.eta.y)) {
            return 0.0;  // The facets take all: volumeBsdf() removes the diffuse lobes from within.
        }
        // E does not include total reflection, so this uses the light that the smooth interface lets through, in both
        // directions.
        vec2 view2 = exactSquare(vec2(view.z, 0.0));
        vec2 light2 = exactSquare(vec2(l.z, 0.0));
        return interfacePassed(b.f0, b.f90, view2, b.eta.y) * interfacePassed(b.f0, b.f90, light2, b.eta.y);
    }
    if (GLINT_ENERGY_COMPENSATION == 0) {
        return 1.0 - largest(fresnel);
    }
    vec2 light = lobeAlbedo(b, features, l);
    float in1 = smallest(specularPassed(b, b.viewLoss, b.viewBias));
    float out1 = smallest(specularPassed(b, light.x, light.y));
    // If all light is reflected, both factors vanish together with the mean.
    float mean = max(smallest(specularPassed(b, b.meanLoss, b.meanBias)), 1e-6);
    return max(in1, 0.0) * max(out1, 0.0) / mean;
}

// Whether a thin wall lets light that its facets block through in a lobe of its own.
#define scattersPassage(features)                                                                               \
    (GLINT_ENERGY_COMPENSATION != 0 && passesFacets(features) && !boundsMedium(features))

// The density with which visible facets send the view to l, or with l.z < 0 to below the plane: mirroredPdf(). It is 0
// where rounding leaves no half vector.
float facetDensity(Base b, vec3 view, vec3 l) {
    vec3 sum = view + l;
    float size = sqrt(dot(sum, sum));
    vec3 h = sum / max(size, 1e-12);
    // v·h is half of the size.
    return h.z > 0.0 && dot(view, h) < size ? mirroredPdf(view, h, b.alpha) : 0.0;
}

// Light that the facets of a volume's surface reflect to l within it, where l may be below the plane.
vec3 facetReflection(Base b, vec3 view, vec3 l) {
    return fresnelInterface(b.f0, b.f90, halfCosine2(view, l), b.eta.y) * facetDensity(b, view, l);
}

// Light that metal reflects, times n·l.
vec3 metalReflection(Base b, Features features, vec3 view, vec3 l) {
    vec3 h = normalize(view + l);
    vec3 once = fresnelSchlick(b.metalF0, 1.0, min(dot(view, h), 1.0)) *
                (ggxDistribution(h, b.alpha) * ggxVisibility(l, view, b.alpha));
    float lightLoss = lobeAlbedo(b, features, l).x;
    return (once + multiScatterOf(b.metalF0, 1.0, b.meanLoss) *
                       (b.viewLoss * lightLoss * kInversePi / max(b.meanLoss, 1e-12))) * l.z;
}

// Light that the base reflects, times n·l; l.z > 0. `lobe` is π times the BRDF of the diffuse lobe.
vec3 baseReflection(Base b, Features features, vec3 view, vec3 l, GLINT_RELAXED vec3 lobe) {
    // One lobe after the other, so that what one needs does not wait in registers while another is computed.
    GLINT_RELAXED vec3 diffuse = lobe * (kInversePi * diffuseShare(b, features, view, l, false));
    if (seenFromWithin(b, features) && keepsBlocked(features, b.eta.y)) {
        vec3 within = facetReflection(b, view, l) + facetReflection(b, view, vec3(l.xy, -l.z));
        if (hasBothBases(features)) {
            within = mix(within, metalReflection(b, features, view, l), b.metallic);
        }
        return diffuse * l.z + within;
    }
    vec3 reflected = diffuse;
    if (GLINT_ENERGY_COMPENSATION != 0) {
        float lightLoss = lobeAlbedo(b, features, l).x;
        reflected += multiScatterFresnel(b, features) * (b.viewLoss * lightLoss * kInversePi / max(b.meanLoss, 1e-12));
    }
    Facet facet = facetBetween(b, features, view, l);
    vec3 specular = facet.fresnel * (ggxDistribution(facet.h, b.alpha) * ggxVisibility(l, view, b.alpha));
#if GLINT_SHARED_LIGHTS
    specular *= b.mirrored;
#endif
    return (reflected + specular) * l.z;
}

// Light that the microfacets pass, at the index of one channel, times |n·l|; l.z < 0.
float specularTransmission(Base b, Features features, vec3 view, vec3 l, float eta) {
    float cosine;
    float lobe;
    GLINT_RELAXED float passed;
    if (passesStraight(features, eta)) {
        // Nothing bends, whatever the facets are: the lobe is as narrow as lobes get, with the Fresnel of the view.
        lobe = thinTransmission(view, l, vec2(kMinAlpha), cosine);
        passed = schlickPassed(b.f0, b.f90, view.z);
    } else if (boundsMedium(features)) {
        lobe = refractedTransmission(view, l, b.alpha, eta, cosine);
        passed = schlickPassed(b.f0, b.f90, cosine);
    } else {
        lobe = thinTransmission(view, l, b.alpha, cosine);
        passed = schlickPassed(b.f0, b.f90, cosine);
    }
    return lobe * passed;
}

// All light that a volume's facets pass from outside, over the light that they pass at the first bounce if none blocks
// another.
GLINT_RELAXED float passedShare(Base b, vec3 view) {
    // The mean of (1 - v·h)^5 over visible facets: over those whose reflection leaves it is the bias, and those whose
    // reflection is blocked have about this cosine. Facets block each other by their slopes towards the view.
    vec2 along = view.xy * view.xy + 1e-4;
    float alpha = sqrt(dot(along, b.alpha * b.alpha) / (along.x + along.y));
    vec2 blocked = vec2(0.65 * alpha / (1.0 + 0.62 * alpha * alpha), (0.64 - 0.38 * alpha) * view.z);
    float rest = 1.0 - min(sqrt(dot(blocked, blocked)), 1.0);
    float mean = b.viewBias + b.viewLoss * rest * rest * rest * rest * rest;
    GLINT_RELAXED float reflected = mix(largest(b.f0), b.f90, mean);
    return diffusePassed(b) / max(1.0 - reflected, 1e-3);
}

// The density with which visible facets bend the view to l, for the index of one channel, times their transmittance.
float bentLight(Base b, vec3 view, vec3 l, float eta) {
    RefractingFacet facet;
    if (!refractionHalfVector(view, l, eta, facet)) {
        return 0.0;
    }
    float passed = eta < 1.0 ? schlickPassed(b.f0, b.f90, facet.cosineL)
                             : schlickPassed(b.f0, b.f90, facet.cosineV) * passedShare(b, view);
    return passed * visibleNormalPdf(view, facet.h, b.alpha) * facet.spread * facet.cosineL;
}

// specularTransmission() with the light that a volume's facets block.
float wholeTransmission(Base b, Features features, vec3 view, vec3 l, float eta) {
    if (!keepsBlocked(features, eta)) {
        return specularTransmission(b, features, view, l, eta);
    }
    float bent = 0.0;
    for (int side = 0; side < 2; ++side) {
        bent += bentLight(b, view, vec3(l.xy, side == 0 ? l.z : -l.z), eta);
    }
    return bent;
}

// Light that the base passes, times |n·l|; l.z < 0. `lobe` is π times the BTDF of the diffuse lobe.
vec3 baseTransmission(Base b, Features features, vec3 view, vec3 l, GLINT_RELAXED vec3 lobe) {
    vec3 result = vec3(0.0);
    if (passesFacets(features)) {
        bool spreads = dispersesLight(features);
        vec3 facets = vec3(0.0);
        for (int channel = spreads ? 0 : 1; channel < (spreads ? 3 : 2); ++channel) {
            facets = withChannel(facets, channel, wholeTransmission(b, features, view, l, channelOf(b.eta, channel)));
        }
        result += b.transmitted * (spreads ? facets : vec3(facets.y));
        if (scattersPassage(features)) {
            // Kulla and Conty's lobe of several bounces, on the far side.
            float lightLoss = lobeAlbedo(b, features, vec3(l.xy, -l.z)).x;
            result += b.transmitted * (smallest(passedAgain(b)) * -l.z *
                                       (b.viewLoss * lightLoss * kInversePi / max(b.meanLoss, 1e-12)));
        }
    }
    if (passesDiffusely(features)) {
        result += lobe * (kInversePi * diffuseShare(b, features, view, vec3(l.xy, -l.z), true) * -l.z);
    }
    return result;
}

// The shares of a uniform white sky's light by which the base is sampled: by baseSample() (x), cosine-weighted (y), and
// cosine-weighted on the far side (z). `diffuse` and `behind` are the albedos of the diffuse lobes.
vec3 baseChances(Base b, Features features, GLINT_RELAXED vec3 diffuse, GLINT_RELAXED vec3 behind) {
    vec3 single = singleScatterAlbedo(b, features);
    vec3 all = specularAlbedo(b, features);
    float below = diffusePassed(b);
    float facets = luminance(single);
    float passed = 0.0;
    if (passesFacets(features)) {
        float later = scattersPassage(features) ? smallest(passedAgain(b)) * b.viewLoss : 0.0;
        facets += luminance(b.transmitted) * max(below - later, 0.0);
        passed = luminance(b.transmitted) * later;
    }
    if (passesDiffusely(features)) {
        passed += luminance(behind) * below;
    }
    return vec3(facets, luminance(diffuse) * below + luminance(all - single), passed);
}

// The probabilities that a facet reflects (x) and that it lets light through (y), from the squared cosine under which
// it is seen, with the error of the square.
vec2 facetChances(Base b, Features features, vec2 cosine2, float eta) {
    if (!passesFacets(features)) {
        return vec2(1.0, 0.0);
    }
    bool inside = boundsMedium(features) && eta < 1.0 && refracts(eta);
    float apparent = inside ? eta : 1.0;
    float reflected = luminance(withMetal(b, features, fresnelInterface(b.f0, b.f90, cosine2, apparent),
                                          fresnelSchlick(b.metalF0, 1.0, sqrt(cosine2.x))));
    float passed = luminance(b.transmitted) * interfacePassed(b.f0, b.f90, cosine2, apparent);
    float both = reflected + passed;
    return both > 0.0 ? vec2(reflected, passed) / both : vec2(1.0, 0.0);
}

// The squared cosine that decides between reflection and passage. It is that of the facet, `facet2`, unless light
// passes straight.
vec2 decidingCosine2(Features features, vec3 view, vec2 facet2, float eta) {
    return passesStraight(features, eta) ? exactSquare(vec2(view.z, 0.0)) : facet2;
}

// The index of one of three colours. They differ only with dispersion.
float sampledIndex(Base b, Features features, float u) {
    if (dispersesLight(features)) {
        return u < 1.0 / 3.0 ? b.eta.x : u < 2.0 / 3.0 ? b.eta.y : b.eta.z;
    }
    return b.eta.y;
}

// The density of a direction to which facets bend the view, for the index of one colour.
float bendingPdf(Base b, Features features, vec3 view, vec3 l, float eta) {
    RefractingFacet facet;
    if (!refractionHalfVector(view, l, eta, facet)) {
        return 0.0;
    }
    return facetChances(b, features, exactSquare(vec2(facet.cosineV, 0.0)), eta).y *
           visibleNormalPdf(view, facet.h, b.alpha) * facet.spread * facet.cosineL;
}

// The density of a direction beyond the microfacets, for the index of one colour.
float passedPdf(Base b, Features features, vec3 view, vec3 l, float eta) {
    if (!boundsMedium(features) || passesStraight(features, eta)) {
        vec3 mirrored = vec3(l.x, l.y, -l.z);
        vec3 h = normalize(view + mirrored);
        vec2 alpha = passesStraight(features, eta) ? vec2(kMinAlpha) : b.alpha;
        return facetChances(b, features, decidingCosine2(features, view, halfCosine2(view, mirrored), eta), eta).y *
               mirroredPdf(view, h, alpha);
    }
    float pdf = bendingPdf(b, features, view, l, eta);
    return keepsBlocked(features, eta) ? pdf + bendingPdf(b, features, view, vec3(l.xy, -l.z), eta) : pdf;
}

// facetDensity() for the lobe that baseReflection() has above the plane. The half vector counts with its rounding
// error, which may be all of it at grazing angles. Then the density is as wrong as the lobe, and their quotient is
// still a share of light. A density of 0 would let the few samples of a weak lobe bring the whole peak.
float densityAbove(Base b, vec3 view, vec3 l) {
    vec3 sum = view + l;
    return mirroredPdf(view, sum / max(sqrt(dot(sum, sum)), 1e-12), b.alpha);
}

// The density of the microfacets' reflections in a direction above or below the plane. `facets` is the density of the
// facets.
float reflectedPdf(Base b, Features features, vec3 view, vec3 l, float facets) {
    vec2 facet2 = halfCosine2(view, l);
    float chance = facetChances(b, features, decidingCosine2(features, view, facet2, b.eta.y), b.eta.y).x;
    if (dispersesLight(features)) {
        chance = (facetChances(b, features, decidingCosine2(features, view, facet2, b.eta.x), b.eta.x).x + chance +
                  facetChances(b, features, decidingCosine2(features, view, facet2, b.eta.z), b.eta.z).x) / 3.0;
    }
    return chance * facets;
}

// The density of baseSample() by solid angle.
float baseDensity(Base b, Features features, vec3 view, vec3 l) {
    if (l.z > 0.0) {
        float pdf = reflectedPdf(b, features, view, l, densityAbove(b, view, l));
        bool mirrors = seenFromWithin(b, features) && keepsBlocked(features, b.eta.y);
        vec3 below = vec3(l.xy, -l.z);
        return mirrors ? pdf + reflectedPdf(b, features, view, below, facetDensity(b, view, below)) : pdf;
    }
    if (!passesFacets(features)) {
        return 0.0;
    }
    float pdf = passedPdf(b, features, view, l, b.eta.y);
    if (dispersesLight(features)) {
        pdf = (passedPdf(b, features, view, l, b.eta.x) + pdf + passedPdf(b, features, view, l, b.eta.z)) / 3.0;
    }
    return pdf;
}

// Samples a facet of the base and the direction to which it sends the view. u.z first chooses the colour, then
// reflection or passage.
vec3 baseSample(Base b, Features features, vec3 view, vec3 u) {
    vec3 h = sampleVisibleNormal(view, b.alpha, u.xy);
    float eta = sampledIndex(b, features, u.z);
    float chooser = dispersesLight(features) ? fract(3.0 * u.z) : u.z;
    vec3 reflected = reflectAbout(view, h);
    vec2 facet2 = exactSquare(exactDot(view, h));
    if (chooser < facetChances(b, features, decidingCosine2(features, view, facet2, eta), eta).x) {
        bool mirrors = seenFromWithin(b, features) && keepsBlocked(features, b.eta.y);
        return mirrors ? vec3(reflected.xy, abs(reflected.z)) : reflected.z > 0.0 ? reflected : vec3(0.0);
    }
    if (passesStraight(features, eta)) {
        h = sampleVisibleNormal(view, vec2(kMinAlpha), u.xy);
        reflected = reflectAbout(view, h);
    }
    if (!boundsMedium(features) || passesStraight(features, eta)) {
        return reflected.z > 0.0 ? vec3(reflected.x, reflected.y, -reflected.z) : vec3(0.0);
    }
    vec3 refracted;
    if (!refractDirection(view, h, eta, refracted)) {
        return vec3(0.0);
    }
    bool passes = refracted.z < 0.0 || keepsBlocked(features, eta);
    return passes ? vec3(refracted.xy, -abs(refracted.z)) : vec3(0.0);
}
