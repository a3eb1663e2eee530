// Flakes: a layer of metallic microfacets about a normal that is not that of the surface.
#include "bsdf/albedo.glsl"
#include "bsdf/layer.glsl"
#include "materials/clearcoat/clearcoat.glsl"

struct Flakes {
    GLINT_RELAXED vec3 color;  // what the flakes reflect, times their share of the surface
    GLINT_RELAXED float coverage;
    Clearcoat facets;  // their lobe: a coat that reflects all light
};

void flakesPrepare(inout Flakes layer, vec3 view) {}

LayerAlbedo flakesShares(Flakes layer, vec3 view) {
    // Flakes that turn away from the viewer show nothing.
    bool isSeen = clearcoatFacesViewer(layer.facets, view);
    float single = isSeen ? 1.0 - ggxLoss(clearcoatViewCosine(layer.facets, view), layer.facets.alpha) : 0.0;
    return LayerAlbedo(layer.color * single, 1.0 - layer.coverage);
}

LayerMirror flakesMirror(Flakes layer) {
    return clearcoatMirror(layer.facets);
}

LayerLight flakesEvaluate(Flakes layer, vec3 view, vec3 l) {
    float nDotL = accurateDot(layer.facets.normal, l);
    float nDotV = clearcoatViewCosine(layer.facets, view);
    LayerLight light = LayerLight(vec3(0.0), 1.0 - layer.coverage, nDotL);
    if (nDotL > 0.0 && clearcoatFacesViewer(layer.facets, view)) {
        light.reflected =
            layer.color * (nDotL * clearcoatLobe(layer.facets.normal, nDotL, nDotV, view, l, layer.facets.alpha));
    }
    return light;
}

vec3 flakesSample(Flakes layer, vec3 view, vec2 u) {
    return clearcoatSample(layer.facets, view, u);
}

float flakesDensity(Flakes layer, vec3 view, vec3 l) {
    return clearcoatDensity(layer.facets, view, l);
}
