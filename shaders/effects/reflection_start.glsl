// How a reflection ray begins: in screen space, where that is asked for.
#include "effects/screen_trace.glsl"

// Whether the ray's end is found; otherwise it begins behind what it is known to pass.
bool endsEarly(inout EffectSample drawn, ivec2 place, uint target) {
    if (GLINT_FRAME.screenSteps == 0u) {
        return false;
    }
    ScreenMarch march = marchScreen(drawn.origin, drawn.direction);
    if (march.found) {
        storeRadiance(target, screenRadiance(march.place, drawn.direction), kPathScreen);
        return true;
    }
    drawn.origin += march.distance * drawn.direction;
    drawn.coneWidth += march.distance * drawn.coneSpread;
    return false;
}
