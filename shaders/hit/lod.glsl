// The footprint of a ray cone on a surface, and the texture gradients that it calls for.
#include "hit/geometry.glsl"

// A cone of width coneWidth meets a plane in an ellipse: coneWidth across the ray, coneWidth / cosine along it. These
// are its axes in the world, each as long as the whole ellipse: Akenine-Möller et al., "Improved Shader and Texture
// Level of Detail Using Ray Cones" (JCGT 2021, with the erratum for page 16), on anisotropic lookups. n: the plane's
// normal, unit; direction: the ray's, unit.
void coneAxes(float coneWidth, vec3 direction, vec3 n, out vec3 across, out vec3 along) {
    vec3 tangent;
    vec3 bitangent;
    buildBasis(n, tangent, bitangent);
    // The ray's direction within the plane. Near the normal rounding turns it, but there the ellipse is a circle.
    vec2 slant = vec2(dot(direction, tangent), dot(direction, bitangent));
    float sine = length(slant);
    slant = sine > 0.0 ? slant / sine : vec2(1.0, 0.0);
    across = coneWidth * (slant.x * bitangent - slant.y * tangent);
    // Below 0.01 radians the ellipse is cut.
    along = coneWidth / max(abs(dot(direction, n)), 0.01) * (slant.x * tangent + slant.y * bitangent);
}

// A vector of a triangle's plane in units of its edges. No number where the triangle has no area.
vec2 inEdges(vec3 v, vec3 edge0, vec3 edge1) {
    vec3 normal = cross(edge0, edge1);
    // Scaled, as the square of a small triangle's area is no float.
    float largest = max(max(abs(normal.x), abs(normal.y)), abs(normal.z));
    vec3 scaled = normal / largest;
    return vec2(dot(cross(v, edge1 / largest), scaled), dot(cross(edge0 / largest, v), scaled)) / dot(scaled, scaled);
}

// Gradients for textureGrad(): (du, dv) by one axis of the footprint, then by the other. footprint: both axes by
// inEdges(); uvEdges: (Δu, Δv) along each edge; texels: size of mip 0.
// A sampler covers what is up to `anisotropy` times as long as wide. The level of a longer footprint it would choose by
// the length, too blurred: that is shrunk to the level of an ellipse of the same area that the sampler does cover.
// Without anisotropy it is the geometric mean of the axes, which keeps floors sharper than the long axis would and
// quieter than the short one.
// 0, for the finest level, where triangle or texture has no area, or the footprint is endless.
vec4 coneGradients(vec4 footprint, vec4 uvEdges, vec2 texels, float anisotropy) {
    vec4 gradients = vec4(footprint.x * uvEdges.xy + footprint.y * uvEdges.zw,
                          footprint.z * uvEdges.xy + footprint.w * uvEdges.zw);
    vec4 inTexels = gradients * vec4(texels, texels);
    float longest2 = max(dot(inTexels.xy, inTexels.xy), dot(inTexels.zw, inTexels.zw));
    // By the determinants of both maps, as the footprint itself may be too long to tell its area.
    float area = abs((footprint.x * footprint.w - footprint.y * footprint.z) *
                     (uvEdges.x * uvEdges.w - uvEdges.y * uvEdges.z)) *
                 texels.x * texels.y;
    float scale = sqrt(min(anisotropy * area / longest2, 1.0));
    vec4 scaled = gradients * scale;
    // Infinite, or no number, where one of its parts is. 1e9 is more than any texture repeats under a footprint.
    float size = dot(abs(scaled), vec4(1.0));
    return size < 1e9 ? scaled : vec4(0.0);
}
