// Coordinates that move with a velocity and ripple across it.
#include "bsdf/constants.glsl"
#include "hit/surface_point.glsl"

void flowCoordinates(inout SurfacePoint point, Features features) {
    float t = frameTime();
    vec2 uv = point.texCoords[0] + t * GLINT_MATERIAL_FLOW_VELOCITY(point);
    vec2 phase = 2.0 * kPi * (GLINT_MATERIAL_FLOW_WAVES(point) * uv.yx + vec2(t, 0.7 * t));
    point.texCoords[0] = uv + GLINT_MATERIAL_FLOW_RIPPLE(point) * sin(phase);
}
