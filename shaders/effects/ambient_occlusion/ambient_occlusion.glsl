// The effect ambient occlusion: how much of the sky a surface sees, weighted by the cosine to its normal.
#include "bsdf/sample.glsl"
#include "effects/sky_shares.glsl"
#include "hit/count.glsl"
#include "hit/hit.glsl"
#include "hit/sequence.glsl"
#include "hit/surface.glsl"
#include "hit/trace.glsl"

// The pair of dimensions of the sequence.
const uint kPairOcclusion = 2u;

// The rays are cosine-weighted about the shading normal, so that each counts the same. With `rays` of them the mean is
// 1 - 1/π ∫ w(t) cos θ dω. w(t) is 1 up to the radius, or falls to 0 there with the distance t of the hit. Zhukov,
// Iones and Kronin, "An Ambient Light Illumination Model" (1998).
void applyAmbientOcclusion(Hit hit, Surface surface, Features features, inout SkyShares sky) {
    float open = 0.0;
    uint rays = 0u;
    uint misses = 0u;
    float radius = GLINT_FRAME.occlusionRadius;
    for (uint i = 0u; i < GLINT_FRAME.occlusionSamples; ++i) {
        uint number = GLINT_FRAME.sampleIndex * GLINT_FRAME.occlusionSamples + i;
        vec3 local = sampleCosine(sequencePair(hit.target, number, GLINT_FRAME.seed, kPairOcclusion));
        vec3 direction = onSide(toWorld(surface, local), hit.geometricNormal);
        vec3 origin = rayOrigin(hit, direction);
        rays += 1u;
        if (GLINT_FRAME.occlusionFalloff != 0u) {
            float share = min(closestDistance(origin, direction, radius) / radius, 1.0);
            open += share;
            misses += share < 1.0 ? 0u : 1u;
        } else if (isVisible(origin, direction, radius)) {
            open += 1.0;
            misses += 1u;
        }
    }
    sky.open *= open / float(GLINT_FRAME.occlusionSamples);
    countRays(kEffectAmbientOcclusion, rays, misses);
}
