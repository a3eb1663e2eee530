#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"

layout(location = 0) flat in uint primitive;
layout(location = 0) out uvec2 surface;

void main() {
    surface = uvec2(pushed.geometry, primitive);
}
