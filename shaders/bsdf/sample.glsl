// Samples directions in proportion to the BSDF, one lobe of a mixture at a time, and gives the density of the mixture.
#include "bsdf/bsdf.glsl"

struct BsdfSample {
    vec3 direction;  // unit vector, in the frame of the surface
    vec3 weight;     // BSDF |n·l| / pdf
    float pdf;       // 0 if the lobe gave no direction (below the horizon, or along a facet's edge)
};

// The probabilities of the lobes; they sum to 1.
struct LobeChances {
    float microfacets;  // visible normals of the base, for reflection and passage
    float diffuse;      // cosine-weighted: diffuse, multiple scattering
    float passed;       // cosine-weighted, on the far side: diffuse, multiple scattering
    LayerChances layers;
};

LobeChances lobeChances(Bsdf b, Features features) {
    vec3 single = singleScatterAlbedo(b, features, b.viewLoss, b.viewBias);
    vec3 all = specularAlbedo(b, features, b.viewLoss, b.viewBias);
    float below = max(smallest(specularPassed(b, b.viewLoss, b.viewBias)), 0.0);
    LobeChances chances;
    if (hasModel(features)) {
        below = 1.0;
    }
    chances.microfacets = luminance(single);
    chances.diffuse = luminance(b.diffuse) * below + luminance(all - single);
    chances.passed = 0.0;
    if (passesFacets(features)) {
        float later = scattersPassage(features) ? smallest(passedAgain(b)) * b.viewLoss : 0.0;
        chances.microfacets += luminance(b.transmitted) * max(below - later, 0.0);
        chances.passed = luminance(b.transmitted) * later;
    }
    if (scattersBehind(features)) {
        chances.passed += luminance(b.diffuseTransmitted) * below;
    }
    float base = layerChances(b.layers, features, b.view, chances.layers);
    float total = base * (chances.microfacets + chances.diffuse + chances.passed) + sumOfChances(chances.layers);
    // A surface that is black, or so dark that the quotient would overflow, samples its microfacets.
    bool isBlack = total < 1e-30;
    float scale = isBlack ? 0.0 : 1.0 / total;
    chances.microfacets = !isBlack ? chances.microfacets * base * scale : 1.0;
    chances.diffuse *= base * scale;
    if (hasModel(features)) {
        chances.diffuse = !isBlack ? chances.diffuse : 1.0;
        chances.microfacets = 0.0;
    }
    chances.passed *= base * scale;
    scaleChances(chances.layers, scale);
    return chances;
}

