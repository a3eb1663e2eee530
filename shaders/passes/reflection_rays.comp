#version 460
// Appends the ray of every pixel that sends one to the list. One atomic a subgroup. The list holds a ray for every
// pixel, so it can't overflow.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "hit/camera.glsl"
#include "hit/images.glsl"

layout(local_size_x = kPixelGroupSize, local_size_y = kPixelGroupSize) in;

// Adds the number of threads that say so to a counter; returns the first of the counts given to this subgroup.
uint countInSubgroup(uint counter, bool counted) {
    uvec4 ballot = subgroupBallot(counted);
    uint base = 0u;
    if (subgroupElect()) {
        uint total = subgroupBallotBitCount(ballot);
        if (total > 0u) {
            base = atomicAdd(GLINT_FRAME.counters.data[counter], total);
        }
    }
    return subgroupBroadcastFirst(base) + subgroupBallotExclusiveBitCount(ballot);
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    bool inside = pixel.x < GLINT_FRAME.width && pixel.y < GLINT_FRAME.height;
    ivec2 place = ivec2(min(pixel, uvec2(GLINT_FRAME.width - 1u, GLINT_FRAME.height - 1u)));
    vec4 reflectionRay = imageLoad(reflectionRayImage, place);
    uint outcome = floatBitsToUint(reflectionRay.w);
    countInSubgroup(kCounterSkippedSky, inside && outcome == kRayNoSurface);
    countInSubgroup(kCounterSkippedUnlit, inside && outcome == kRayUnlit);
    countInSubgroup(kCounterSkippedRough, inside && outcome == kRayRough);
    countInSubgroup(kCounterSkippedBlack, inside && outcome == kRayBlack);
    bool traced = inside && outcome == kRaySent;
    uint slot = countInSubgroup(kCounterRays, traced);
    if (!traced) {
        return;
    }

    vec3 origin = imageLoad(positionImage, place).xyz;
    CameraRay camera = cameraRay(pixel);
    RayRecord ray;
    ray.origin = origin;
    ray.pixel = pixel.x + pixel.y * GLINT_FRAME.width;
    ray.direction = reflectionRay.xyz;
    // A flat mirror continues the pixel's cone.
    ray.coneWidth = GLINT_FRAME.pixelWidth + GLINT_FRAME.pixelSpread * distance(origin, camera.origin);
    ray.coneSpread = GLINT_FRAME.pixelSpread;
    GLINT_FRAME.rays.data[slot] = ray;
}
