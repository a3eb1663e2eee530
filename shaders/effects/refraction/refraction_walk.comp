#version 460
// Follows refracted rays from one interface to the next, until they leave the scene or meet a surface that lets nothing
// through. That hit is left to the list, and is shaded like those of every effect.
//
// At an interface the ray is randomly reflected or passed, in proportion to Fresnel. In a medium it is attenuated over
// the real distance (Beer and Lambert). Overlapping media are nested: the medium that a ray enters last is the first
// that it leaves, and each surface lies between its medium and the surrounding one.
#define GLINT_MODULE_ALWAYS_LOBES 0u
#define GLINT_MODULE_ALWAYS_INPUTS (GLINT_ALWAYS_INPUTS)
#define GLINT_MODULE_ANY_LOBES ((GLINT_ALWAYS_LOBES | GLINT_SOMETIMES_LOBES) & GLINT_INTERFACE_LOBES)
#define GLINT_MODULE_ANY_INPUTS (GLINT_ALWAYS_INPUTS | GLINT_SOMETIMES_INPUTS | GLINT_ROLE_DOUBLE_SIDED)
#define GLINT_MODULE_MODEL 0u
#include "effects/refraction/refraction_walk.glsl"

GLINT_PIXEL_WORKGROUP

void main() {
    uvec2 pixel = GLINT_PIXEL_OF_THREAD;
    bool inside = pixel.x < GLINT_FRAME.width && pixel.y < GLINT_FRAME.endRow;
    uint segments = 0u;
    if (inside) {
#if GLINT_TALLIES
        tallyForPixel(pixel.x + pixel.y * GLINT_FRAME.width);
#endif
        GLINT_CLOCK_START
        uint target = sampleTarget(GLINT_SLOT_REFRACTION, pixel.x + pixel.y * GLINT_FRAME.width);
        if (sampleOutcome(target) == kRaySent) {
            segments = walk(pixel, target);
        }
#if GLINT_LAYER_WALKS
        GLINT_FRAME.walkedLight.data[samplePlace(target)].light = foundOnWalk;
#endif
        GLINT_CLOCK_STOP
    }
    addToCounter(counterOf(kEffectRefraction, kCountSegments), segments);
}
