#version 460
// For points (origin) and random numbers (direction): the light that the tree chooses, how probable that is, the sum of
// the probabilities of all lights, and what is wrong.
#include "hit/bindings.glsl"
#include "light/punctual.glsl"
#include "light/tree.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= GLINT_FRAME.width) {
        return;
    }
    RayRecord ray = GLINT_FRAME.rays.data[index];
    LightReceiver receiver = LightReceiver(ray.origin, vec3(0.0));
    float probability;
    uint chosen = lightOfTree(receiver, ray.direction, probability);
    float sum = 0.0;
    uint unreachable = 0u;
    float evaluated = -1.0;
    for (uint node = 0u; node < GLINT_FRAME.lightTreeNodes; ++node) {
        uint next = GLINT_FRAME.lightNodes.data[node].next;
        if ((next & kLightLeaf) == 0u) {
            continue;
        }
        uint light = next & ~kLightLeaf;
        float own = lightProbability(receiver, node);
        sum += own;
        LightSample arriving = sampleLight(GLINT_FRAME.lights.data[light], ray.origin);
        unreachable += own <= 0.0 && dot(arriving.irradiance, vec3(1.0)) > 0.0 ? 1u : 0u;
        evaluated = light == chosen ? own : evaluated;
    }
    GLINT_FRAME.counters.data[5u * index] = chosen;
    GLINT_FRAME.counters.data[5u * index + 1u] = floatBitsToUint(probability);
    GLINT_FRAME.counters.data[5u * index + 2u] = floatBitsToUint(evaluated);
    GLINT_FRAME.counters.data[5u * index + 3u] = floatBitsToUint(sum);
    GLINT_FRAME.counters.data[5u * index + 4u] = unreachable;
}
