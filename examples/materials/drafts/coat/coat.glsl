// A coat of OpenPBR: a GGX lobe about a normal of its own, with the Fresnel of an index of refraction. What it does not
// reflect of the view's light passes: OpenPBR 1.1, "Albedo-scaling". So it is not reciprocal, and its energy is exact.
#include "bsdf/albedo.glsl"
#include "bsdf/ggx.glsl"
#include "bsdf/layer.glsl"

struct Coat {
    GLINT_RELAXED float factor;
    vec2 alpha;    // along the tangent and across it; the first is not the smaller one
    float f0;      // reflectance at normal incidence
    vec3 normal;   // the coat's frame in that of the base: unit vectors at a right angle
    vec3 tangent;
    // coatPrepare() sets the others:
    vec3 view;     // in the coat's frame
    float albedo;  // share of a white sky that the coat reflects, where it covers the surface
};

// A coat whose normal turns away from the viewer by more has the base's normal.
const float kMinCoatCosine = 1e-3;

vec3 toCoat(Coat layer, vec3 direction) {
    return vec3(dot(layer.tangent, direction), dot(cross(layer.normal, layer.tangent), direction),
                dot(layer.normal, direction));
}

void coatPrepare(inout Coat layer, vec3 view) {
    if (dot(layer.normal, view) < kMinCoatCosine) {
        layer.normal = vec3(0.0, 0.0, 1.0);
        layer.tangent = vec3(1.0, 0.0, 0.0);
    }
    layer.view = toCoat(layer, view);
    vec2 lossBias = anisotropicGgxAlbedo(layer.view, layer.alpha);
    layer.albedo = layer.f0 * (1.0 - lossBias.x - lossBias.y) + lossBias.y;
}

LayerAlbedo coatShares(Coat layer, vec3 view) {
    float reflected = layer.factor * layer.albedo;
    return LayerAlbedo(vec3(reflected), 1.0 - reflected);
}

LayerLight coatEvaluate(Coat layer, vec3 view, vec3 l) {
    vec3 lit = toCoat(layer, l);
    LayerLight light = LayerLight(vec3(0.0), 1.0 - layer.factor * layer.albedo, lit.z);
    if (lit.z > 0.0) {
        vec3 sum = layer.view + lit;
        float size = sqrt(dot(sum, sum));
        vec3 fresnel = fresnelSchlick(vec3(layer.f0), 1.0, min(0.5 * size, 1.0));
        light.reflected = fresnel * (layer.factor * ggxDistribution(sum / size, layer.alpha) *
                                     ggxVisibility(lit, layer.view, layer.alpha) * lit.z);
    }
    return light;
}

vec3 coatSample(Coat layer, vec3 view, vec2 u) {
    vec3 lit = reflectAbout(layer.view, sampleVisibleNormal(layer.view, layer.alpha, u));
    vec3 bitangent = cross(layer.normal, layer.tangent);
    return lit.z > 0.0 ? normalize(layer.tangent * lit.x + bitangent * lit.y + layer.normal * lit.z) : vec3(0.0);
}

float coatDensity(Coat layer, vec3 view, vec3 l) {
    vec3 lit = toCoat(layer, l);
    return lit.z > 0.0 ? mirroredPdf(layer.view, normalize(layer.view + lit), layer.alpha) : 0.0;
}
