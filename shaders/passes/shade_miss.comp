#version 460
// Shades bucket 0: rays that left the scene see the sky. No shadow ray.
#include "effects/sky.glsl"
#include "hit/images.glsl"
#include "hit/list.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = listIndex();
    BucketRecord bucket = GLINT_FRAME.buckets.data[0];
    if (index >= bucket.count) {
        return;
    }
    HitRecord hit = GLINT_FRAME.hits.data[GLINT_FRAME.orderedHits.data[bucket.begin + index]];
    vec3 radiance = vec3(1.0, 0.0, 1.0);
    if (hit.geometry == kMissGeometry) {
        radiance = skyRadiance(vec3(hit.barycentricU_orDirectionX, hit.barycentricV_orDirectionY,
                                    hit.distance_orDirectionZ));
    } else {
        atomicAdd(GLINT_FRAME.counters.data[kCounterUnknownShader], 1u);
    }
    imageStore(reflectionImage, pixelCoordinates(hit.pixel), vec4(radiance, 1.0));
}
