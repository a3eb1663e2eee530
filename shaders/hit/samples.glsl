// The samples of effects in memory: the rays of primary surfaces, and the light that comes back.
#include "hit/bindings.glsl"
#include "packed/hit_codes.glsl"
#if GLINT_PATHS
#include "hit/path.glsl"
#endif
#if GLINT_TALLIES
#include "generated/tallies.glsl"
#endif

// 1 if light has an array of its own, because the rest of a sample is still needed, or because it is a host's.
#if GLINT_PATHS || GLINT_STEPS
#define GLINT_RADIANCE_APART 1
#else
#define GLINT_RADIANCE_APART 0
#endif

// A ray that a primary surface sends for an effect, and the weight of the light that it finds.
struct EffectSample {
    vec3 origin;
    uint outcome;      // kRaySent, or why there is no ray
    vec3 direction;    // unit vector
    float coneWidth;   // width of the ray cone at the origin, metres
    vec3 weight;       // factor of the radiance that the ray finds
    float coneSpread;  // growth of the width in a metre
};

#if GLINT_SAMPLE_RECORD_PACKED
#include "packed/sample.glsl"
#endif

uint pixelCount() {
    return GLINT_FRAME.width * GLINT_FRAME.height;
}

// Returns the number of a pixel's sample.
uint sampleTarget(uint slot, uint pixel) {
    return slot * pixelCount() + pixel;
}

// Returns where the records of a sample are.
uint samplePlace(uint target) {
#if GLINT_STEPS
    return target;
#elif GLINT_RAY_EFFECTS == 1
    return target - GLINT_FRAME.bandFirst;
#else
    return target - GLINT_FRAME.bandFirst - target / pixelCount() * GLINT_FRAME.outsideBands;
#endif
}

EffectSample noSample(uint outcome) {
    return EffectSample(vec3(0.0), outcome, vec3(0.0), 0.0, vec3(0.0), 0.0);
}

// Stores the start of a sample's ray anew, and the width of its cone there.
void storeSampleRay(uint place, EffectSample drawn) {
#if GLINT_SAMPLE_RECORD_PACKED
    putStart(place, drawn, encodeDirection(drawn.direction));
#else
    GLINT_FRAME.sampleStarts.data[place] = SampleStart(drawn.origin, drawn.outcome);
    GLINT_FRAME.sampleAims.data[place] = SampleAim(drawn.direction, drawn.coneWidth);
#endif
}

#if GLINT_LAYER_BOUNCES
const uint kLayerBounces = GLINT_LAYER_BOUNCES;

// Adds light to that of the bounce at hand.
void addToBounce(uint place, vec3 light) {
    uint bounce = clamp(GLINT_FRAME.bounce, 1u, kLayerBounces) - 1u;
    GLINT_FRAME.bounceLight.data[place * kLayerBounces + bounce].light += light;
}

void clearBounces(uint place) {
    for (uint i = 0u; i < kLayerBounces; ++i) {
        GLINT_FRAME.bounceLight.data[place * kLayerBounces + i] = BounceLight(vec3(0.0), 0.0);
    }
}
#endif

void storeSample(uint target, EffectSample drawn) {
    uint place = samplePlace(target);
#if GLINT_SAMPLE_RECORD_PACKED
    putSample(place, drawn, GLINT_FRAME.screenSteps != 0u);
#else
    GLINT_FRAME.sampleStarts.data[place] = SampleStart(drawn.origin, drawn.outcome);
#endif
    if (drawn.outcome == kRaySent) {
#if !GLINT_SAMPLE_RECORD_PACKED
        GLINT_FRAME.sampleAims.data[place] = SampleAim(drawn.direction, drawn.coneWidth);
#endif
#if GLINT_LAYER_RAYS
        GLINT_FRAME.rayHits.data[place].distance = 0.0;
#endif
#if GLINT_LAYER_BOUNCES
        clearBounces(place);
#endif
#if GLINT_PATHS
        beginPath(place);
#endif
    }
#if !GLINT_SAMPLE_RECORD_PACKED
    // The march in screen space reads the weights of other pixels, whether they sent a ray or not.
    if (drawn.outcome == kRaySent || GLINT_FRAME.screenSteps != 0u) {
        GLINT_FRAME.sampleWeights.data[place] = SampleWeight(drawn.weight, drawn.coneSpread);
    }
#endif
}

