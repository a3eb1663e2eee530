// What the effect reflection adds to a pixel: the sample's weight holds all of the surface.
vec3 composeReflection(vec3 weight, vec3 radiance) {
    return weight * radiance;
}
