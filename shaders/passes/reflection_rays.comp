#version 460
// Finds reflections in screen space where that is asked for, and appends the ray of every other pixel that sends one to
// the list. The list holds a ray for every pixel, so it can't overflow.
#include "effects/screen_trace.glsl"
#include "hit/binning.glsl"
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
    vec3 direction = reflectionRay.xyz;
    uint outcome = floatBitsToUint(reflectionRay.w);
    countInSubgroup(kCounterSkippedSky, inside && outcome == kRayNoSurface);
    countInSubgroup(kCounterSkippedUnlit, inside && outcome == kRayUnlit);
    countInSubgroup(kCounterSkippedRough, inside && outcome == kRayRough);
    countInSubgroup(kCounterSkippedBlack, inside && outcome == kRayBlack);

    vec3 origin = imageLoad(positionImage, place).xyz;
    bool reflects = inside && outcome == kRaySent;
    ScreenMarch march = ScreenMarch(false, place, 0.0);
    if (reflects && GLINT_FRAME.screenSteps > 0u) {
        march = marchScreen(origin, direction);
    }
    if (march.found) {
        imageStore(reflectionImage, place, vec4(screenRadiance(march.place, direction), float(kPathScreen)));
    }
    countInSubgroup(kCounterScreenHits, march.found);

    bool traced = reflects && !march.found;
    uint slot;
    if (GLINT_FRAME.binning == kBinningNone) {
        slot = countInSubgroup(kCounterRays, traced);
    } else {
        slot = binnedSlot(traced, direction);
    }
    if (!traced) {
        return;
    }

    CameraRay camera = cameraRay(pixel);
    RayRecord ray;
    ray.origin = origin + march.distance * direction;
    ray.pixel = pixel.x + pixel.y * GLINT_FRAME.width;
    ray.direction = direction;
    // A flat mirror continues the pixel's cone.
    ray.coneSpread = GLINT_FRAME.pixelSpread;
    ray.coneWidth =
        GLINT_FRAME.pixelWidth + GLINT_FRAME.pixelSpread * (distance(origin, camera.origin) + march.distance);
    GLINT_FRAME.rays.data[slot] = ray;
}
