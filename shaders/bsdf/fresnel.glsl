// Fresnel reflectance.

// Schlick's approximation with f90 = 1: glTF 2.0, appendix B.3.4. cosine is that of view and half vector, in [0, 1].
vec3 fresnelSchlick(vec3 f0, float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    float m2 = m * m;
    return f0 + (vec3(1.0) - f0) * (m2 * m2 * m);
}

// Directional albedo of a GGX lobe: fit by Karis, "Physically Based Shading on Mobile" (2014). Within 0.02 of the
// quadrature; at roughness 0 it is Schlick's curve within 0.02.
vec3 ggxDirectionalAlbedo(vec3 f0, float roughness, float nDotV) {
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a004 = min(r.x * r.x, exp2(-9.28 * nDotV)) * r.x + r.y;
    vec2 ab = vec2(-1.04, 1.04) * a004 + r.zw;
    return f0 * ab.x + vec3(ab.y);
}
