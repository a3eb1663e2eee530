// What the first ray of a sample found, for layers. A walk, or a march over the screen, stores how far it came before
// the ray that the list traces.
#include "hit/bindings.glsl"
#include "hit/samples.glsl"

// Whether the hits at hand are those of first rays.
bool findsFirstHits() {
    return GLINT_FRAME.bounce <= 1u;
}

// `last` is the length of the list's ray.
void storeRayHit(uint target, uint geometry, uint primitive, vec2 barycentrics, vec3 direction, float last) {
    uint place = samplePlace(target);
    float before = GLINT_FRAME.rayHits.data[place].distance;
    GLINT_FRAME.rayHits.data[place] = RayHit(geometry, primitive, barycentrics, direction, before + last);
}

// The ray left the scene.
void storeRayMiss(uint target, vec3 direction) {
    GLINT_FRAME.rayHits.data[samplePlace(target)] =
        RayHit(kMissGeometry, 0u, vec2(0.0), direction, float(kDistanceOfMiss));
}
