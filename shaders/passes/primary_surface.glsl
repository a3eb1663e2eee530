// Returns the material's values of the surface of a primary hit. This function knows every feature of the scene, and is
// compiled by itself (passes/primary_surface.comp), so that an edit of a material's GLSL leaves the rest of the
// lighting pass as it is: there passes/primary_surface_apart.glsl stands in for this file. `lobes` and `inputs` are the
// key of the geometry.
#include "hit/material.glsl"

Features featuresOfPrimary(uint lobes, uint inputs) {
    return Features(GLINT_ALWAYS_LOBES, GLINT_ALWAYS_INPUTS, GLINT_SOMETIMES_LOBES, GLINT_SOMETIMES_INPUTS, lobes,
                    inputs);
}

Surface surfaceOfPrimary(Hit hit, uint lobes, uint inputs) {
    return evaluateAny(hit, featuresOfPrimary(lobes, inputs));
}
