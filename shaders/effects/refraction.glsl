// The effect refraction: which surfaces let light through. Where their rays go the walk finds out
// (passes/refraction_walk.comp).
#include "effects/sample.glsl"
#include "effects/sky_shares.glsl"
#include "hit/surface.glsl"

EffectSample sampleRefraction(Hit hit, Surface surface, Features features, inout SkyShares sky) {
    if (!hasLobe(features, GLINT_TRANSMISSION)) {
        return noSample(kRayAbsent);
    }
    float share = baseShare(surface, features);
    vec3 weight = surface.bsdf.transmitted * (diffusePassed(surface) * share);
    sky.transmitted = 0.0;
    // The walk begins at the surface again, without its coat and sheen: what they let through goes with the sample, in
    // the place of the cone, which the walk makes anew.
    return sentSample(hit, -hit.view, weight, share);
}