// Returns whether a sample sends a ray, or why not. It must be called before light is stored.
uint sampleOutcome(uint target) {
#if GLINT_SAMPLE_RECORD_PACKED
    return packedOutcome(samplePlace(target));
#else
    return GLINT_FRAME.sampleStarts.data[samplePlace(target)].state & kOutcomeMask;
#endif
}

// Returns a sample that sends a ray. It must be called before light is stored.
EffectSample storedSample(uint target) {
    uint place = samplePlace(target);
#if GLINT_SAMPLE_RECORD_PACKED
    return packedSample(place);
#else
    SampleStart start = GLINT_FRAME.sampleStarts.data[place];
    SampleAim aim = GLINT_FRAME.sampleAims.data[place];
    SampleWeight weight = GLINT_FRAME.sampleWeights.data[place];
    return EffectSample(start.origin_orRadiance, start.state & kOutcomeMask, aim.direction, aim.coneWidth,
                        weight.weight, weight.coneSpread);
#endif
}

vec3 sampleWeight(uint target) {
#if GLINT_SAMPLE_RECORD_PACKED
    return packedWeight(samplePlace(target));
#else
    return GLINT_FRAME.sampleWeights.data[samplePlace(target)].weight;
#endif
}

// Returns a ray of the list.
RayRecord listedRay(uint index) {
#if GLINT_STEPS
    if (isHostsList()) {
        return GLINT_FRAME.rays.data[index];
    }
#endif
    uint target = GLINT_FRAME.listed.data[index];
    uint place = samplePlace(target);
#if GLINT_TALLIES
    tallyForSample(target);
#endif
#if GLINT_SAMPLE_RECORD_PACKED
    return packedRay(place, target);
#else
    SampleAim aim = GLINT_FRAME.sampleAims.data[place];
    return RayRecord(GLINT_FRAME.sampleStarts.data[place].origin_orRadiance, target, aim.direction, aim.coneWidth,
                     GLINT_FRAME.sampleWeights.data[place].coneSpread);
#endif
}

// Returns the direction of a sample that sends a ray. It must be called before light is stored.
vec3 sampleDirection(uint target) {
    uint place = samplePlace(target);
#if GLINT_SAMPLE_RECORD_PACKED
    return packedSample(place).direction;
#else
    return GLINT_FRAME.sampleAims.data[place].direction;
#endif
}

// Returns the number of the sample that a ray of the list belongs to.
uint listedTarget(uint index) {
#if GLINT_STEPS
    if (isHostsList()) {
        return GLINT_FRAME.rays.data[index].target;
    }
#endif
    return GLINT_FRAME.listed.data[index];
}

#if GLINT_HITS_IN_SAMPLES
// Returns a ray of the list whose hit is stored in the place of its start. Only the number of the sample and the
// direction are left.
RayRecord shadedRay(uint index) {
    uint target = GLINT_FRAME.listed.data[index];
    uint place = samplePlace(target);
#if GLINT_TALLIES
    tallyForSample(target);
#endif
    return RayRecord(vec3(0.0), target, directionOfHit(place), 0.0, 0.0);
}
#else
#define shadedRay listedRay
#endif

#if GLINT_EMISSIVE_LIGHTS
// Stores how the ray of a sample was chosen, for emissive lights that it finds.
void storeLobeRay(uint target, float density, uint normal) {
    GLINT_FRAME.lobeRays.data[samplePlace(target)] = LobeRay(density, normal);
}
#endif

#if GLINT_SKY_LIGHT
// The share of the sky's light that the ray of a sample brings if it leaves the scene. Samples of the sky bring the
// rest. A host's own rays bring all of it.
void storeSkyShare(uint target, float share) {
    GLINT_FRAME.skyShares.data[samplePlace(target)] = share;
}

