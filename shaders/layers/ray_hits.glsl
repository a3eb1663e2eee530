// The hit of the first ray of a sample, for layers. A walk, or a march over the screen, stores the length of its way
// before the ray that the list traces.
#include "hit/bindings.glsl"
#include "hit/samples.glsl"

// Returns whether the list's hits are those of first rays.
bool findsFirstHits() {
    return GLINT_FRAME.bounce <= 1u;
}

// The length of the ray of the bounce at hand. The last bounce that has layers keeps its own.
void storeBounceDistance(uint place, float last) {
#if GLINT_LAYER_BOUNCES
    uint bounce = max(GLINT_FRAME.bounce, 1u);
    if (bounce <= kLayerBounces) {
        GLINT_FRAME.bounceLight.data[place * kLayerBounces + (bounce - 1u)].distance = last;
    }
#endif
}

// `last` is the length of the list's ray.
void storeRayHit(uint target, uint geometry, uint primitive, vec2 barycentrics, vec3 direction, float last) {
    uint place = samplePlace(target);
    storeBounceDistance(place, last);
    if (findsFirstHits()) {
        float before = GLINT_FRAME.rayHits.data[place].distance;
        GLINT_FRAME.rayHits.data[place] = RayHit(geometry, primitive, barycentrics, direction, before + last);
    }
}

// Stores that the ray left the scene.
void storeRayMiss(uint target, vec3 direction) {
    uint place = samplePlace(target);
    storeBounceDistance(place, float(kDistanceOfMiss));
    if (findsFirstHits()) {
        GLINT_FRAME.rayHits.data[place] =
            RayHit(kMissGeometry, 0u, vec2(0.0), direction, float(kDistanceOfMiss));
    }
}
