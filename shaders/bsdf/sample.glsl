// Samples directions in proportion to the BSDF, one lobe of a mixture at a time, and gives the density of the mixture.
#include "bsdf/bsdf.glsl"

struct BsdfSample {
    vec3 direction;  // unit vector, in the frame of the surface
    vec3 weight;     // BSDF |n·l| / pdf
    float pdf;       // 0 if the lobe gave no direction (below the horizon, or along a facet's edge)
};

// The probabilities of the lobes; they sum to 1.
struct LobeChances {
    float own;      // directions that the base samples itself: microfacets, for reflection and passage, or a model's
    float diffuse;  // cosine-weighted: diffuse, multiple scattering
    float passed;   // cosine-weighted, on the far side: diffuse, multiple scattering
    LayerChances layers;
};

// The chances of the base in the order of LobeChances, as shares of a uniform white sky's light.
vec3 chancesOfBase(Bsdf b, Features features) {
    if (!hasModel(features)) {
        return baseChances(b.base, features, b.diffuse, b.diffuseTransmitted);
    }
    float front = luminance(b.diffuse);
    float behind = scattersBehind(features) ? luminance(b.diffuseTransmitted) : 0.0;
    return samplesModel(features) ? vec3(front + behind, 0.0, 0.0) : vec3(0.0, front, behind);
}

LobeChances lobeChances(Bsdf b, Features features) {
    vec3 ofBase = chancesOfBase(b, features);
    LobeChances chances;
    float base = layerChances(b.layers, features, b.view, chances.layers);
    float total = base * (ofBase.x + ofBase.y + ofBase.z) + sumOfChances(chances.layers);
    // A surface that is black, or so dark that the quotient would overflow, has one lobe.
    bool isBlack = total < 1e-30;
    float scale = isBlack ? 0.0 : 1.0 / total;
    chances.diffuse = ofBase.y * (base * scale);
    chances.passed = ofBase.z * (base * scale);
    if (samplesBase(features)) {
        chances.own = !isBlack ? ofBase.x * base * scale : 1.0;
    } else {
        chances.own = 0.0;
        chances.diffuse = !isBlack ? chances.diffuse : 1.0;
    }
    scaleChances(chances.layers, scale);
    return chances;
}

// The density, by solid angle, with which sampleBsdf() chooses l.
float bsdfPdf(Bsdf b, Features features, vec3 l) {
    LobeChances chances = lobeChances(b, features);
    float pdf = (l.z > 0.0 ? chances.diffuse * l.z : chances.passed * -l.z) * kInversePi;
    if (!hasModel(features)) {
        pdf += chances.own * baseDensity(b.base, features, b.view, l);
    } else if (samplesModel(features)) {
        pdf = chances.own * modelDensity(b.layers, features, b.view, l);
    }
    return pdf + layersDensity(b.layers, features, chances.layers, b.view, l);
}

// Samples a direction for the prepared view; u is uniform in [0, 1)³.
BsdfSample sampleBsdf(Bsdf b, Features features, vec3 u) {
    LobeChances chances = lobeChances(b, features);
    float chooser = u.z;
    vec3 l;
    if (samplesBase(features) && chooser < chances.own) {
        vec3 within = vec3(u.xy, min(chooser / chances.own, 0.99999994));
        l = hasModel(features) ? sampleModel(b.layers, features, b.view, within.xy)
                               : baseSample(b.base, features, b.view, within);
    } else if (chooser < chances.own + chances.diffuse) {
        l = sampleCosine(u.xy);
    } else if (chooser < chances.own + chances.diffuse + chances.passed) {
        l = sampleCosine(u.xy) * vec3(1.0, 1.0, -1.0);
    } else {
        chooser -= chances.own + chances.diffuse + chances.passed;
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
