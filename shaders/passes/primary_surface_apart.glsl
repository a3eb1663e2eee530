// Stands in for passes/primary_surface.glsl where its functions are compiled by themselves. The bodies here are replaced
// when the parts are joined.
#include "hit/material.glsl"

Surface surfaceOfPrimary(Hit hit, uint lobes, uint inputs) {
    Surface surface;
    return surface;
}

vec3 colorOfPrimary(Hit hit, uint lobes, uint inputs) {
    return vec3(0.0);
}
