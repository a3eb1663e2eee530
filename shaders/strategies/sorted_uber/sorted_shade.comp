#version 460
// Shades the ordered hits in one dispatch. Buckets begin at multiples of a workgroup, so the switch over the cases is
// uniform in each workgroup.
#define GLINT_CHOOSES_CASES
#define GLINT_MODULE_ALWAYS_LOBES GLINT_HIT_ALWAYS_LOBES
#define GLINT_MODULE_ALWAYS_INPUTS GLINT_HIT_ALWAYS_INPUTS
#define GLINT_MODULE_ANY_LOBES (GLINT_HIT_ALWAYS_LOBES | GLINT_HIT_SOMETIMES_LOBES)
#define GLINT_MODULE_ANY_INPUTS (GLINT_HIT_ALWAYS_INPUTS | GLINT_HIT_SOMETIMES_INPUTS)
#define GLINT_MODULE_MODEL GLINT_HIT_MODEL
#include "hit/resolve.glsl"
#include "generated/cases.glsl"
#if GLINT_HITS_IN_SAMPLES
#include "order/bucket_key.glsl"
#endif

GLINT_RAY_WORKGROUP

// Returns the slot of the workgroup's first thread. A bucket's slots are filled from its beginning, so if any thread of
// the workgroup has a hit, the first thread has one.
uint firstSlot() {
#if GLINT_RAY_GENERATION
    return gl_LaunchIDEXT.x / kRayGroupSize * kRayGroupSize;
#else
    // This uses only built-in variables that are uniform, so that a compiler sees that the switch is uniform.
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kRayGroupSize;
#endif
}

void main() {
    uint index = listIndex();
    if (index >= GLINT_FRAME.bucketDispatch.data[GLINT_FRAME.bucketCount].elementCount) {
        return;
    }
    uint slot = GLINT_FRAME.orderedHits.data[index];
    if (slot == kNoHit) {
        return;
    }
    HitRecord record = storedHit(slot);
    RayRecord ray = shadedRay(slot);
    GLINT_CLOCK_START
    if (record.geometry == kMissGeometry) {
        resolveMiss(ray.target, ray.direction);
        return;
    }
    // The first hit of a workgroup gives the case of all its hits.
#if GLINT_HITS_IN_SAMPLES
    // The first hit's light may already be in the place of the hit, so this reads its bucket.
    uint shaderId = storedKey(GLINT_FRAME.orderedHits.data[firstSlot()]) - 1u;
#else
    uint first = storedGeometry(GLINT_FRAME.orderedHits.data[firstSlot()]);
    uint shaderId = first == kMissGeometry ? kNoShader : hostShaderId(first);
#endif
    HostGeometry geometry = hostGeometry(record.geometry);
    Hit hit = loadHit(record, ray, geometry, GLINT_HIT_FEATURES(geometry));
#if GLINT_DRAWS_FIRST
    drawLightsFirst(hit, GLINT_HIT_FEATURES(geometry));
#endif
    resolveHit(hit, shadeHit(shaderId, hit, geometry));
    GLINT_CLOCK_STOP
}
