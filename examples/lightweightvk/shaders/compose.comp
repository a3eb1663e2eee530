// Adds the light of both rays to each pixel.
#include "frame.glsl"
layout(local_size_x = 64) in;

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    for (uint i = 2u * pixel; i < 2u * pixel + 2u && pixel < frame.width * frame.height; ++i) {
        frame.sums.data[pixel].rgb += frame.weights.data[i].rgb * frame.answers.data[i].rgb;
    }
}
