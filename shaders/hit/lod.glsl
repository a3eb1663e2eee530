// The footprint of a ray cone on a surface, and the texture gradients that follow from it.
#include "hit/geometry.glsl"

// A cone of width coneWidth meets a plane in an ellipse: coneWidth across the ray, coneWidth / cosine along it. The
// results are its axes in the world, each as long as the whole ellipse: Akenine-Möller et al., "Improved Shader and
// Texture Level of Detail Using Ray Cones" (JCGT 2021, with the erratum for page 16), on anisotropic lookups. n is the
// plane's normal and direction the ray's, both unit vectors.
void coneAxes(float coneWidth, vec3 direction, vec3 n, out vec3 across, out vec3 along) {
    vec3 tangent;
    vec3 bitangent;
    buildBasis(n, tangent, bitangent);
    // The ray's direction within the plane. Rounding turns it near the normal, but there the ellipse is a circle.
    vec2 slant = vec2(dot(direction, tangent), dot(direction, bitangent));
    float sine = length(slant);
    slant = sine > 0.0 ? slant / sine : vec2(1.0, 0.0);
    across = coneWidth * (slant.x * bitangent - slant.y * tangent);
    // The ellipse is limited below 0.01 radians.
    along = coneWidth / max(abs(dot(direction, n)), 0.01) * (slant.x * tangent + slant.y * bitangent);
}

// Returns a vector of a triangle's plane in units of its edges. The result is not a number if the triangle has no area.
vec2 inEdges(vec3 v, vec3 edge0, vec3 edge1) {
    vec3 normal = cross(edge0, edge1);
    // The normal is scaled, because the square of a small triangle's area underflows a float.
    float largest = max(max(abs(normal.x), abs(normal.y)), abs(normal.z));
    vec3 scaled = normal / largest;
    return vec2(dot(cross(v, edge1 / largest), scaled), dot(cross(edge0 / largest, v), scaled)) / dot(scaled, scaled);
}

// Returns gradients for textureGrad(): (du, dv) along one axis of the footprint, then along the other. footprint holds
// both axes from inEdges(); uvEdges holds (Δu, Δv) along each edge; texels is the size of mip 0.
// A sampler covers a footprint that is up to `anisotropy` times as long as wide. For a longer one it would choose the
// level by the length, which is too blurred. Such a footprint is shrunk, to the level of an ellipse of the same area
// that the sampler can cover. Without anisotropy that level comes from the geometric mean of the axes, which keeps
// floors sharper than the long axis would and quieter than the short one.
// Returns 0, for the finest level, if the triangle or the texture has no area, or if the footprint is endless.
vec4 coneGradients(vec4 footprint, vec4 uvEdges, vec2 texels, float anisotropy) {
    vec4 gradients = vec4(footprint.x * uvEdges.xy + footprint.y * uvEdges.zw,
                          footprint.z * uvEdges.xy + footprint.w * uvEdges.zw);
    vec4 inTexels = gradients * vec4(texels, texels);
    float longest2 = max(dot(inTexels.xy, inTexels.xy), dot(inTexels.zw, inTexels.zw));
    // The area comes from the determinants of both maps, because the footprint itself may be too long to give it.
    float area = abs((footprint.x * footprint.w - footprint.y * footprint.z) *
                     (uvEdges.x * uvEdges.w - uvEdges.y * uvEdges.z)) *
                 texels.x * texels.y;
    float scale = sqrt(min(anisotropy * area / longest2, 1.0));
    vec4 scaled = gradients * scale;
    // The sum is infinite or not a number if one of its parts is. 1e9 is more than any texture repeats under a
    // footprint.
    float size = dot(abs(scaled), vec4(1.0));
    return size < 1e9 ? scaled : vec4(0.0);
}
