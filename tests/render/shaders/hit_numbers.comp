#version 460
// The geometry and the triangle that each ray hits first, by their numbers; a miss leaves kMissGeometry.
#include "hit/hit.glsl"
#include "hit/trace.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= GLINT_FRAME.width) {
        return;
    }
    TracedHit record = traceRay(GLINT_FRAME.rays.data[index], 0u);
    GLINT_FRAME.counters.data[2u * index] = record.geometry;
    GLINT_FRAME.counters.data[2u * index + 1u] = record.primitive;
}
