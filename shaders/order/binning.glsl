// Sorts the rays of a workgroup by direction before they join the list, so that neighbours in the list walk through the
// same parts of the acceleration structure. The workgroup must have at least kMaxDirectionBins threads, and all of them
// must call.
#include "hit/bindings.glsl"
#include "order/direction_bin.glsl"

shared uint binCounts[kMaxDirectionBins];
shared uint binBegins[kMaxDirectionBins];  // begin of a bin's rays among those of the workgroup
shared uint groupBegin;                    // begin of the workgroup's rays in the list

#define GLINT_COUNT_OF(bin) binCounts[bin]
#include "order/numbering.glsl"

// Returns the slot in the list of a thread's ray, and counts the rays in kCounterRays with one atomic for each
// workgroup. The slot is undefined for a thread without a ray.
uint binnedSlot(bool hasRay, vec3 direction) {
    uint thread = gl_LocalInvocationIndex;
    if (thread < kMaxDirectionBins) {
        binCounts[thread] = 0u;
    }
    barrier();
    uint bin = hasRay ? directionBin(direction, GLINT_FRAME.binning) : kNoGroup;
    uint number = numberInGroup(bin);
    barrier();
    if (thread < kMaxDirectionBins) {
        uint begin = 0u;
        for (uint before = 0u; before < thread; ++before) {
            begin += binCounts[before];
        }
        binBegins[thread] = begin;
        uint total = begin + binCounts[thread];
        if (thread == kMaxDirectionBins - 1u && total > 0u) {
            groupBegin = atomicAdd(GLINT_FRAME.counters.data[kCounterRays], total);
        }
    }
    barrier();
    return hasRay ? groupBegin + binBegins[bin] + number : 0u;
}
