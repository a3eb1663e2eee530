// Stores a first hit in the images that later passes read.
#include "hit/images.glsl"

// Stores the light that leaves the surface of a pixel, without that of rays, and its distance in metres. `origin` is
// where rays leave the surface.
void storeFirst(ivec2 place, vec3 radiance, float depth, vec4 origin) {
    imageStore(radianceImage, place, storable(vec4(radiance, depth * GLINT_FRAME.perLengthUnit)));
#if GLINT_STARTS_ON_SCREEN
    if (GLINT_FRAME.screenSteps != 0u) {
        imageStore(positionImage, place, origin);
    }
#endif
}