float storedSkyShare(uint target) {
#if GLINT_STEPS
    if (isHostsList()) {
        return 1.0;
    }
#endif
    return GLINT_FRAME.skyShares.data[samplePlace(target)];
}
#endif

// path is one of kPath*. It is that of the first bounce; further bounces add their light.
void storeRadiance(uint target, vec3 radiance, uint path) {
    uint place = samplePlace(target);
#if GLINT_LAYER_BOUNCES
    addToBounce(place, radiance);
#endif
#if GLINT_PATHS
    if (GLINT_FRAME.bounce > 1u) {
        // A sample has one ray at a time, so no other thread writes here.
        GLINT_FRAME.radiance.data[place].rgb += radiance;
        return;
    }
#endif
#if GLINT_RADIANCE_APART
    GLINT_FRAME.radiance.data[place] = vec4(radiance, float(path));
#elif GLINT_SAMPLE_RECORD_PACKED
    putLight(place, radiance, kRaySent, path);
#else
    GLINT_FRAME.sampleStarts.data[place] = SampleStart(radiance, kRaySent | path << kPathShift);
#endif
}

// Ends a sample with a known radiance, so that no ray joins the list.
void endSample(uint target, vec3 weight, vec3 radiance) {
    uint place = samplePlace(target);
#if GLINT_SAMPLE_RECORD_PACKED
    putAim(place, weight, 0u);
#else
    GLINT_FRAME.sampleWeights.data[place].weight = weight;
#endif
#if GLINT_LAYER_BOUNCES
    addToBounce(place, radiance);
#endif
#if GLINT_RADIANCE_APART
#if GLINT_SAMPLE_RECORD_PACKED
    putOutcome(place, kRayEnded);
#else
    GLINT_FRAME.sampleStarts.data[place].state = kRayEnded;
#endif
    GLINT_FRAME.radiance.data[place] = vec4(radiance, float(kPathMiss));
#elif GLINT_SAMPLE_RECORD_PACKED
    putLight(place, radiance, kRayEnded, kPathMiss);
#else
    GLINT_FRAME.sampleStarts.data[place] = SampleStart(radiance, kRayEnded | kPathMiss << kPathShift);
#endif
}

// Adds the light of a deferred shadow ray to that of its sample. A sample has one ray, and its hit has one shadow ray,
// so no other thread writes there.
void addRadiance(uint target, vec3 light) {
    uint place = samplePlace(target);
#if GLINT_LAYER_BOUNCES
    addToBounce(place, light);
#endif
#if GLINT_RADIANCE_APART
    vec4 radiance = GLINT_FRAME.radiance.data[place];
    GLINT_FRAME.radiance.data[place] = vec4(radiance.rgb + light, radiance.w);
#else
    SampleStart stored = GLINT_FRAME.sampleStarts.data[place];
    GLINT_FRAME.sampleStarts.data[place] = SampleStart(stored.origin_orRadiance + light, stored.state);
#endif
}

// Returns the light of a sample, and in the last component how it was found (kPath*).
vec4 sampleRadiance(uint target) {
    uint place = samplePlace(target);
#if GLINT_RADIANCE_APART
#if GLINT_SAMPLE_RECORD_PACKED
    uint outcome = packedOutcome(place);
#else
    uint outcome = GLINT_FRAME.sampleStarts.data[place].state & kOutcomeMask;
#endif
    return outcome == kRaySent || outcome == kRayEnded ? GLINT_FRAME.radiance.data[place]
                                                       : vec4(0.0, 0.0, 0.0, float(kPathNone));
#else
    SampleStart stored = GLINT_FRAME.sampleStarts.data[place];
#if GLINT_SAMPLE_RECORD_PACKED
    uint path = stored.state >> kPackedPathShift & kPackedPathMask;
#else
    uint path = stored.state >> kPathShift;
#endif
    return path != kPathNone ? vec4(stored.origin_orRadiance, float(path)) : vec4(0.0, 0.0, 0.0, float(kPathNone));
#endif
}
