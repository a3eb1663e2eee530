// Claims about the functions that scatter light; proofs_bsdf.cpp has their domains and ranges.
#include "bsdf/constants.glsl"
#include "bsdf/exact.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/ggx.glsl"
#include "bsdf/albedo.glsl"
#include "materials/sheen/sheen.glsl"
#include "materials/iridescence/iridescence.glsl"
#include "bsdf/transmission.glsl"
#include "materials/clearcoat/clearcoat.glsl"
#include "materials/dispersion/dispersion.glsl"
#include "bsdf/bsdf.glsl"
#include "bsdf/sample.glsl"
#include "numerics/proof_vectors.glsl"

// bsdf/exact.glsl

PROOF(AddProduct) {
    vec2 sum = exactAddProduct(i[0], i[1], i[2]);
    o[0] = sum.x;
    o[1] = sum.y;
}

PROOF(DifferenceOfProducts) {
    o[0] = differenceOfProducts(i[0], i[1], i[2], i[3]);
}

PROOF(AccurateDot) {
    vec3 a = UNIT(0);
    vec3 b = UNIT(3);
    o[0] = accurateDot(a, b);
}

PROOF(HalfCosine2) {
    vec2 squared = halfCosine2(UNIT(0), UNIT(3));
    o[0] = squared.x;
    o[1] = squared.y;
}

PROOF(RefractedCosine2) {
    o[0] = refractedCosine2(exactSquare(vec2(i[0], 0.0)), i[1]);
}

PROOF(AccurateCrossOfSum) {
    vec3 c = accurateCrossOfSum(UNIT(0), UNIT(3), UNIT(6));
    WRITE3(0, c);
}

// bsdf/fresnel.glsl

PROOF(DielectricF0) {
    o[0] = dielectricF0(i[0]);
}

PROOF(SchlickWeight) {
    o[0] = schlickWeight(i[0]);
}

PROOF(SchlickRest) {
    o[0] = schlickRest(i[0]);
    o[1] = o[0] + schlickWeight(i[0]);
}

// f90 is at least f0, and at most 1: f0 and a share of what is left.
float claimedF90(float f0, float share) {
    return min(mix(f0, 1.0, share), 1.0);
}

PROOF(FresnelSchlick) {
    float f90 = claimedF90(i[0], i[1]);
    o[0] = fresnelSchlick(vec3(i[0]), f90, i[2]).x;
    o[1] = schlickPassed(vec3(i[0]), f90, i[2]);
    o[2] = o[0] + o[1];
}

PROOF(FresnelInterface) {
    float f90 = claimedF90(i[0], i[1]);
    vec2 cosine2 = exactSquare(vec2(i[2], 0.0));
    o[0] = fresnelInterface(vec3(i[0]), f90, cosine2, i[3]).x;
    o[1] = interfacePassed(vec3(i[0]), f90, cosine2, i[3]);
    o[2] = o[0] + o[1];
}

PROOF(SchlickF0) {
    o[0] = schlickF0(vec3(i[0]), i[1], i[2]).x;
}

PROOF(Luminance) {
    o[0] = luminance(vec3(i[0], i[1], i[2]));
}

// bsdf/ggx.glsl

PROOF(GgxDistribution) {
    o[0] = ggxDistribution(UNIT(0), vec2(i[3], i[4]));
}

PROOF(GgxProjection) {
    o[0] = ggxProjection(UNIT(0), vec2(i[3], i[4]));
}

PROOF(GgxVisibility) {
    o[0] = ggxVisibility(UNIT(0), UNIT(3), vec2(i[6], i[7]));
}

PROOF(SampleVisibleNormal) {
    vec3 h = sampleVisibleNormal(UNIT(0), vec2(i[3], i[4]), vec2(i[5], i[6]));
    WRITE3(0, h);
    o[3] = length(h);
}

