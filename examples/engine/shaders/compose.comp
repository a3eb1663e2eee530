#version 460
#extension GL_GOOGLE_include_directive : require
// Adds what the rays found.
#include "engine.glsl"

layout(local_size_x = 64) in;

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel < FRAME.width * FRAME.height) {
        vec3 weight = FRAME.weights.data[pixel].rgb;
        if (weight != vec3(0.0)) {
            FRAME.colors.data[pixel].rgb += weight * FRAME.answers.data[pixel].rgb;
        }
    }
}
