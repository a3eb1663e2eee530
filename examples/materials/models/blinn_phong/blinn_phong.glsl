// Blinn, "Models of light reflection for computer synthesized pictures" (1977). The highlight, seen straight on,
// reflects its colour in all.
#include "bsdf/model.glsl"

struct BlinnPhong {
    GLINT_RELAXED vec3 diffuse;   // both colours together are at most 1
    GLINT_RELAXED vec3 specular;
    float shininess;
    float chance;  // of a sample of the highlight
};

void blinnPhongPrepare(inout BlinnPhong model, vec3 view) {
    float both = luminance(model.diffuse) + luminance(model.specular);
    model.chance = both > 0.0 ? luminance(model.specular) / both : 0.0;
}

vec3 blinnPhongEvaluate(BlinnPhong model, vec3 view, vec3 l) {
    vec3 h = normalize(view + l);
    float n = model.shininess;
    float scale = (n + 2.0) * (n + 4.0) / (8.0 * kPi * (exp2(-0.5 * n) + n));
    float highlight = scale * pow(max(h.z, 0.0), n);
    return (model.diffuse * kInversePi + model.specular * highlight) * l.z;
}

// The share of a uniform sky that a white highlight reflects to a view under this cosine. The fit is within 0.04 of
// quadrature.
float blinnPhongAlbedo(float shininess, float cosine) {
    return cosine * cosine + (2.0 / (shininess + 2.0)) * (1.0 - cosine) * (0.82 + 1.86 * cosine);
}

// Half vectors have the density (n + 1) / 2π times the n-th power of their cosine.
vec3 blinnPhongSample(BlinnPhong model, vec3 view, vec2 u) {
    if (u.x >= model.chance) {
        return sampleCosine(vec2((u.x - model.chance) / (1.0 - model.chance), u.y));
    }
    float cosine = pow(u.x / model.chance, 1.0 / (model.shininess + 1.0));
    float sine = sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0));
    float phi = 2.0 * kPi * u.y;
    vec3 l = reflectAbout(view, vec3(sine * cos(phi), sine * sin(phi), cosine));
    return l.z > 0.0 ? l : vec3(0.0);
}

float blinnPhongDensity(BlinnPhong model, vec3 view, vec3 l) {
    if (l.z <= 0.0) {
        return 0.0;
    }
    vec3 h = normalize(view + l);
    float halves = (model.shininess + 1.0) * (0.5 * kInversePi) * pow(max(h.z, 0.0), model.shininess);
    return mix(cosineDensity(l), halves / (4.0 * max(dot(view, h), 1e-6)), model.chance);
}
