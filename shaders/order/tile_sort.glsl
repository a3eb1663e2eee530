// The parts that the passes of the ordering tile-sort share.
#include "order/bucket_key.glsl"

// Renderers refuse this ordering if there are more buckets than kMaxLocalBuckets.
const uint kLocalBuckets = min(kBuckets, kMaxLocalBuckets);
