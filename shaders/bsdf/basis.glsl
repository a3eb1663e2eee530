// An orthonormal basis without a branch on the sign of n.z: Duff et al., "Building an Orthonormal Basis, Revisited"
// (JCGT 2017). n is a unit vector.
void buildBasis(vec3 n, out vec3 tangent, out vec3 bitangent) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    bitangent = vec3(b, s + n.y * n.y * a, -n.y);
}
