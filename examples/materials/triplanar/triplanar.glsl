// Textures along the three axes of the world, mixed by the normal. Normals are mixed by "whiteout" blending: Golus,
// "Normal Mapping for a Triplanar Shader" (2017).
#include "hit/surface_values.glsl"

// The texel of a slot on the plane across one axis. u and v are the other two.
vec4 triplanarTexel(Hit hit, uint slot, Features features, vec2 place, vec2 edge1, vec2 edge2) {
    float scale = 1.0 / GLINT_MATERIAL_TRIPLANAR_SCALE(hit);
    return sampleSlotAt(hit, slot, features, scale * place, scale * vec4(edge1, edge2));
}

void triplanarSurface(Hit hit, Features features, inout SurfaceValues values) {
    vec3 n = values.normal;
    vec3 weights = pow(abs(n), vec3(GLINT_MATERIAL_TRIPLANAR_SHARPNESS(hit)));
    weights /= weights.x + weights.y + weights.z;
    // V of glTF goes down, and the textures of walls should stand upright.
    vec2 x = vec2(hit.position.z, -hit.position.y);
    vec2 y = hit.position.xz;
    vec2 z = vec2(hit.position.x, -hit.position.y);
    vec3 a = hit.edges[0];
    vec3 b = hit.edges[1];
    vec2 xa = vec2(a.z, -a.y);
    vec2 xb = vec2(b.z, -b.y);
    vec2 za = vec2(a.x, -a.y);
    vec2 zb = vec2(b.x, -b.y);
    if (GLINT_HAS_TRIPLANAR_COLOR_TEXTURE(features)) {
        values.color *= weights.x * triplanarTexel(hit, kTriplanarColorTexture, features, x, xa, xb) +
                        weights.y * triplanarTexel(hit, kTriplanarColorTexture, features, y, a.xz, b.xz) +
                        weights.z * triplanarTexel(hit, kTriplanarColorTexture, features, z, za, zb);
    }
    if (GLINT_HAS_TRIPLANAR_NORMAL_TEXTURE(features)) {
        vec3 tx = 2.0 * triplanarTexel(hit, kTriplanarNormalTexture, features, x, xa, xb).xyz - 1.0;
        vec3 ty = 2.0 * triplanarTexel(hit, kTriplanarNormalTexture, features, y, a.xz, b.xz).xyz - 1.0;
        vec3 tz = 2.0 * triplanarTexel(hit, kTriplanarNormalTexture, features, z, za, zb).xyz - 1.0;
        vec3 nx = vec3(n.x, n.y + tx.y, n.z + tx.x);
        vec3 ny = vec3(n.x + ty.x, n.y, n.z - ty.y);
        vec3 nz = vec3(n.x + tz.x, n.y + tz.y, n.z);
        values.normal = directionOr(weights.x * nx + weights.y * ny + weights.z * nz, n);
    }
}
