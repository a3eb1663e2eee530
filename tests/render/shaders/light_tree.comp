#version 460
// For points (origin), packed normals (target), places and random numbers (direction): the light that the tree chooses,
// how many samples it expects, the sum of these over all lights, what is wrong, and the second moment of a sample
// without shadows over the square of its mean.
#include "bsdf/fresnel.glsl"
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
    LightReceiver receiver = LightReceiver(ray.origin, unpackReceiver(ray.target));
    float chance;
    uint chosen = lightOfTree(receiver, ray.direction.x, ray.direction.yz, chance);
    float sum = 0.0;
    uint unreachable = 0u;
    float evaluated = -1.0;
    float light1 = 0.0;
    float light2 = 0.0;
    for (uint node = 0u; node < GLINT_FRAME.lightTreeNodes; ++node) {
        uint next = GLINT_FRAME.lightNodes.data[node].next;
        if ((next & kLightLeaf) == 0u) {
            continue;
        }
        uint light = next & ~kLightLeaf;
        float own = lightChance(receiver, node);
        sum += own;
        LightSample arriving = sampleLight(GLINT_FRAME.lights.data[light], ray.origin);
        bool both = receiver.normal == vec3(0.0);
        float cosine = both ? 1.0 : max(dot(receiver.normal, arriving.direction), 0.0);
        float arrives = cosine * luminance(arriving.irradiance);
        unreachable += own <= 0.0 && arrives > 0.0 ? 1u : 0u;
        light1 += arrives;
        light2 += own > 0.0 ? arrives * arrives / own : 0.0;
        evaluated = light == chosen ? own : evaluated;
    }
    GLINT_FRAME.counters.data[6u * index] = chosen;
    GLINT_FRAME.counters.data[6u * index + 1u] = floatBitsToUint(chance);
    GLINT_FRAME.counters.data[6u * index + 2u] = floatBitsToUint(evaluated);
    GLINT_FRAME.counters.data[6u * index + 3u] = floatBitsToUint(sum);
    GLINT_FRAME.counters.data[6u * index + 4u] = unreachable;
    GLINT_FRAME.counters.data[6u * index + 5u] = floatBitsToUint(light1 > 0.0 ? light2 / (light1 * light1) : 1.0);
}
