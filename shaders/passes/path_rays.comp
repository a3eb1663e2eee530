#version 460
// Puts the rays that hits have sent on the list of the next bounce. Paths that ended leave no gap.
#include "order/append.glsl"
#include "order/binning.glsl"
#include "hit/list.glsl"
#include "hit/samples.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = listIndex();
    bool inside = index < GLINT_FRAME.rayDispatch.data[0].elementCount;
    uint target = listedTarget(inside ? index : 0u);
    bool goesOn = inside && sampleOutcome(target) == kRaySent;
    uint slot;
    if (GLINT_FRAME.binning == kBinningNone) {
        slot = appendedSlot(goesOn);
    } else {
        slot = binnedSlot(goesOn, sampleDirection(target));
    }
    if (goesOn) {
        if (GLINT_FRAME.bounceWeight != 1.0) {
            GLINT_FRAME.paths.data[samplePlace(target)].throughput *= GLINT_FRAME.bounceWeight;
        }
        GLINT_FRAME.nextListed.data[slot] = target;
    }
}