PROOF(VisibleNormalPdf) {
    o[0] = visibleNormalPdf(UNIT(0), UNIT(3), vec2(i[6], i[7]));
}

PROOF(MirroredPdf) {
    o[0] = mirroredPdf(UNIT(0), UNIT(3), vec2(i[6], i[7]));
}

// bsdf/albedo.glsl

PROOF(GgxLoss) {
    o[0] = ggxLoss(i[0], i[1]);
}

PROOF(GgxAlbedo) {
    vec2 lossBias = ggxAlbedo(i[0], i[1]);
    o[0] = lossBias.x;
    o[1] = lossBias.y;
    o[2] = 1.0 - lossBias.x - lossBias.y;
}

PROOF(GgxMeanAlbedo) {
    vec2 lossBias = ggxMeanAlbedo(i[0]);
    o[0] = lossBias.x;
    o[1] = lossBias.y;
    o[2] = 1.0 - lossBias.x - lossBias.y;
}

// alpha.x is at least alpha.y.
PROOF(AnisotropicGgxAlbedo) {
    vec2 alpha = vec2(i[3], max(i[3] * i[4], kMinAlpha));
    vec2 lossBias = anisotropicGgxAlbedo(UNIT(0), alpha);
    o[0] = lossBias.x;
    o[1] = lossBias.y;
    o[2] = 1.0 - lossBias.x - lossBias.y;
}

PROOF(AnisotropicGgxMeanAlbedo) {
    vec2 alpha = vec2(i[0], max(i[0] * i[1], kMinAlpha));
    vec2 lossBias = anisotropicGgxMeanAlbedo(alpha);
    o[0] = lossBias.x;
    o[1] = lossBias.y;
}

// bsdf/layer.glsl, bsdf/basis.glsl

PROOF(SampleCosine) {
    vec3 l = sampleCosine(vec2(i[0], i[1]));
    WRITE3(0, l);
    o[3] = cosineDensity(l);
}

PROOF(ReflectAbout) {
    vec3 l = reflectAbout(UNIT(0), UNIT(3));
    WRITE3(0, l);
}

PROOF(BuildBasis) {
    vec3 tangent;
    vec3 bitangent;
    buildBasis(directionAt(i[0], i[1], 0.0), tangent, bitangent);
    WRITE3(0, tangent);
    WRITE3(3, bitangent);
}

// materials/sheen

PROOF(SheenDistribution) {
    o[0] = sheenDistribution(i[0], i[1]);
}

PROOF(SheenLambda) {
    o[0] = sheenLambda(i[0], i[1]);
}

PROOF(SheenVisibility) {
    o[0] = sheenVisibility(i[0], i[1], i[2]);
}

PROOF(SheenMasking) {
    o[0] = sheenMasking(i[0], i[1]);
}

PROOF(SheenHorizon) {
    o[0] = sheenHorizon(i[0], i[1]);
}

PROOF(SheenAlbedo) {
    o[0] = sheenAlbedo(i[0], i[1]);
}

PROOF(SheenShares) {
    Sheen layer = Sheen(vec3(i[0]), i[1], 0.0);
    vec3 view = vec3(0.0, 0.0, i[2]);
    sheenPrepare(layer, view);
    LayerAlbedo shares = sheenShares(layer, view);
    o[0] = shares.reflected.x;
    o[1] = shares.passed;
    o[2] = shares.reflected.x + shares.passed;
}

// materials/clearcoat

PROOF(ClearcoatFresnel) {
    o[0] = clearcoatFresnel(i[0], i[1]);
    o[1] = clearcoatPassed(i[0], i[1]);
    o[2] = o[0] + o[1];
}

PROOF(ClearcoatProjection) {
    o[0] = clearcoatProjection(i[0], i[1]);
}

PROOF(ClearcoatGain) {
    o[0] = clearcoatGain(i[0], i[1]);
}

// materials/iridescence, dispersion, volume

