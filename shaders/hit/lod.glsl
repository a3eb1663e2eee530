// Texture level of detail under a ray cone.

// Where a cone of width coneWidth meets a surface under `cosine` it covers an ellipse with the axes coneWidth and
// coneWidth / cosine: the geometric mean keeps floors sharper than the long axis would and quieter than the short one.
// Below 0.01 radians the ellipse is cut.
float coneFootprint(float coneWidth, float cosine) {
    return coneWidth * inversesqrt(max(abs(cosine), 0.01));
}

// Akenine-Möller et al., "Texture Level of Detail Strategies for Real-Time Ray Tracing" (Ray Tracing Gems, chapter 20),
// with the footprint on the surface: texels under it, by the ratio of the triangle's areas in texels and in the world.
// edge0 and edge1: the triangle's in the world; uvEdges: (Δu, Δv) along each; texels: size of mip 0. 0 where either area
// vanishes or a texel is wider than the footprint.
float coneLod(float footprint, vec3 edge0, vec3 edge1, vec4 uvEdges, vec2 texels) {
    float uvArea = abs(uvEdges.x * uvEdges.w - uvEdges.y * uvEdges.z) * texels.x * texels.y;
    vec3 normal = cross(edge0, edge1);
    // Scaled, as the square of a small triangle's area is no float.
    float largest = max(max(abs(normal.x), abs(normal.y)), abs(normal.z));
    float covered = footprint * sqrt(uvArea / (largest * length(normal / largest)));
    return covered > 1.0 && !isinf(covered) ? log2(covered) : 0.0;
}
