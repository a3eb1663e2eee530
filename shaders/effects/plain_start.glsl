// The start of the ray for most effects: at the surface.
#include "hit/samples.glsl"

bool endsEarly(inout EffectSample drawn, ivec2 place, uint target) {
    return false;
}
