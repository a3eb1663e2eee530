// The interface of a layer over the base. A feature with the stage "layer" has a struct of its own name, here Coat, and
// these functions, which take the prepared view and directions in the frame of the base:
//
//   void coatPrepare(inout Coat layer, vec3 view)             what depends on the view alone
//   LayerAlbedo coatShares(Coat layer, vec3 view)             what it does with a uniform white sky
//   LayerLight coatEvaluate(Coat layer, vec3 view, vec3 l)    what it does with the light from l
//   vec3 coatSample(Coat layer, vec3 view, vec2 u)            a unit vector, or 0; u is uniform in [0, 1)²
//   float coatDensity(Coat layer, vec3 view, vec3 l)          the density of coatSample() by solid angle
//   LayerMirror coatMirror(Coat layer)                        only of a layer whose reflection rays may trace
#include "generated/scene.glsl"
#include "bsdf/constants.glsl"
#include "bsdf/exact.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/basis.glsl"

struct LayerAlbedo {
    GLINT_RELAXED vec3 reflected;  // share that the layer reflects itself
    GLINT_RELAXED float passed;    // share of the light of what lies below that comes out
};

struct LayerLight {
    vec3 reflected;              // BSDF of the layer times the cosine to its own normal
    GLINT_RELAXED float passed;  // share of the light that what lies below scatters between the two directions
    float side;                  // cosine between the light and the layer's normal
};

// The lobe about a normal, as rays trace it.
struct LayerMirror {
    vec3 normal;      // unit
    float roughness;  // sqrt(alpha)
};

// Samples a cosine-weighted direction about z: Malley's method.
vec3 sampleCosine(vec2 u) {
    float radius = sqrt(u.x);
    float phi = 2.0 * kPi * u.y;
    return vec3(radius * cos(phi), radius * sin(phi), sqrt(max(1.0 - u.x, 0.0)));
}

// The density of sampleCosine().
float cosineDensity(vec3 l) {
    return max(l.z, 0.0) * kInversePi;
}

// Returns the mirror image of v about a facet's normal.
vec3 reflectAbout(vec3 v, vec3 h) {
    return 2.0 * dot(v, h) * h - v;
}
