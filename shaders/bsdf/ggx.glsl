// The GGX microfacet lobe. Vectors are unit vectors in the frame of the surface, where z is the normal. There |n×h|² is
// h.x² + h.y². It keeps its digits where h is near n, which is where a smooth lobe has its energy; 1 - (n·h)² would
// lose all of them. alpha has values along x and y, at least kMinAlpha.
#include "bsdf/constants.glsl"
#include "bsdf/exact.glsl"

// The Trowbridge-Reitz NDF: glTF 2.0, appendix B.3.2; with two alphas as in KHR_materials_anisotropy.
float ggxDistribution(vec3 h, vec2 alpha) {
    vec2 slope = vec2(h.x / alpha.x, h.y / alpha.y);
    float t = dot(slope, slope) + h.z * h.z;
    return h.z > 0.0 ? 1.0 / (kPi * alpha.x * alpha.y * t * t) : 0.0;
}

// |(alpha.x v.x, alpha.y v.y, v.z)|: the projected area of the ellipsoid whose normals are the microfacets.
float ggxProjection(vec3 v, vec2 alpha) {
    vec3 stretched = vec3(alpha.x * v.x, alpha.y * v.y, v.z);
    return sqrt(dot(stretched, stretched));
}

// Height-correlated Smith visibility, G / (4 (n·l) (n·v)): Heitz 2014; KHR_materials_anisotropy. The sample of glTF 2.0,
// appendix B.3.2, has the separable product of two Smith terms, and B.3.6 calls this form the more accurate one. It uses
// cosines without their sign, so it serves transmission too. As alpha > 0, the sum is 0 only if both cosines are 0.
float ggxVisibility(vec3 l, vec3 v, vec2 alpha) {
    return 0.5 / (abs(l.z) * ggxProjection(v, alpha) + abs(v.z) * ggxProjection(l, alpha));
}

// Samples a normal that is visible from `v`, v.z > 0: Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical
// Caps" (2023).
vec3 sampleVisibleNormal(vec3 v, vec2 alpha, vec2 u) {
    vec3 stretched = normalize(vec3(alpha.x * v.x, alpha.y * v.y, v.z));
    // A point of the sphere above -stretched.z, given by its distance from the pole. 1 - z and the sum with stretched.z
    // are products, because differences would lose the digits of normals near the pole and on the edge.
    float fromPole = u.y * (1.0 + stretched.z);
    float above = (1.0 - u.y) * (1.0 + stretched.z);
    float fromEdge = above + dot(stretched.xy, stretched.xy) / (1.0 + stretched.z);
    float sine = sqrt(fromPole * fromEdge);
    float phi = 2.0 * kPi * u.x;
    vec3 h = vec3(sine * cos(phi) + stretched.x, sine * sin(phi) + stretched.y, above);
    return normalize(vec3(alpha.x * h.x, alpha.y * h.y, h.z));
}

// The density of sampleVisibleNormal(), G₁(v) D(h) (v·h) / (n·v). G₁ / (n·v) is computed as one factor, which is finite
// at grazing.
float visibleNormalPdf(vec3 v, vec3 h, vec2 alpha) {
    return 2.0 * ggxDistribution(h, alpha) * max(accurateDot(v, h), 0.0) / (v.z + ggxProjection(v, alpha));
}

// The density of the mirror direction of a visible facet: visibleNormalPdf() / (4 v·h), with the cosine cancelled.
float mirroredPdf(vec3 v, vec3 h, vec2 alpha) {
    return 0.5 * ggxDistribution(h, alpha) / (v.z + ggxProjection(v, alpha));
}
