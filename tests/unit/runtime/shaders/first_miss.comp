#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "images.glsl"
#include "first_list.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    if (hasPixel()) {
        storeFirst(shadedPixel(), vec4(0.0));
    }
}
