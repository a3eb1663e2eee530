#version 460
// Traces the deferred shadow rays of hits: light that nothing blocks joins what their pixels reflect.
#include "hit/images.glsl"
#include "hit/list.glsl"
#include "hit/trace.glsl"

GLINT_RAY_WORKGROUP

void main() {
    uint index = listIndex();
    if (index >= GLINT_FRAME.shadowDispatch.data[0].elementCount) {
        return;
    }
    ShadowRecord shadow = GLINT_FRAME.shadows.data[index];
    if (isVisible(shadow.origin, shadow.direction, shadow.distance)) {
        // A pixel has one reflection ray, and its hit one shadow ray: nobody else writes here.
        ivec2 place = pixelCoordinates(shadow.pixel);
        vec4 reflection = imageLoad(reflectionImage, place);
        imageStore(reflectionImage, place, vec4(reflection.rgb + shadow.light, reflection.w));
    }
}
