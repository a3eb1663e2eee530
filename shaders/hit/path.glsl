// Paths of several bounces: the data of a hit about the ray that found it, and the next ray of the path. The state of
// each sample's path lies in memory from one bounce to the next.
#include "hit/bindings.glsl"

// The data of a hit about its path.
struct PathArrival {
    vec3 start;         // of the ray that found the hit
    vec3 throughput;    // at the start of that ray
    uvec2 media;        // as in PathState
    float coneWidth;    // at the hit, metres
    float coneSpread;
};

// The next ray of a path.
struct PathStep {
    vec3 direction;     // unit vector; 0 if the path ends
    vec3 throughput;
    float density;
    float coneSpread;
    uvec2 media;
#if GLINT_EMISSIVE_LIGHTS
    uint receiver;      // LobeRay::normal
#endif
#if GLINT_SKY_LIGHT
    float skyShare;     // of the sky's light, that the ray brings if it leaves the scene
#endif
};

PathStep endOfPath() {
    PathStep step;
    step.direction = vec3(0.0);
    step.throughput = vec3(0.0);
    step.density = 0.0;
    step.coneSpread = 0.0;
    step.media = uvec2(0u);
#if GLINT_EMISSIVE_LIGHTS
    step.receiver = 0u;
#endif
#if GLINT_SKY_LIGHT
    step.skyShare = 1.0;
#endif
    return step;
}

// Returns whether hits of this bounce send further rays. Primary surfaces send those of the effects instead.
bool pathGoesOn() {
    return GLINT_FRAME.bounce > 0u && GLINT_FRAME.bounce < GLINT_FRAME.lastBounce;
}

// Each bounce has dimensions of its own for its random numbers; the first one has those that are named.
const uint kDimensionsOfBounce = 0x1000000u;

uint dimensionOfBounce(uint dimension) {
    return dimension + kDimensionsOfBounce * (max(GLINT_FRAME.bounce, 1u) - 1u);
}

// The path of a sample before its first hit.
PathState newPath() {
    return PathState(vec3(1.0), uint[2](0u, 0u));
}

void beginPath(uint place) {
    GLINT_FRAME.paths.data[place] = newPath();
}

// The path that has led to the hits that are being shaded. `place` is that of the sample (samplePlace()). A host's
// rays begin their paths.
PathState pathSoFar(uint place) {
#if GLINT_STEPS
    if (GLINT_FRAME.bounce <= 1u) {
        return newPath();
    }
#endif
    return GLINT_FRAME.paths.data[place];
}

PathArrival arrivalOf(uint place, vec3 start, float coneWidth, float coneSpread) {
    PathState path = pathSoFar(place);
    return PathArrival(start, path.throughput, uvec2(path.media[0], path.media[1]), coneWidth, coneSpread);
}

void endPath(uint place) {
    if (pathGoesOn()) {
#if GLINT_SAMPLE_RECORD_PACKED
        uint state = GLINT_FRAME.sampleStarts.data[place].state;
        GLINT_FRAME.sampleStarts.data[place].state = (state & ~kPackedOutcomeMask) | kRayEnded;
#else
        GLINT_FRAME.sampleStarts.data[place].state = kRayEnded;
#endif
    }
}

// From this bounce on paths end at random, in proportion to the light that they still carry (Russian roulette): a path
// goes on with the probability of its throughput's largest component, but at least kLeastSurvival, and is then divided
// by that probability.
const uint kRouletteBounce = 3u;
const float kLeastSurvival = 0.05;

// `random` is uniform in [0, 1). Returns whether the path goes on.
bool survives(float random, inout vec3 throughput) {
    if (GLINT_FRAME.bounce < kRouletteBounce) {
        return true;
    }
    float chance = clamp(max(throughput.x, max(throughput.y, throughput.z)), kLeastSurvival, 1.0);
    throughput /= chance;
    return random < chance;
}
