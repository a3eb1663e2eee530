// A coat of OpenPBR: a GGX lobe with the Fresnel of an index of refraction. What it does not reflect of the view's
// light passes: OpenPBR 1.1, "Albedo-scaling". So it is not reciprocal, and its energy is exact.
#include "bsdf/albedo.glsl"
#include "bsdf/ggx.glsl"
#include "bsdf/layer.glsl"

struct Coat {
    GLINT_RELAXED float factor;
    float alpha;
    float f0;      // reflectance at normal incidence
    float albedo;  // share of a white sky that the coat reflects for the prepared view, where it covers the surface
};

void coatPrepare(inout Coat layer, vec3 view) {
    vec2 lossBias = ggxAlbedo(view.z, layer.alpha);
    layer.albedo = layer.f0 * (1.0 - lossBias.x - lossBias.y) + lossBias.y;
}

LayerAlbedo coatShares(Coat layer, vec3 view) {
    float reflected = layer.factor * layer.albedo;
    return LayerAlbedo(vec3(reflected), 1.0 - reflected);
}

LayerLight coatEvaluate(Coat layer, vec3 view, vec3 l) {
    LayerLight light = LayerLight(vec3(0.0), 1.0 - layer.factor * layer.albedo, l.z);
    if (l.z > 0.0) {
        vec2 alpha = vec2(layer.alpha);
        vec3 sum = view + l;
        float size = sqrt(dot(sum, sum));
        vec3 fresnel = fresnelSchlick(vec3(layer.f0), 1.0, min(0.5 * size, 1.0));
        light.reflected = fresnel * (layer.factor * ggxDistribution(sum / size, alpha) *
                                     ggxVisibility(l, view, alpha) * l.z);
    }
    return light;
}

vec3 coatSample(Coat layer, vec3 view, vec2 u) {
    vec3 l = reflectAbout(view, sampleVisibleNormal(view, vec2(layer.alpha), u));
    return l.z > 0.0 ? l : vec3(0.0);
}

float coatDensity(Coat layer, vec3 view, vec3 l) {
    return l.z > 0.0 ? mirroredPdf(view, normalize(view + l), vec2(layer.alpha)) : 0.0;
}
