// Clearcoat (KHR_materials_clearcoat): a layer with an isotropic GGX lobe of index 1.5 about its own normal. Vectors
// are in the frame of the base, where the coat's normal need not be z. Products that nearly cancel therefore keep their
// rounding errors.
#include "bsdf/albedo.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/ggx.glsl"
#include "bsdf/layer.glsl"

struct Clearcoat {
    GLINT_RELAXED float factor;  // share of the surface that the coat covers
    float alpha;                 // at least kMinAlpha
    vec3 normal;                 // unit
};

// Reflectance of the layer, which depends on the angle of the view alone, as in the extension's text.
GLINT_RELAXED float clearcoatFresnel(GLINT_RELAXED float factor, float nDotV) {
    return factor * (0.04 + 0.96 * schlickWeight(nDotV));
}

// The share that the layer lets through: 1 - clearcoatFresnel(). It keeps its digits where little passes.
GLINT_RELAXED float clearcoatPassed(GLINT_RELAXED float factor, float nDotV) {
    return (1.0 - factor) + factor * 0.96 * schlickRest(nDotV);
}

// The NDF about n, for the facet between v and l.
float clearcoatDistribution(vec3 n, vec3 v, vec3 l, float alpha) {
    // Sine and cosine between n and the unnormalised half vector s, times |s|.
    vec3 s = v + l;
    vec3 sine = accurateCrossOfSum(n, v, l);
    float cosine = dot(n, s);
    float a2 = alpha * alpha;
    float t = (dot(sine, sine) / a2 + cosine * cosine) / dot(s, s);
    return cosine > 0.0 ? 1.0 / (kPi * a2 * t * t) : 0.0;
}

// ggxProjection(), as a function of the cosine to n.
float clearcoatProjection(float cosine, float alpha) {
    float a2 = alpha * alpha;
    return sqrt(cosine * cosine * (1.0 - a2) + a2);
}

// The lobe without Fresnel: D V. n is a unit vector; nDotL and nDotV are cosines to it, above 0.
float clearcoatLobe(vec3 n, float nDotL, float nDotV, vec3 v, vec3 l, float alpha) {
    return clearcoatDistribution(n, v, l, alpha) * 0.5 /
           (nDotL * clearcoatProjection(nDotV, alpha) + nDotV * clearcoatProjection(nDotL, alpha));
}

// The factor of the lobe by which the coat reflects its Fresnel reflectance, and no less if it is rough: light that its
// facets scatter more than once leaves in proportion to the rest (Turquin 2019). 1 without energy compensation.
float clearcoatGain(float alpha, float nDotV) {
    return GLINT_ENERGY_COMPENSATION != 0 ? 1.0 / (1.0 - ggxLoss(nDotV, alpha)) : 1.0;
}

void clearcoatPrepare(inout Clearcoat layer, vec3 view) {}

// The cosine between the view and the coat's normal.
float clearcoatViewCosine(Clearcoat layer, vec3 view) {
    return clamp(accurateDot(layer.normal, view), kMinViewCosine, 1.0);
}

// Returns whether the coat's normal faces the viewer.
bool clearcoatFacesViewer(Clearcoat layer, vec3 view) {
    return accurateDot(layer.normal, view) >= kMinViewCosine;
}

LayerAlbedo clearcoatShares(Clearcoat layer, vec3 view) {
    float nDotV = clearcoatViewCosine(layer, view);
    return LayerAlbedo(vec3(clearcoatFresnel(layer.factor, nDotV)), clearcoatPassed(layer.factor, nDotV));
}

LayerMirror clearcoatMirror(Clearcoat layer) {
    return LayerMirror(layer.normal, sqrt(layer.alpha));
}

// The coat covers the hemisphere about its normal, whatever the normal of the base is. If it turns away from the
// viewer, it covers only directions that are also above the base.
LayerLight clearcoatEvaluate(Clearcoat layer, vec3 view, vec3 l) {
    float nDotL = accurateDot(layer.normal, l);
    float nDotV = clearcoatViewCosine(layer, view);
    LayerLight light = LayerLight(vec3(0.0), clearcoatPassed(layer.factor, nDotV), nDotL);
    if (nDotL > 0.0 && (l.z > 0.0 || clearcoatFacesViewer(layer, view))) {
        light.reflected = vec3(clearcoatFresnel(layer.factor, nDotV) * clearcoatGain(layer.alpha, nDotV) * nDotL *
                               clearcoatLobe(layer.normal, nDotL, nDotV, view, l, layer.alpha));
    }
    return light;
}

// Visible normals of the coat. If it turns away from the viewer, it has none, and directions of the base's hemisphere
// serve.
vec3 clearcoatSample(Clearcoat layer, vec3 view, vec2 u) {
    if (!clearcoatFacesViewer(layer, view)) {
        return sampleCosine(u);
    }
    vec3 tangent;
    vec3 bitangent;
    buildBasis(layer.normal, tangent, bitangent);
    vec3 seen = vec3(dot(tangent, view), dot(bitangent, view), clearcoatViewCosine(layer, view));
    vec3 h = sampleVisibleNormal(normalize(seen), vec2(layer.alpha), u);
    vec3 l = reflectAbout(view, tangent * h.x + bitangent * h.y + layer.normal * h.z);
    return accurateDot(layer.normal, l) > 0.0 ? l : vec3(0.0);
}

// mirroredPdf() in the coat's frame.
float clearcoatDensity(Clearcoat layer, vec3 view, vec3 l) {
    if (!clearcoatFacesViewer(layer, view)) {
        return cosineDensity(l);
    }
    if (accurateDot(layer.normal, l) <= 0.0) {
        return 0.0;
    }
    float nDotV = clearcoatViewCosine(layer, view);
    return 0.5 * clearcoatDistribution(layer.normal, view, l, layer.alpha) /
           (nDotV + clearcoatProjection(nDotV, layer.alpha));
}
