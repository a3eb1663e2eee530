// Probes of the functions that scatter light.
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
#include "numerics/probe_vectors.glsl"

// bsdf/exact.glsl

PROBE(AddProduct) {
    o[0] = addProduct(i[0], i[1], i[2]);
}

PROBE(DifferenceOfProducts) {
    o[0] = differenceOfProducts(i[0], i[1], i[2], i[3]);
}

PROBE(AccurateDot) {
    o[0] = accurateDot(VEC3(0), VEC3(3));
}

PROBE(HalfCosine2) {
    vec2 squared = halfCosine2(VEC3(0), VEC3(3));
    o[0] = squared.x + squared.y;
}

// Near 0 its root, the cosine, is what matters.
PROBE(RefractedCosine2) {
    float squared = refractedCosine2(exactSquare(vec2(i[0], 0.0)), i[1]);
    o[0] = sqrt(max(squared, 0.0));
    o[1] = squared > 0.0 ? 1.0 : 0.0;
}

// bsdf/fresnel.glsl

PROBE(DielectricF0) {
    o[0] = dielectricF0(i[0]);
}

PROBE(FresnelSchlick) {
    vec3 f = fresnelSchlick(VEC3(0), i[3], i[4]);
    WRITE3(0, f);
}

PROBE(FresnelInterface) {
    vec3 f = fresnelInterface(VEC3(0), i[3], exactSquare(vec2(i[4], 0.0)), i[5]);
    WRITE3(0, f);
    o[3] = i[5] < 1.0 && refractedCosine2(exactSquare(vec2(i[4], 0.0)), i[5]) <= 0.0 ? 1.0 : 0.0;
}

PROBE(InterfacePassed) {
    o[0] = interfacePassed(VEC3(0), i[3], exactSquare(vec2(i[4], 0.0)), i[5]);
    o[1] = o[0] > 0.0 ? 1.0 : 0.0;
}

PROBE(SchlickF0) {
    vec3 f = schlickF0(VEC3(0), i[3], i[4]);
    WRITE3(0, f);
}

// bsdf/ggx.glsl. The scale of the NDF and of densities is their peak.

PROBE(GgxDistribution) {
    o[0] = ggxDistribution(VEC3(0), vec2(i[3]));
    o[1] = 1.0 / (kPi * i[3] * i[3]);
}

PROBE(GgxDistributionAnisotropic) {
    o[0] = ggxDistribution(VEC3(0), VEC2(3));
    o[1] = 1.0 / (kPi * i[3] * i[4]);
}

PROBE(GgxVisibility) {
    o[0] = ggxVisibility(VEC3(0), VEC3(3), vec2(i[6]));
}

PROBE(GgxVisibilityAnisotropic) {
    o[0] = ggxVisibility(VEC3(0), VEC3(3), VEC2(6));
}

// The normal, with the ellipsoid of the microfacets stretched into a sphere. Otherwise a smooth lobe hides
// its errors.
PROBE(SampleVisibleNormal) {
    vec3 h = sampleVisibleNormal(VEC3(0), VEC2(3), VEC2(5));
    vec3 stretched = normalize(vec3(h.x / i[3], h.y / i[4], h.z));
    WRITE3(0, stretched);
    // The normal is that of a sum which is short if the facet is seen from the side. The rounding of a point
    // on the sphere counts that much more there, and the facet counts that much less.
    vec3 view = normalize(vec3(i[3] * i[0], i[4] * i[1], i[2]));
    o[3] = 0.5 / max(dot(view, stretched), 1e-12);
}

PROBE(VisibleNormalPdf) {
    o[0] = visibleNormalPdf(VEC3(0), VEC3(3), VEC2(6));
    o[1] = 2.0 / (kPi * i[6] * i[7] * (i[2] + ggxProjection(VEC3(0), VEC2(6))));
}

// materials/sheen/sheen.glsl

PROBE(SheenDistribution) {
    o[0] = sheenDistribution(i[0], i[1]);
}

