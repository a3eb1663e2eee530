// The share of light that passes a length of absorbing medium (Beer and Lambert): KHR_materials_volume. absorption is
// per metre.
vec3 volumeTransmittance(vec3 absorption, float distance) {
    return exp(-absorption * distance);
}
