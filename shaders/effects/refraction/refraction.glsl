// The effect refraction: decides which surfaces let light through. The walk finds where their rays go
// (refraction_walk.comp).
#include "effects/sample.glsl"
#include "effects/sky_shares.glsl"
#include "hit/surface.glsl"

EffectSample sampleRefraction(Hit hit, Surface surface, Features features, inout SkyShares sky) {
    if (!passesFacets(features)) {
        return noSample(kRayAbsent);
    }
    float share = baseShare(surface, features);
    vec3 weight = surface.bsdf.base.transmitted * (diffusePassed(surface.bsdf.base) * share);
    sky.transmitted = 0.0;
    // The walk begins again at the surface, without its coat and sheen. The share that these let through is stored in
    // the place of the cone, which the walk computes anew.
#if GLINT_SAMPLE_RECORD_PACKED
    // Packed records round the cone. The walk computes the start of the ray anew as well.
    EffectSample drawn = sentSample(hit, -hit.view, weight, 0.0);
    drawn.origin = vec3(share);
    return drawn;
#else
    return sentSample(hit, -hit.view, weight, share);
#endif
}
