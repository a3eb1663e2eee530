// The normal texture.
#include "hit/surface_values.glsl"

void normalSurface(Hit hit, Features features, inout SurfaceValues values) {
    if (hasInput(features, GLINT_NORMAL_TEXTURE)) {
        values.normal = mappedNormal(hit, kNormalTexture, GLINT_MATERIAL_NORMAL_SCALE(hit), features);
    }
}