PROBE(SheenVisibility) {
    o[0] = sheenVisibility(i[0], i[1], i[2]);
}

// materials/iridescence/iridescence.glsl

PROBE(IridescentFresnel) {
    vec3 f = iridescentFresnel(i[0], VEC3(1), i[4], i[5]);
    WRITE3(0, f);
    // The phase jumps where the base becomes denser than the film.
    float filmF0 = dielectricF0(i[4]);
    o[3] = (i[1] < filmF0 ? 1.0 : 0.0) + (i[2] < filmF0 ? 2.0 : 0.0) + (i[3] < filmF0 ? 4.0 : 0.0);
}

// bsdf/transmission.glsl

PROBE(RefractDirection) {
    vec3 l;
    bool refracted = refractDirection(VEC3(0), VEC3(3), i[6], l);
    WRITE3(0, l);
    o[3] = refracted ? 1.0 : 0.0;
}

// Light that a facet near the normal refracts. The scale is the value for a facet seen head-on.
PROBE(RefractedTransmission) {
    float cosine;
    o[0] = refractedTransmission(VEC3(0), VEC3(3), VEC2(6), i[8], cosine);
    RefractingFacet facet;
    bool refracted = refractionHalfVector(VEC3(0), VEC3(3), i[8], facet);
    o[1] = refracted ? o[0] / max(facet.cosineL * facet.cosineV, 1e-12) : 0.0;
    o[2] = refracted ? 1.0 : 0.0;
}

PROBE(ThinTransmission) {
    float cosine;
    o[0] = thinTransmission(VEC3(0), VEC3(3), VEC2(6), cosine);
    o[1] = schlickWeight(cosine);
    o[2] = o[0] > 0.0 ? 1.0 : 0.0;
}

PROBE(VolumeTransmittance) {
    vec3 t = volumeTransmittance(VEC3(0), i[3]);
    WRITE3(0, t);
}

PROBE(DispersedIor) {
    vec3 n = dispersedIor(i[0], i[1]);
    WRITE3(0, n);
}

// materials/clearcoat/clearcoat.glsl

PROBE(ClearcoatLobe) {
    float nDotV = accurateDot(VEC3(0), VEC3(3));
    float nDotL = accurateDot(VEC3(0), VEC3(6));
    bool lit = nDotV >= kMinViewCosine && nDotL >= kMinViewCosine;
    o[0] = lit ? clearcoatLobe(VEC3(0), nDotL, nDotV, VEC3(3), VEC3(6), i[9]) : 0.0;
    o[1] = lit ? 1.0 : 0.0;
}

// bsdf/albedo.glsl

PROBE(GgxAlbedo) {
    vec2 lossBias = ggxAlbedo(i[0], i[1]);
    o[0] = lossBias.x;
    o[1] = lossBias.y;
}

PROBE(GgxMeanAlbedo) {
    vec2 lossBias = ggxMeanAlbedo(i[0]);
    o[0] = lossBias.x;
    o[1] = lossBias.y;
}

PROBE(AnisotropicGgxAlbedo) {
    vec2 lossBias = anisotropicGgxAlbedo(VEC3(0), VEC2(3));
    o[0] = lossBias.x;
    o[1] = lossBias.y;
}

PROBE(AnisotropicGgxMeanAlbedo) {
    vec2 lossBias = anisotropicGgxMeanAlbedo(VEC2(0));
    o[0] = lossBias.x;
    o[1] = lossBias.y;
}

PROBE(SheenAlbedo) {
    o[0] = sheenAlbedo(i[0], i[1]);
}

// bsdf/bsdf.glsl and bsdf/sample.glsl

Bsdf givenBsdf(float f0X, float f0Y, float f0Z, vec3 diffuse, float f90, vec2 alpha, vec3 transmitted, vec3 eta,
               vec3 diffuseTransmitted) {
    Bsdf b;
    b.base.f0 = vec3(f0X, f0Y, f0Z);
    b.diffuse = diffuse;
    b.base.f90 = f90;
    b.base.alpha = alpha;
    b.base.transmitted = transmitted;
    b.base.eta = eta;
    b.diffuseTransmitted = diffuseTransmitted;
    return b;
}

