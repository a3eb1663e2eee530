// What the material of a primary hit says about the surface. These functions know every feature of the scene, and are
// compiled by themselves (passes/primary_surface.comp), so that an edit of a material's GLSL leaves the rest of the
// lighting pass as it is: there passes/primary_surface_apart.glsl stands in for this file. `lobes` and `inputs` are the
// key of the geometry.
#include "hit/material.glsl"

Features featuresOfPrimary(uint lobes, uint inputs) {
    return Features(GLINT_ALWAYS_LOBES, GLINT_ALWAYS_INPUTS, GLINT_SOMETIMES_LOBES, GLINT_SOMETIMES_INPUTS, lobes,
                    inputs);
}

// Requires a lit key.
Surface surfaceOfPrimary(Hit hit, uint lobes, uint inputs) {
    return evaluateSurface(hit, featuresOfPrimary(lobes, inputs));
}

// Requires an unlit key.
vec3 colorOfPrimary(Hit hit, uint lobes, uint inputs) {
    Features features = featuresOfPrimary(lobes, inputs);
    return hasLobe(features, GLINT_UNLIT) ? surfaceValues(hit, features).color.rgb : vec3(0.0);
}
