#version 460
// Nothing was hit.
#extension GL_EXT_ray_tracing : require
#include "hit/bindings.glsl"
#include "hit/payload.glsl"

layout(location = 0) rayPayloadInEXT TracePayload traced;

void main() {
    traced.geometry = kMissGeometry;
}
