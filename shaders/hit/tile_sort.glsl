// What the passes of the ordering tile-sort share.
#include "hit/bucket_key.glsl"

// Renderers refuse this ordering where there are more buckets than kMaxLocalBuckets.
const uint kLocalBuckets = min(kBuckets, kMaxLocalBuckets);

// A tile: as many hits as a workgroup sorts. Each thread has those of one vector of keys.
#define GLINT_TILE_GROUP_SIZE (kTileHits / kKeysOfVector)