// The probabilities that a facet reflects (x) and that it lets light through (y), from the squared cosine under which
// it is seen, with the error of the square.
vec2 facetChances(Bsdf b, Features features, vec2 cosine2, float eta) {
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
vec2 decidingCosine2(Bsdf b, Features features, vec2 facet2, float eta) {
    return passesStraight(features, eta) ? exactSquare(vec2(b.view.z, 0.0)) : facet2;
}

// The index of one of three colours. They differ only with dispersion.
float sampledIndex(Bsdf b, Features features, float u) {
    if (dispersesLight(features)) {
        return u < 1.0 / 3.0 ? b.eta.x : u < 2.0 / 3.0 ? b.eta.y : b.eta.z;
    }
    return b.eta.y;
}

// The density of a direction to which facets bend the view, for the index of one colour.
float bendingPdf(Bsdf b, Features features, vec3 l, float eta) {
    RefractingFacet facet;
    if (!refractionHalfVector(b.view, l, eta, facet)) {
        return 0.0;
    }
    return facetChances(b, features, exactSquare(vec2(facet.cosineV, 0.0)), eta).y *
           visibleNormalPdf(b.view, facet.h, b.alpha) * facet.spread * facet.cosineL;
}

// The density of a direction beyond the microfacets, for the index of one colour.
float passedPdf(Bsdf b, Features features, vec3 l, float eta) {
    if (!boundsMedium(features) || passesStraight(features, eta)) {
        vec3 mirrored = vec3(l.x, l.y, -l.z);
        vec3 h = normalize(b.view + mirrored);
        vec2 alpha = passesStraight(features, eta) ? vec2(kMinAlpha) : b.alpha;
        return facetChances(b, features, decidingCosine2(b, features, halfCosine2(b.view, mirrored), eta), eta).y *
               mirroredPdf(b.view, h, alpha);
    }
    float pdf = bendingPdf(b, features, l, eta);
    return keepsBlocked(features, eta) ? pdf + bendingPdf(b, features, vec3(l.xy, -l.z), eta) : pdf;
}

// facetDensity() for the lobe that baseReflection() has above the plane. The half vector counts with its rounding
// error, which may be all of it at grazing angles. Then the density is as wrong as the lobe, and their quotient is
// still a share of light. A density of 0 would let the few samples of a weak lobe bring the whole peak.
float densityAbove(Bsdf b, vec3 l) {
    vec3 sum = b.view + l;
    return mirroredPdf(b.view, sum / max(sqrt(dot(sum, sum)), 1e-12), b.alpha);
}

// The density of the microfacets' reflections in a direction above or below the plane. `facets` is the density of the
// facets.
float reflectedPdf(Bsdf b, Features features, vec3 l, float facets) {
    vec2 facet2 = halfCosine2(b.view, l);
    float chance = facetChances(b, features, decidingCosine2(b, features, facet2, b.eta.y), b.eta.y).x;
    if (dispersesLight(features)) {
        chance = (facetChances(b, features, decidingCosine2(b, features, facet2, b.eta.x), b.eta.x).x + chance +
                  facetChances(b, features, decidingCosine2(b, features, facet2, b.eta.z), b.eta.z).x) / 3.0;
    }
    return chance * facets;
}

float microfacetPdf(Bsdf b, Features features, vec3 l) {
    if (l.z > 0.0) {
        float pdf = reflectedPdf(b, features, l, densityAbove(b, l));
        bool mirrors = seenFromWithin(b, features) && keepsBlocked(features, b.eta.y);
        vec3 below = vec3(l.xy, -l.z);
        return mirrors ? pdf + reflectedPdf(b, features, below, facetDensity(b, below)) : pdf;
    }
    if (!passesFacets(features)) {
        return 0.0;
    }
    float pdf = passedPdf(b, features, l, b.eta.y);
    if (dispersesLight(features)) {
        pdf = (passedPdf(b, features, l, b.eta.x) + pdf + passedPdf(b, features, l, b.eta.z)) / 3.0;
    }
    return pdf;
}

// The density, by solid angle, with which sampleBsdf() chooses l.
float bsdfPdf(Bsdf b, Features features, vec3 l) {
    LobeChances chances = lobeChances(b, features);
    float pdf = (l.z > 0.0 ? chances.diffuse * l.z : chances.passed * -l.z) * kInversePi;
#if GLINT_MODELS
    if (samplesModel(features)) {
        pdf = (chances.diffuse + chances.passed) * modelDensity(b.layers, features, b.view, l);
    }
#endif
    if (!hasModel(features)) {
        pdf += chances.microfacets * microfacetPdf(b, features, l);
    }
    return pdf + layersDensity(b.layers, features, chances.layers, b.view, l);
}

// Samples a facet of the base and the direction to which it sends the view. u.z first chooses the colour, then
// reflection or passage.
vec3 sampleMicrofacet(Bsdf b, Features features, vec3 u) {
    vec3 h = sampleVisibleNormal(b.view, b.alpha, u.xy);
    float eta = sampledIndex(b, features, u.z);
    float chooser = dispersesLight(features) ? fract(3.0 * u.z) : u.z;
    vec3 reflected = reflectAbout(b.view, h);
    vec2 facet2 = exactSquare(exactDot(b.view, h));
    if (chooser < facetChances(b, features, decidingCosine2(b, features, facet2, eta), eta).x) {
        bool mirrors = seenFromWithin(b, features) && keepsBlocked(features, b.eta.y);
        return mirrors ? vec3(reflected.xy, abs(reflected.z)) : reflected.z > 0.0 ? reflected : vec3(0.0);
    }
    if (passesStraight(features, eta)) {
        h = sampleVisibleNormal(b.view, vec2(kMinAlpha), u.xy);
        reflected = reflectAbout(b.view, h);
    }
    if (!boundsMedium(features) || passesStraight(features, eta)) {
        return reflected.z > 0.0 ? vec3(reflected.x, reflected.y, -reflected.z) : vec3(0.0);
    }
    vec3 refracted;
    if (!refractDirection(b.view, h, eta, refracted)) {
        return vec3(0.0);
    }
    bool passes = refracted.z < 0.0 || keepsBlocked(features, eta);
    return passes ? vec3(refracted.xy, -abs(refracted.z)) : vec3(0.0);
}

// Samples a direction for the prepared view; u is uniform in [0, 1)³.
BsdfSample sampleBsdf(Bsdf b, Features features, vec3 u) {
    LobeChances chances = lobeChances(b, features);
    float chooser = u.z;
    vec3 l;
    if (!hasModel(features) && chooser < chances.microfacets) {
        l = sampleMicrofacet(b, features, vec3(u.xy, min(chooser / chances.microfacets, 0.99999994)));
#if GLINT_MODELS
    } else if (samplesModel(features) && chooser < chances.diffuse + chances.passed) {
        l = sampleModel(b.layers, features, b.view, u.xy);
#endif
    } else if (chooser < chances.microfacets + chances.diffuse) {
        l = sampleCosine(u.xy);
    } else if (chooser < chances.microfacets + chances.diffuse + chances.passed) {
        l = sampleCosine(u.xy) * vec3(1.0, 1.0, -1.0);
    } else {
        chooser -= chances.microfacets + chances.diffuse + chances.passed;
        l = sampleLayers(b.layers, features, chances.layers, b.view, u.xy, chooser);
    }
    BsdfSample result = BsdfSample(l, vec3(0.0), 0.0);
    if (l.z == 0.0) {
        return result;
    }
    result.direction = normalize(l);
    result.pdf = bsdfPdf(b, features, result.direction);
    if (result.pdf > 0.0) {
        result.weight = evaluateBsdf(b, features, result.direction) / result.pdf;
    }
    return result;
}
