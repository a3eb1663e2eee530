// Frames, normals and offsets.

// Orthonormal basis without a branch on the sign of n.z: Duff et al., "Building an Orthonormal Basis, Revisited"
// (JCGT 2017). n is unit.
void buildBasis(vec3 n, out vec3 tangent, out vec3 bitangent) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    bitangent = vec3(b, s + n.y * n.y * a, -n.y);
}

// A ray origin off the surface, on the side that n points to: Wächter and Binder, "A Fast and Robust Method for
// Avoiding Self-Intersection" (Ray Tracing Gems, chapter 6). n is the geometric normal. Away from 0 it steps by units
// in the last place, scaled so that it exceeds the error of an interpolated position; near 0 by a fixed length.
vec3 offsetRayOrigin(vec3 position, vec3 n) {
    const float kOrigin = 1.0 / 32.0;
    const float kFloatScale = 1.0 / 65536.0;
    const float kIntScale = 256.0;
    ivec3 offset = ivec3(kIntScale * n);
    vec3 stepped = intBitsToFloat(floatBitsToInt(position) + mix(offset, -offset, lessThan(position, vec3(0.0))));
    return mix(stepped, position + kFloatScale * n, lessThan(abs(position), vec3(kOrigin)));
}

// Octahedral mapping of a unit vector to [-1, 1]²: Cigolle et al., "A Survey of Efficient Representations for
// Independent Unit Vectors" (JCGT 2014).
vec2 octahedralEncode(vec3 v) {
    vec2 p = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
    vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return v.z >= 0.0 ? p : folded;
}

vec3 octahedralDecode(vec2 e) {
    vec3 v = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float t = max(-v.z, 0.0);
    v.xy += vec2(v.x >= 0.0 ? -t : t, v.y >= 0.0 ? -t : t);
    return normalize(v);
}

vec3 transformPoint(vec4 rows[3], vec3 p) {
    return vec3(dot(rows[0], vec4(p, 1.0)), dot(rows[1], vec4(p, 1.0)), dot(rows[2], vec4(p, 1.0)));
}

vec3 transformVector(vec4 rows[3], vec3 v) {
    return vec3(dot(rows[0].xyz, v), dot(rows[1].xyz, v), dot(rows[2].xyz, v));
}

vec3 transformNormal(vec3 rows[3], vec3 n) {
    return vec3(dot(rows[0], n), dot(rows[1], n), dot(rows[2], n));
}
