#version 460
// Indirect arguments for the passes over the ray list.
#include "hit/list.glsl"
#include "hit/tile_sort.glsl"

layout(local_size_x = 1) in;

void main() {
    uint rays = GLINT_FRAME.counters.data[kCounterRays];
    DispatchArguments count = listDispatch(rays, kKeysOfVector * kCountGroupSize);
    count.x = min(count.x, kMaxCountGroups);
    count.y = min(count.y, 1u);
    GLINT_FRAME.rayDispatch.data[kDispatchRays] = listDispatch(rays, kRayGroupSize);
    GLINT_FRAME.rayDispatch.data[kDispatchCount] = count;
    GLINT_FRAME.rayDispatch.data[kDispatchTiles] = listDispatch(rays, kTileHits);
}
