// The flags of rays in the list.
#include "hit/samples.glsl"

// Rays see the front of single-sided surfaces, as the camera does. Within a volume they see its back, too.
uint rayFlags(uint target) {
#if GLINT_PATHS
    if (GLINT_FRAME.bounce > 1u && GLINT_FRAME.paths.data[samplePlace(target)].media[0] != 0u) {
        return 0u;
    }
#endif
    return gl_RayFlagsCullBackFacingTrianglesEXT;
}
