// What the effect refraction adds to a pixel: the sample's weight holds all of the surface.
vec3 composeRefraction(vec3 weight, vec3 radiance) {
    return weight * radiance;
}
