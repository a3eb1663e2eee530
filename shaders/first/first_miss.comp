#version 460
// Shades bucket 0: pixels without a surface see the sky. Pixels whose shader ID no case has show an error colour, unless
// the package has a fallback, which shades them in a pass of its own.
#include "generated/skip_effects.glsl"
#include "hit/camera.glsl"
#include "first/first_list.glsl"
#include "first/first_store.glsl"
#include "hit/answer_radiance.glsl"
#if GLINT_SURFACE_LAYERS
#include "generated/sky_layers.glsl"
#endif

GLINT_RAY_WORKGROUP

void main() {
    uint index = listIndex();
    if (index >= GLINT_FRAME.bucketCounts.data[0]) {
        return;
    }
    uvec2 pixel = orderedPixel(index);
    if (!isInPicture(pixel)) {
        return;
    }
    ivec2 place = ivec2(pixel);
    bool seesSky = imageLoad(surfaceImage, place).x == kNoSurface;
#if GLINT_FALLBACK
    if (!seesSky) {
        return;
    }
#endif
#if GLINT_TALLIES
    beginTallies(pixel);
#endif
    CameraRay ray = cameraRay(pixel);
    vec3 radiance = hostSky(ray.direction);
    if (!seesSky) {
        atomicAdd(GLINT_FRAME.counters.data[kCounterUnknownShader], 1u);
        radiance = shadeUnknown().radiance;
    }
    skipEffects(pixel.x + pixel.y * GLINT_FRAME.width, kRayNoSurface);
#if GLINT_SURFACE_LAYERS
    storeSkyLayers(place, ray.direction, radiance);
#endif
    storeFirst(place, radiance, 0.0, vec4(0.0));
}
