#version 460
// Traces the ray list into hit records.
#include "hit/list.glsl"
#include "hit/trace.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = listIndex();
    if (index < GLINT_FRAME.rayDispatch.data[0].elementCount) {
        GLINT_FRAME.hits.data[index] = traceRay(GLINT_FRAME.rays.data[index], index);
    }
}
