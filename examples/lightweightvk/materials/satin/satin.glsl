// The engine's material, for Glint. Its formula is in a file that the engine's own shader includes, too.
#include "bsdf/model.glsl"
#include "satin_light.glsl"

void satinPrepare(inout Satin model, vec3 view) {}

vec3 satinEvaluate(Satin model, vec3 view, vec3 l) {
    return satinLight(model, view, l);
}
