#version 460
#extension GL_GOOGLE_include_directive : require
// Stores which triangle a pixel shows.
#include "engine.glsl"

layout(location = 0) out uvec2 seen;

void main() {
    seen = uvec2(pushed.geometry, uint(gl_PrimitiveID));
}
