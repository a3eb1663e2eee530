// Holes of a perforated sheet.
#include "hit/surface_point.glsl"

void perforationOpacity(SurfacePoint point, Features features, inout float alpha) {
    vec2 cell = point.texCoords[0] * GLINT_MATERIAL_PERFORATION_ROWS(point);
    float distance = length(fract(cell) - 0.5);
    alpha = distance < GLINT_MATERIAL_PERFORATION_RADIUS(point) ? 0.0 : alpha;
}
