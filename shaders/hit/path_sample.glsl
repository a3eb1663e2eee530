// Chooses the next ray of a path at a lit surface.
#include "bsdf/sample.glsl"
#include "hit/hit.glsl"
#include "light/receiver.glsl"
#include "hit/samples.glsl"
#include "hit/surface.glsl"
#include "hit/surface_values.glsl"
#include "host/material.glsl"
#include "host/random.glsl"
#include "host/sky.glsl"
#include "materials/base/medium.glsl"

// The pairs of dimensions of the sequence: a direction; a lobe, and whether the path survives.
const uint kPairPathDirection = 6u;
const uint kPairPathLobe = 7u;

// The largest growth of a cone in a metre at a bounce: see kIndirectSpread of the effect indirect diffuse.
const float kMostPathSpread = 0.125;

// The share of the light at a hit that arrives at the primary surface. The walk of a refracted ray counts the
// absorption of its own last part.
vec3 arrivingShare(PathArrival arrival, vec3 position) {
    vec3 share = arrival.throughput;
    if (isWithin(arrival.media) && GLINT_FRAME.bounce > 1u) {
        share *= mediumTransmittance(arrival.media, distance(position, arrival.start));
    }
    return share;
}

// The volumes of a ray from the hit.
Media mediaOfStep(Hit hit, Features features, bool passes) {
    return passes && boundsMedium(features) ? mediaBeyond(hit, hit.arrival.media) : hit.arrival.media;
}

#if GLINT_SHADOW_GLASS
// Returns whether the surface that sent the ray has sampled the light that arrives through the hit. Then the ray keeps
// its share.
bool seesSkyFromBefore(Hit hit, Features features, bool passes) {
    return isWithinGlass(hit, features) || (passes && passesFacets(features));
}
#endif

// Samples a direction of all lobes by one-sample multiple importance sampling: one lobe is chosen by its share of the
// light, and the weight is the whole BSDF over the density of the mixture (Veach 1997).
BsdfSample drawDirection(Hit hit, Surface surface, Features features) {
    vec2 u = hostRandomPair(hit.target, dimensionOfBounce(kPairPathDirection));
    vec2 choice = hostRandomPair(hit.target, dimensionOfBounce(kPairPathLobe));
    return sampleBsdf(surface.bsdf, features, vec3(u, choice.x));
}

// The step in the direction of drawDirection(). `arriving` is the throughput at the hit.
PathStep nextStep(Hit hit, Surface surface, Features features, BsdfSample drawn, vec3 arriving) {
    vec2 choice = hostRandomPair(hit.target, dimensionOfBounce(kPairPathLobe));
    PathStep step = endOfPath();
    step.throughput = arriving * drawn.weight;
    float largestShare = max(step.throughput.x, max(step.throughput.y, step.throughput.z));
    // A throughput that is not a number compares false.
    if (drawn.pdf <= 0.0 || !(largestShare > 0.0) || !survives(choice.y, step.throughput)) {
        return step;
    }
    // Only transmission sends light to the far side. A layer whose own normal is turned may choose a direction there:
    // its light is reflected at the triangle, like all light below a surface.
    bool passes = drawn.direction.z < 0.0 && transmits(features);
    step.direction = onSide(toWorld(surface, drawn.direction), passes ? -hit.geometricNormal : hit.geometricNormal);
#if GLINT_SAMPLE_RECORD_PACKED
    step.direction = keptDirection(step.direction);
#endif
    step.density = drawn.pdf;
    // A sample stands for a solid angle of 1 / density. Its cone fills it, up to the width that keeps textures sharp
    // enough for the mean of many samples.
    step.coneSpread = max(hit.arrival.coneSpread, min(kMostPathSpread, inversesqrt(drawn.pdf)));
    step.media = mediaOfStep(hit, features, passes);
#if GLINT_EMISSIVE_LIGHTS
    step.receiver = receiverNormal(hit, features);
#if GLINT_SHADOW_GLASS
    if (seesSkyFromBefore(hit, features, passes)) {
        // A ray brings all light behind the glass if no sample could have taken its place.
        float before = GLINT_FRAME.lobeRays.data[samplePlace(hit.target)].density;
#if GLINT_STEPS
        before = GLINT_FRAME.bounce <= 1u ? 0.0 : before;  // A host's rays are of no lobe.
#endif
        step.density = before > 0.0 ? -1.0 : before;
    }
#endif
#endif
#if GLINT_SKY_LIGHT
    step.skyShare = drawn.pdf / (drawn.pdf + hostSkyDensity(step.direction));
#if GLINT_SHADOW_GLASS
    if (seesSkyFromBefore(hit, features, passes)) {
        step.skyShare = storedSkyShare(hit.target);
    }
#endif
#endif
    return step;
}

// The ray goes straight on through a surface that does not affect it. Such a back stops samples of emissive triangles
// within a volume (kShadowOfSharedWithin), so a density of 0 lets the ray bring all of their light.
PathStep straightStep(Hit hit, vec3 arriving) {
    PathStep step = endOfPath();
    step.direction = -hit.view;
    step.throughput = arriving;
    step.coneSpread = hit.arrival.coneSpread;
    step.media = hit.arrival.media;
#if GLINT_SKY_LIGHT
    step.skyShare = storedSkyShare(hit.target);
#endif
    return step;
}

// Keeps the next ray, for the pass that puts it on the list.
void storePath(Hit hit, PathStep step) {
    uint place = samplePlace(hit.target);
    if (step.direction == vec3(0.0)) {
        endPath(place);
        return;
    }
#if GLINT_SAMPLE_RECORD_PACKED
    EffectSample next = EffectSample(rayOrigin(hit, step.direction), kRaySent, step.direction, hit.arrival.coneWidth,
                                     vec3(0.0), step.coneSpread);
    putRay(place, next);  // The weight stays that of the primary surface.
#else
    GLINT_FRAME.sampleStarts.data[place] = SampleStart(rayOrigin(hit, step.direction), kRaySent);
    GLINT_FRAME.sampleAims.data[place] = SampleAim(step.direction, hit.arrival.coneWidth);
    GLINT_FRAME.sampleWeights.data[place].coneSpread = step.coneSpread;
#endif
    GLINT_FRAME.paths.data[place] = PathState(step.throughput, uint[2](step.media.x, step.media.y));
#if GLINT_EMISSIVE_LIGHTS
    storeLobeRay(hit.target, step.density, step.receiver);
#endif
#if GLINT_SKY_LIGHT
    storeSkyShare(hit.target, step.skyShare);
#endif
}
