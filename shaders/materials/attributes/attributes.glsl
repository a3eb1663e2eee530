// Colours of vertices.
#include "hit/surface_values.glsl"

void attributesSurface(Hit hit, Features features, inout SurfaceValues values) {
    if (hasInput(features, GLINT_VERTEX_COLOR)) {
        // glTF 2.0, section 3.7.2.1, bounds vertex colours. Values beyond would overflow in 16 bits.
        values.color *= GLINT_PRECISION == 16 ? clamp(hit.color, vec4(0.0), vec4(1.0)) : hit.color;
    }
}
