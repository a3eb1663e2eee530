// Stands in for passes/primary_surface.glsl where its function is compiled by itself. The body here is replaced when the
// parts are joined.
#include "hit/material.glsl"

Surface surfaceOfPrimary(Hit hit, uint lobes, uint inputs) {
    Surface surface;
    return surface;
}
