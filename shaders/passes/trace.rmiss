#version 460
// Nothing was hit.
#extension GL_EXT_ray_tracing : require
#include "hit/payload.glsl"
#include "interop/frame.h"

layout(location = 0) rayPayloadInEXT TracePayload traced;

void main() {
    traced.geometry = kMissGeometry;
}