PROOF(CosineOfCycles) {
    o[0] = cosineOfCycles(i[0]);
}

PROOF(FilmSensitivity) {
    vec3 s = filmSensitivity(i[0], vec3(i[1]));
    WRITE3(0, s);
}

PROOF(IridescentFresnel) {
    o[0] = iridescentFresnel(i[0], vec3(i[1]), i[2], i[3]).x;
}

PROOF(DispersedIor) {
    vec3 iors = dispersedIor(i[0], i[1]);
    WRITE3(0, iors);
}

PROOF(VolumeTransmittance) {
    o[0] = volumeTransmittance(vec3(i[0]), i[1]).x;
}

// bsdf/transmission.glsl

PROOF(RefractDirection) {
    vec3 l;
    bool refracted = refractDirection(UNIT(0), UNIT(3), i[6], l);
    WRITE3(0, l);
}

PROOF(ThinTransmission) {
    float cosine;
    o[0] = thinTransmission(UNIT(0), -UNIT(3), vec2(i[6], i[7]), cosine);
    o[1] = cosine;
}

PROOF(RefractedTransmission) {
    float cosine;
    o[0] = refractedTransmission(UNIT(0), -UNIT(3), vec2(i[6], i[7]), i[8], cosine);
    o[1] = cosine;
}

// bsdf/bsdf.glsl: the shares of energy. b has the reflectances of a dielectric and a loss and bias of its microfacets.

Bsdf claimedBsdf(float f0, float f90, float loss, float meanLoss) {
    Bsdf b;
    b.base.f0 = vec3(f0);
    b.base.f90 = f90;
    b.base.metalF0 = vec3(f0);
    b.base.metallic = 0.0;
    b.diffuse = vec3(1.0);
    b.base.transmitted = vec3(0.0);
    b.diffuseTransmitted = vec3(0.0);
    b.base.eta = vec3(1.5);
    b.base.alpha = vec2(1.0);
    b.base.viewLoss = loss;
    b.base.viewBias = 0.0;
    b.base.meanLoss = meanLoss;
    b.base.meanBias = 0.0;
    return b;
}

#define CLAIMED_FEATURES(lobes) GLINT_FEATURES_OF_GLTF(lobes, 0u, 0u, 0u, lobes, 0u)

PROOF(MultiScatterOf) {
    o[0] = multiScatterOf(vec3(i[0]), claimedF90(i[0], i[1]), i[2]).x;
}

PROOF(PassedAgain) {
    Bsdf b = claimedBsdf(i[0], claimedF90(i[0], i[1]), 0.0, i[2]);
    o[0] = passedAgain(b.base).x;
    o[1] = o[0] + multiScatterOf(b.base.f0, b.base.f90, b.base.meanLoss).x;
}

// i[3]: the bias as a share of E.
PROOF(SpecularShares) {
    Bsdf b = claimedBsdf(i[0], claimedF90(i[0], i[1]), i[2], i[4]);
    b.base.viewBias = i[3] * (1.0 - i[2]);
    o[0] = specularAlbedo(b.base, CLAIMED_FEATURES(0u)).x;
    o[1] = specularPassed(b.base, i[2], b.base.viewBias).x;
    o[2] = o[0] + o[1];
}

// The chances of reflection and passage of an interface with an index: i[3] is the cosine, i[4] the index.
PROOF(FacetChances) {
    Bsdf b = claimedBsdf(i[0], claimedF90(i[0], i[1]), 0.0, 0.0);
    b.base.transmitted = vec3(i[2]);
    vec2 chances = facetChances(b.base, CLAIMED_FEATURES(GLINT_TRANSMISSION | GLINT_VOLUME),
                                exactSquare(vec2(i[3], 0.0)), i[4]);
    o[0] = chances.x;
    o[1] = chances.y;
    o[2] = chances.x + chances.y;
}

