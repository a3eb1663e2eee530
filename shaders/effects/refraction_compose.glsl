// The light that the effect refraction adds to a pixel. The sample's weight includes everything about the surface.
vec3 composeRefraction(vec3 weight, vec3 radiance) {
    return weight * radiance;
}
