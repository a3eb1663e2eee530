#version 460
#extension GL_EXT_ray_tracing : require
// The shadow ray of primary.rgen has reached its light.

layout(location = 0) rayPayloadInEXT uint reached;

void main() {
    reached = 1u;
}
