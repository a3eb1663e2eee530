#include "hit/bindings.glsl"
#include "hit/record.glsl"

// Returns the bucket of a ray's hit: 0 for a miss, 1 + shader ID otherwise. A hit with an ID that no case has goes to
// the misses; their pass shows it in an error colour and counts it.
uint bucketOfGeometry(uint geometry) {
    if (geometry == kMissGeometry) {
        return 0u;
    }
    uint bucket = 1u + hostShaderId(geometry);
    return bucket < GLINT_FRAME.bucketCount ? bucket : 0u;
}
