#version 460
// A part of the lighting pass: the surfaces of primary hits. main() only calls the function that is compiled for that
// pass.
#define GLINT_MODULE_ALWAYS_LOBES GLINT_ALWAYS_LOBES
#define GLINT_MODULE_ALWAYS_INPUTS GLINT_ALWAYS_INPUTS
#define GLINT_MODULE_ANY_LOBES (GLINT_ALWAYS_LOBES | GLINT_SOMETIMES_LOBES)
#define GLINT_MODULE_ANY_INPUTS (GLINT_ALWAYS_INPUTS | GLINT_SOMETIMES_INPUTS)
#include "hit/hit.glsl"
#include "passes/primary_surface.glsl"

layout(local_size_x = 1) in;

void main() {
    Hit hit;
    surfaceOfPrimary(hit, 0u, 0u);
}
