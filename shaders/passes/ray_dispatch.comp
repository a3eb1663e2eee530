#version 460
// Indirect arguments for the passes over the ray list.
#include "hit/list.glsl"
#include "hit/tile_sort.glsl"

layout(local_size_x = 1) in;

void main() {
    uint rays = GLINT_FRAME.counters.data[kCounterRays];
    // One workgroup at least, without rays, too: the last one says that buckets are empty.
    DispatchArguments count = listDispatch(max(rays, 1u), kKeysOfVector * kCountGroupSize);
    count.x = min(count.x, kMaxCountGroups);
    count.y = 1u;
    GLINT_FRAME.rayDispatch.data[kDispatchRays] = listDispatch(rays, kRayGroupSize);
    GLINT_FRAME.rayDispatch.data[kDispatchCount] = count;
    GLINT_FRAME.rayDispatch.data[kDispatchTiles] = listDispatch(rays, kTileHits);
}
