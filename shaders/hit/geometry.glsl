// Normals and offsets.
#include "bsdf/basis.glsl"

// The octahedral mapping of a unit vector to [-1, 1]²: Cigolle et al., "A Survey of Efficient Representations for
// Independent Unit Vectors" (JCGT 2014).
vec2 octahedralEncode(vec3 v) {
    vec2 p = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
    vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return v.z >= 0.0 ? p : folded;
}

vec3 octahedralDecode(vec2 e) {
    float z = 1.0 - abs(e.x) - abs(e.y);
    float t = max(-z, 0.0);
    return normalize(vec3(e.x + (e.x >= 0.0 ? -t : t), e.y + (e.y >= 0.0 ? -t : t), z));
}

// Values that decide where a ray starts and where it goes are `precise`, so that each shader rounds them in the same
// way. Otherwise a shadow ray at an edge would depend on the strategy that shades the hit.

// Returns a vector's direction, or `fallback` if it has none (degenerate triangles, singular transforms) or is not a
// number. The vector is scaled first, so that no square leaves the range of floats: this works for lengths from 1e-37
// to 1e37.
vec3 directionOr(vec3 v, vec3 fallback) {
    precise vec3 scaled = v / max(max(abs(v.x), abs(v.y)), abs(v.z));
    precise float squared = dot(scaled, scaled);
    precise vec3 direction = scaled * inversesqrt(squared);
    // The square is 1 to 3; 0, infinity and NaN lead outside of this range.
    return squared > 0.5 && squared < 4.0 ? direction : fallback;
}

vec3 transformPoint(vec4 rows[3], vec3 p) {
    precise vec3 point =
        vec3(dot(rows[0], vec4(p, 1.0)), dot(rows[1], vec4(p, 1.0)), dot(rows[2], vec4(p, 1.0)));
    return point;
}

vec3 transformVector(vec4 rows[3], vec3 v) {
    return vec3(dot(rows[0].xyz, v), dot(rows[1].xyz, v), dot(rows[2].xyz, v));
}

vec3 transformNormal(vec3 rows[3], vec3 n) {
    precise vec3 normal = vec3(dot(rows[0], n), dot(rows[1], n), dot(rows[2], n));
    return normal;
}

// Returns a direction on the side of the triangle to which `side` points: Hit::geometricNormal, or its opposite.
// Normal maps and interpolated normals make a lobe send part of its light to the other side. As with the facets of
// Schüssler et al., "Microfacet-based Normal Mapping for Robust Monte Carlo Path Tracing" (2017), such light is
// reflected once more and not lost: at the plane of the triangle. The weight of a sample stays that of its own
// direction, so that the lobe keeps its albedo. All directions leave the plane by at least 1e-3 (about a twentieth of a
// degree), so that no ray starts into its own surface.
vec3 onSide(vec3 direction, vec3 side) {
    float height = dot(direction, side);
    return normalize(direction + side * (max(abs(height), 1e-3) - height));
}

// Returns a vector that takes a point of a triangle away from the edges to which it is closer than `least`. Where two
// walls meet, rounding may put a point of one behind the other, and a ray from there would leave the room; the
// clearance along the point's own normal does not help. A point is moved by at most a sixth of the triangle. Edges are
// in the world, from the first corner; `weights` are the barycentric coordinates.
vec3 edgeInset(vec3 weights, vec3 edge1, vec3 edge2, float least) {
    precise vec3 normal = cross(edge1, edge2);
    precise float area = length(normal);
    // Each corner's weight is the distance from the opposite edge over the corner's height above it.
    precise vec3 lengths = vec3(length(edge2 - edge1), length(edge2), length(edge1));
    precise vec3 missing = max(min(least * lengths / area, vec3(1.0 / 6.0)) - weights, vec3(0.0));
    precise float sum = missing.x + missing.y + missing.z;
    if (!(sum > 0.0)) {
        return vec3(0.0);
    }
    // The largest weight is reduced by as much as the other two get.
    bool first = weights.x >= weights.y && weights.x >= weights.z;
    bool second = !first && weights.y >= weights.z;
    precise float step1 = missing.y - (second ? sum : 0.0);
    precise float step2 = missing.z - (!first && !second ? sum : 0.0);
    precise vec3 inset = step1 * edge1 + step2 * edge2;
    return inset;
}

// A triangle in its mesh's space, and a point on it.
struct TrianglePoint {
    vec3 corner;
    vec3 edge1;
    vec3 edge2;
    vec3 position;
};

// Bounds how far rounding may move a point from its triangle's plane, along the world's unit normal n. The point is
// transformed into the world, used as a ray's origin, transformed back by the traversal and intersected with the
// triangle. Forward error analysis (Higham, Accuracy and Stability of Numerical Algorithms, chapter 3): each sum of
// products is off by at most the sum of their absolute values times the number of successive roundings, which is below
// 16 here.
float planeError(vec3 n, TrianglePoint point, vec4 objectToWorld[3], vec3 normalToWorld[3]) {
    const float kSixteenRoundings = 1.0 / 1048576.0;
    // The plane's normal in the mesh's space, in metres of the world for one unit of the mesh.
    precise vec3 r = abs(n.x * objectToWorld[0].xyz + n.y * objectToWorld[1].xyz + n.z * objectToWorld[2].xyz);
    // Interpolation and intersection. The latter mixes the axes: even a triangle in the plane z = 0 is met at a rounded
    // z.
    vec3 extent = abs(point.edge1) + abs(point.edge2);
    float largestExtent = max(extent.x, max(extent.y, extent.z));
    precise float object = dot(r, abs(point.corner) + vec3(largestExtent));
    // The transform into the world. The terms are no smaller than their sum, so this bounds the world's coordinates
    // too.
    precise vec3 terms = vec3(dot(abs(objectToWorld[0]), vec4(abs(point.position), 1.0)),
                      dot(abs(objectToWorld[1]), vec4(abs(point.position), 1.0)),
                      dot(abs(objectToWorld[2]), vec4(abs(point.position), 1.0)));
    precise float world = dot(abs(n), terms);
    // The transform back by the inverse, which is the transposed cofactors over the determinant.
    precise vec3 inverse = vec3(dot(abs(normalToWorld[0]), r), dot(abs(normalToWorld[1]), r),
                                dot(abs(normalToWorld[2]), r));
    precise float determinant = dot(objectToWorld[0].xyz, normalToWorld[0]);
    precise float back = dot(inverse, terms) / determinant;
    // Beyond a condition number of 1000, an origin this far off would skip the scene's details.
    precise float most = 1024.0 * (object + world);
    precise float bound = kSixteenRoundings * (object + world + (back < most ? back : most));
    return bound;
}
