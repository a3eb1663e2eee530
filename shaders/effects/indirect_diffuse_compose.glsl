// What the effect indirect diffuse adds to a pixel: the sample's weight holds all of the surface.
vec3 composeIndirectDiffuse(vec3 weight, vec3 radiance) {
    return weight * radiance;
}
