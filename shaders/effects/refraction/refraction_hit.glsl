// The sky's light on a surface at which a refracted ray ended.
#include "bsdf/features.glsl"
#include "effects/sky_shares.glsl"
#include "hit/hit.glsl"

void hitRefraction(Hit hit, Features features, inout SkyShares sky) {
    if (passesFacets(features)) {
        // The walk of the refracted ray has chosen the light that does not pass.
        sky.transmitted = 0.0;
    }
}