// `more` is what a surface has besides; i[9] is its own input.
#define CLAIMED_SURFACE(lobes, more)                                                            \
    Bsdf b = claimedBsdf(i[0], 1.0, 0.0, 0.0);                                                  \
    b.base.alpha = vec2(i[1]);                                                                  \
    b.diffuse = vec3(i[2]);                                                                     \
    b.base.transmitted = vec3(i[2]);                                                            \
    b.diffuseTransmitted = vec3(i[2]);                                                          \
    b.layers.clearcoat = Clearcoat(i[2], i[1], vec3(0.0, 0.0, 1.0));                            \
    b.layers.sheen = Sheen(vec3(i[2]), max(i[1], kMinSheenAlpha), 0.0);                         \
    more;                                                                                       \
    vec3 view = UNIT(3);                                                                        \
    prepareBsdf(b, CLAIMED_FEATURES(lobes), vec3(view.xy, max(view.z, kMinViewCosine)))

#define CLAIMS_OF_SURFACE(name, lobes, side, more)                                              \
    PROOF(Prepare##name) {                                                                      \
        CLAIMED_SURFACE(lobes, more);                                                           \
        o[0] = b.base.viewLoss;                                                                 \
        o[1] = b.base.viewBias;                                                                 \
        o[2] = b.base.meanLoss;                                                                 \
        o[3] = b.base.meanBias;                                                                 \
    }                                                                                           \
    PROOF(Evaluate##name) {                                                                     \
        CLAIMED_SURFACE(lobes, more);                                                           \
        o[0] = evaluateBsdf(b, CLAIMED_FEATURES(lobes), side * UNIT(6)).x;                      \
    }                                                                                           \
    PROOF(Density##name) {                                                                      \
        CLAIMED_SURFACE(lobes, more);                                                           \
        o[0] = bsdfPdf(b, CLAIMED_FEATURES(lobes), side * UNIT(6));                             \
    }                                                                                           \
    PROOF(Chances##name) {                                                                      \
        CLAIMED_SURFACE(lobes, more);                                                           \
        LobeChances chances = lobeChances(b, CLAIMED_FEATURES(lobes));                          \
        o[0] = chances.own;                                                                     \
        o[1] = chances.diffuse;                                                                 \
        o[2] = chances.passed;                                                                  \
        o[3] = o[0] + o[1] + o[2] + sumOfChances(chances.layers);                               \
    }

#define CLAIM_OF_SAMPLES(name, lobes, more)                                                     \
    PROOF(Sample##name) {                                                                       \
        CLAIMED_SURFACE(lobes, more);                                                           \
        vec3 l = baseSample(b.base, CLAIMED_FEATURES(lobes), b.view, vec3(i[6], i[7], i[8]));   \
        o[0] = dot(l, l);                                                                       \
    }

CLAIMS_OF_SURFACE(Base, 0u, 1.0, )
CLAIMS_OF_SURFACE(Coated, GLINT_CLEARCOAT, 1.0, )
CLAIMS_OF_SURFACE(Sheen, GLINT_SHEEN, 1.0, )
CLAIMS_OF_SURFACE(Thin, GLINT_TRANSMISSION, -1.0, )
CLAIMS_OF_SURFACE(Translucent, GLINT_DIFFUSE_TRANSMISSION, -1.0, )
CLAIMS_OF_SURFACE(Volume, GLINT_TRANSMISSION | GLINT_VOLUME, -1.0, b.base.eta = vec3(i[9]))
CLAIMS_OF_SURFACE(Anisotropic, GLINT_ANISOTROPY, 1.0, b.base.alpha.y = max(i[1] * i[9], kMinAlpha))

CLAIM_OF_SAMPLES(Base, 0u, )
CLAIM_OF_SAMPLES(Thin, GLINT_TRANSMISSION, )
CLAIM_OF_SAMPLES(Volume, GLINT_TRANSMISSION | GLINT_VOLUME, b.base.eta = vec3(i[9]))
