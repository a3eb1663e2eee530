// Lambert's law on both sides.
#include "bsdf/model.glsl"

struct Leaf {
    GLINT_RELAXED vec3 reflected;
    GLINT_RELAXED vec3 passed;
};

void leafPrepare(inout Leaf model, vec3 view) {}

vec3 leafEvaluate(Leaf model, vec3 view, vec3 l) {
    return (l.z > 0.0 ? model.reflected : model.passed) * (kInversePi * abs(l.z));
}
