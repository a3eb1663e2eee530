// What the material of a primary hit says about the surface. These functions know every feature of the scene, and are
// compiled by themselves, so that an edit of a material's GLSL leaves the rest of the lighting pass as it is. `lobes`
// and `inputs` are the key of the geometry.
#include "hit/material.glsl"

#ifdef GLINT_SURFACE_APART

// The bodies are in passes/primary_surface.comp.
Surface surfaceOfPrimary(Hit hit, uint lobes, uint inputs) {
    Surface surface;
    return surface;
}

vec3 colorOfPrimary(Hit hit, uint lobes, uint inputs) {
    return vec3(0.0);
}

#else

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

#endif
