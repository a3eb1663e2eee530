// The start of a reflection ray: in screen space, if the settings ask for that.
#include "effects/screen_trace.glsl"

// Returns whether the ray's end is found. Otherwise the ray begins behind the part that is known to be free.
bool endsEarly(inout EffectSample drawn, ivec2 place, uint target) {
    if (GLINT_FRAME.screenSteps == 0u) {
        return false;
    }
    ScreenMarch march = marchScreen(drawn.origin, drawn.direction);
    if (march.found) {
        storeRadiance(target, screenRadiance(march.place, drawn.direction), kPathScreen);
#if GLINT_LAYER_RAYS
        GLINT_FRAME.rayHits.data[samplePlace(target)] =
            RayHit(kScreenGeometry, uint(march.place.x) + uint(march.place.y) * GLINT_FRAME.width, vec2(0.0),
                   drawn.direction, distance(drawn.origin, imageLoad(positionImage, march.place).xyz));
#endif
        return true;
    }
#if GLINT_LAYER_RAYS
    GLINT_FRAME.rayHits.data[samplePlace(target)].distance = march.distance;
#endif
    drawn.origin += march.distance * drawn.direction;
    drawn.coneWidth += march.distance * drawn.coneSpread;
    return false;
}
