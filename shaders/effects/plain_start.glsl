// How the ray of most effects begins: at the surface.
#include "hit/samples.glsl"

bool endsEarly(inout EffectSample drawn, ivec2 place, uint target) {
    return false;
}
