// The media of Glint's own base, as rays need them that go through.
#include "materials/base/media.glsl"
#include "materials/volume/nesting.glsl"

// The share of light that passes a length, in metres, of the innermost medium.
vec3 mediumTransmittance(Media media, float distance) {
#ifdef GLINT_RECORD_ABSORPTION
    vec3 absorption = GLINT_RECORD_ABSORPTION(hostMaterials().data[innermostMaterial(media)]);
    return volumeTransmittance(absorption, distance);
#else
    return vec3(1.0);
#endif
}
