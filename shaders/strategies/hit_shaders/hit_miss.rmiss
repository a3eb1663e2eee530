#version 460
// The ray left the scene. Ray generation adds the sky.
#extension GL_EXT_ray_tracing : require
#include "strategies/hit_shaders/payload.glsl"

layout(location = 0) rayPayloadInEXT HitPayload shaded;

void main() {
    shaded.shadowDistance = -1.0;
}
