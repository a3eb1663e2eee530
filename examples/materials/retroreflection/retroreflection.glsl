// Retroreflection: the GGX lobe of a mirror, for the view mirrored at the normal. It lies about the view itself.
#include "bsdf/albedo.glsl"
#include "bsdf/ggx.glsl"
#include "bsdf/layer.glsl"

struct Retroreflection {
    GLINT_RELAXED vec3 color;
    GLINT_RELAXED float factor;
    float alpha;
};

void retroreflectionPrepare(inout Retroreflection layer, vec3 view) {}

LayerAlbedo retroreflectionShares(Retroreflection layer, vec3 view) {
    return LayerAlbedo(layer.color * (layer.factor * (1.0 - ggxLoss(view.z, layer.alpha))), 1.0 - layer.factor);
}

LayerLight retroreflectionEvaluate(Retroreflection layer, vec3 view, vec3 l) {
    LayerLight light = LayerLight(vec3(0.0), 1.0 - layer.factor, l.z);
    if (l.z > 0.0) {
        vec3 back = vec3(-view.xy, view.z);
        vec2 alpha = vec2(layer.alpha);
        light.reflected = layer.color * (layer.factor * ggxDistribution(normalize(back + l), alpha) *
                                         ggxVisibility(l, back, alpha) * l.z);
    }
    return light;
}

vec3 retroreflectionSample(Retroreflection layer, vec3 view, vec2 u) {
    vec3 back = vec3(-view.xy, view.z);
    vec3 l = reflectAbout(back, sampleVisibleNormal(back, vec2(layer.alpha), u));
    return l.z > 0.0 ? l : vec3(0.0);
}

float retroreflectionDensity(Retroreflection layer, vec3 view, vec3 l) {
    vec3 back = vec3(-view.xy, view.z);
    return l.z > 0.0 ? mirroredPdf(back, normalize(back + l), vec2(layer.alpha)) : 0.0;
}
