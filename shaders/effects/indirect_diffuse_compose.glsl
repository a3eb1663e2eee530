// The light that the effect indirect diffuse adds to a pixel. The sample's weight includes all about the surface.
vec3 composeIndirectDiffuse(vec3 weight, vec3 radiance) {
    return weight * radiance;
}
