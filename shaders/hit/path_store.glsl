// Keeps the next ray of a path, for the pass that puts it on the list.
#include "hit/hit.glsl"

void storePath(Hit hit, PathStep step) {
    if (step.direction == vec3(0.0)) {
        endPath(hit.target);
        return;
    }
    GLINT_FRAME.paths.data[hit.target] =
        PathState(rayOrigin(hit, step.direction), step.medium, step.direction, step.density, step.throughput,
                  hit.arrival.coneWidth, step.coneSpread, 1u);
}
