#version 460
// Puts the rays that hits have sent on the list of the next bounce. Paths that ended leave no gap.
#include "order/append.glsl"
#include "order/binning.glsl"
#include "hit/list.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = listIndex();
    bool inside = index < GLINT_FRAME.rayDispatch.data[0].elementCount;
    uint target = GLINT_FRAME.rays.data[inside ? index : 0u].target;
    bool goesOn = inside && GLINT_FRAME.paths.data[target].goesOn != 0u;
    PathState path = GLINT_FRAME.paths.data[target];
    uint slot;
    if (GLINT_FRAME.binning == kBinningNone) {
        slot = appendedSlot(goesOn);
    } else {
        slot = binnedSlot(goesOn, path.direction);
    }
    if (goesOn) {
        if (GLINT_FRAME.bounceWeight != 1.0) {
            GLINT_FRAME.paths.data[target].throughput = path.throughput * GLINT_FRAME.bounceWeight;
        }
        GLINT_FRAME.nextRays.data[slot] =
            RayRecord(path.origin, target, path.direction, path.coneWidth, path.coneSpread);
    }
}