#define GIVEN_INPUTS (i[37] > 0.0 && i[37] < 1.0 ? GLINT_PARTIAL_METAL : 0u)
#define GIVEN_FEATURES GLINT_FEATURES_OF_GLTF(0u, 0u, 0xFFFFFFFFu, 0xFFFFFFFFu, uint(i[0]), GIVEN_INPUTS)
#define GIVEN_FEATURES_WITHOUT_SHEEN                                                                        \
    GLINT_FEATURES_OF_GLTF(0u, 0u, 0xFFFFFFFFu, 0xFFFFFFFFu, uint(i[0]) & ~GLINT_SHEEN, GIVEN_INPUTS)
#define GIVEN_BSDF(b)                                                                                       \
    Bsdf b = givenBsdf(i[1], i[2], i[3], VEC3(4), i[7], VEC2(8), VEC3(10), VEC3(13), VEC3(16));             \
    b.layers.clearcoat.factor = i[19];                                                                      \
    b.layers.clearcoat.alpha = i[20];                                                                       \
    b.layers.clearcoat.normal = VEC3(21);                                                                   \
    b.layers.sheen.color = VEC3(24);                                                                        \
    b.layers.sheen.alpha = i[27];                                                                           \
    b.base.metalF0 = VEC3(34);                                                                              \
    b.base.metallic = i[37];                                                                                \
    prepareBsdf(b, GIVEN_FEATURES, VEC3(28))

// The facet's normal and the reflectance of both bases.
PROBE(FacetBetween) {
    GIVEN_BSDF(b);
    Facet facet = facetBetween(b.base, GIVEN_FEATURES, b.view, VEC3(31));
    vec3 f = facet.fresnel;
    WRITE3(0, facet.h);
    WRITE3(3, f);
}

PROBE(EvaluateBsdf) {
    GIVEN_BSDF(b);
    vec3 f = evaluateBsdf(b, GIVEN_FEATURES, VEC3(31));
    WRITE3(0, f);
}

// The same, with the peak of its microfacets as the scale.
PROBE(EvaluateBsdfByPeak) {
    GIVEN_BSDF(b);
    vec3 f = evaluateBsdf(b, GIVEN_FEATURES, VEC3(31));
    WRITE3(0, f);
    o[3] = 0.25 / (kPi * (refracts(b.base.eta.y) ? b.base.alpha.x * b.base.alpha.y : kMinAlpha * kMinAlpha));
}

// The scale is the material without its sheen, because white sheen leaves almost nothing of it near grazing.
PROBE(EvaluateUnderSheen) {
    GIVEN_BSDF(b);
    vec3 f = evaluateBsdf(b, GIVEN_FEATURES, VEC3(31));
    WRITE3(0, f);
    vec3 bare = evaluateBsdf(b, GIVEN_FEATURES_WITHOUT_SHEEN, VEC3(31));
    o[3] = max(bare.x, max(bare.y, bare.z)) + 1e-4;
}

PROBE(BsdfPdf) {
    GIVEN_BSDF(b);
    o[0] = bsdfPdf(b, GIVEN_FEATURES, VEC3(31));
    o[1] = bsdfPdf(b, GIVEN_FEATURES_WITHOUT_SHEEN, VEC3(31)) + 1e-4;
}

// Summarises a sample in one number whose truth is 1: the value over the density of its direction, divided by
// the sample's own weight.
PROBE(SampleBsdf) {
    GIVEN_BSDF(b);
    BsdfSample s = sampleBsdf(b, GIVEN_FEATURES, VEC3(31));
    vec3 f = evaluateBsdf(b, GIVEN_FEATURES, s.direction);
    float weight = s.weight.x + s.weight.y + s.weight.z;
    // A weight that is not a normal number has few digits.
    o[0] = s.pdf > 0.0 && weight > 1e-30 ? (f.x + f.y + f.z) / s.pdf / weight : 1.0;
}
