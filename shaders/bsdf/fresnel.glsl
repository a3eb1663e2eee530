// Fresnel reflectance.

// Schlick's approximation with f90 = 1: glTF 2.0, appendix B.3.4. cosine is that of view and half vector, in [0, 1].
vec3 fresnelSchlick(vec3 f0, float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    float m2 = m * m;
    return f0 + (vec3(1.0) - f0) * (m2 * m2 * m);
}

// Directional albedo of a single-scatter GGX lobe with Schlick's Fresnel: what it reflects of a uniform white sky.
// Fitted by scripts/fit_directional_albedo.py, within 0.05 of the quadrature for f0 = 0 and 1. The loss is the light
// that single scattering drops; the bias is the part that (1 - v·h)⁵ weights.
vec3 ggxDirectionalAlbedo(vec3 f0, float roughness, float nDotV) {
    float s = sqrt(nDotV);
    float loss = roughness * (1.0851 - 2.6717 * s + 1.2389 * nDotV +
                              roughness * (-3.2357 + 10.8412 * s - 6.5117 * nDotV) +
                              roughness * roughness * (2.1175 - 7.2329 * s + 5.1085 * nDotV));
    float white = clamp(1.0 - loss, 0.0, 1.0);
    float bias = pow(max(1.0 - nDotV, 0.0), 5.0 * exp(-1.5 * roughness)) / (1.0 + 14.5 * roughness * roughness);
    return f0 * max(white - bias, 0.0) + vec3(min(bias, white));
}
