// The light that the effect reflection adds to a pixel. The sample's weight includes everything about the surface.
vec3 composeReflection(vec3 weight, vec3 radiance) {
    return weight * radiance;
}
