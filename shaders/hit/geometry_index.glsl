// From what a traversal says about a hit to its GeometryRecord.
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

// Instances that share no bit with it are not hit.
#if GLINT_STEPS
#define GLINT_RAY_MASK GLINT_FRAME.rayMask
#else
#define GLINT_RAY_MASK 0xFFu
#endif
