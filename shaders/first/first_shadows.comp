#version 460
// Traces the shadow rays that first hits have left in memory, and adds the light that arrives.
#include "effects/shadow/shadow.glsl"
#include "first/first_list.glsl"
#include "hit/images.glsl"
#include "hit/primary.glsl"

GLINT_PIXEL_WORKGROUP

void main() {
    uvec2 pixel = GLINT_PIXEL_OF_THREAD;
    if (!isInPicture(pixel)) {
        return;
    }
    uint target = pixel.x + pixel.y * GLINT_FRAME.width;
    uint place = target - GLINT_FRAME.bandFirst;
    uint sent = GLINT_FRAME.firstShadowCounts.data[place];
    uint first = kFirstShadowRays * pushed.shadowRound;
    if (sent <= first) {
        return;
    }
#if GLINT_TALLIES
    beginTallies(pixel);
#endif
    GLINT_CLOCK_START
    // The origin of the rays needs no attribute of the vertices.
    const Features kNone = GLINT_FEATURES_OF_GLTF(0u, 0u, 0u, 0u, 0u, 0u);
    uvec2 seen = imageLoad(surfaceImage, ivec2(pixel)).xy;
    Hit hit = primaryHit(hostGeometry(seen.x), seen.y, cameraRay(pixel), target, kNone);
    ShadowCounts counts = ShadowCounts(0u, 0u, 0u, 0u, 0u);
    vec3 sum = vec3(0.0);
    for (uint ray = 0u; ray < min(sent - first, kFirstShadowRays); ++ray) {
        sum += traceShadow(hit, waitingShadow(firstShadowPlace(place, ray)), counts);
    }
    countRays(kEffectShadow, counts.rays, counts.misses);
    if (kCountsLight) {
        addToCounter(counterOf(kEffectShadow, kCountWaited), counts.rays);
    }
    vec4 light = imageLoad(radianceImage, ivec2(pixel));
    imageStore(radianceImage, ivec2(pixel), storable(vec4(light.rgb + sum, light.a)));
    GLINT_CLOCK_STOP
}
