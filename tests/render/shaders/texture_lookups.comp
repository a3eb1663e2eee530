#version 460
// Reads the base colour texture of materials. In each RayRecord, target is the material, origin.xy are the coordinates,
// and origin.z is the level of detail. If coneWidth is above 0, direction.xy and direction.z, coneWidth are the axes of
// the footprint instead.
#include "hit/bindings.glsl"
#include "hit/surface_point.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= GLINT_FRAME.width) {
        return;
    }
    RayRecord ray = GLINT_FRAME.rays.data[index];
    SurfacePoint point;
    point.material = ray.target;
    TextureRecord record = GLINT_TEXTURE(GLINT_MATERIAL(point), kBaseColorTexture);
    vec4 texel = ray.coneWidth > 0.0 ? hostTexture(record, ray.origin.xy, vec4(ray.direction, ray.coneWidth))
                                     : textureLod(GLINT_SAMPLER(record), ray.origin.xy, ray.origin.z);
    for (uint i = 0u; i < 4u; ++i) {
        GLINT_FRAME.counters.data[4u * index + i] = floatBitsToUint(texel[i]);
    }
}
