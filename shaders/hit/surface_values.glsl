// The material's values of a surface: the stage "surface" of the features sets them, before a BSDF is made of them.
#include "hit/surface.glsl"
#include "hit/texture.glsl"

struct SurfaceValues {
    GLINT_RELAXED vec4 color;       // of the base, with the coverage
    GLINT_RELAXED float metallic;
    float roughness;                // square root of alpha; 32 bits, as it is compared with limits
    GLINT_RELAXED vec3 f0;          // reflectance of the dielectric at normal incidence
    GLINT_RELAXED float f90;        // and at grazing angles
    vec3 normal;                    // unit, in the world, on the side that the surface's front faces
    GLINT_RELAXED float occlusion;  // of ambient light
    GLINT_RELAXED float dielectric; // share of the light below the microfacets that no feature has taken yet
};

// Returns whether a hit may show the back of the surface: rays within a volume meet its surface from there.
bool showsBack(Features features) {
#if GLINT_PATHS
    return hasInput(features, GLINT_ROLE_DOUBLE_SIDED) || boundsMedium(features);
#else
    return hasInput(features, GLINT_ROLE_DOUBLE_SIDED);
#endif
}

// Returns whether the hit is on the inside of glass. Where shadow rays pass glass, those of the surface that sent the
// ray have passed this glass on the straight line, with all that happens within the glass.
bool isWithinGlass(Hit hit, Features features) {
    return passesFacets(features) && boundsMedium(features) && showsBack(features) &&
           !hit.frontFace;
}

// The normals of double-sided materials turn to the viewer.
float facing(Hit hit, Features features) {
    return showsBack(features) && !hit.frontFace ? -1.0 : 1.0;
}
