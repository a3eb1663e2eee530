// The cosine of Lambert's law in steps. Their mean over the hemisphere is that of the cosine, so the share of a uniform
// sky that the surface reflects is its colour.
#include "bsdf/model.glsl"

struct Toon {
    GLINT_RELAXED vec3 color;
    float bands;
};

void toonPrepare(inout Toon model, vec3 view) {}

vec3 toonEvaluate(Toon model, vec3 view, vec3 l) {
    return model.color * (kInversePi * floor(l.z * model.bands + 0.5) / model.bands);
}
