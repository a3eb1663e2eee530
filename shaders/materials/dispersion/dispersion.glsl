// The indices of red, green and blue light: KHR_materials_dispersion. The spread is symmetric about green.
vec3 dispersedIor(float ior, float dispersion) {
    float halfSpread = (ior - 1.0) * 0.025 * dispersion;
    return vec3(ior - halfSpread, ior, ior + halfSpread);
}
