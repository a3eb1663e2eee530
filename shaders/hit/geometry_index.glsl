// Finds the GeometryRecord of a hit from the numbers that a traversal gives.
#include "hit/bindings.glsl"

// Returns the number of the record. Glint's own instances have the number of their first record as custom index; the
// instances of a host may be numbered otherwise, and FrameConstants::firstRecords then leads to that number.
uint geometryOfHit(int instance, int customIndex, int geometry) {
#if GLINT_STEPS
    if (GLINT_FRAME.recordsBy != kRecordsByCustomIndex) {
        int place = GLINT_FRAME.recordsBy == kRecordsByInstanceTable ? instance : customIndex;
        return GLINT_FRAME.firstRecords.data[place] + uint(geometry);
    }
#endif
    return uint(customIndex + geometry);
}

// Rays do not hit instances that share no bit with this mask.
#if GLINT_STEPS
#define GLINT_RAY_MASK GLINT_FRAME.rayMask
#else
#define GLINT_RAY_MASK 0xFFu
#endif
