// The share of the surface that is there.
#include "hit/surface_point.glsl"

void openPbrOpacity(SurfacePoint point, Features features, inout float alpha) {
    alpha *= GLINT_MATERIAL_OPEN_PBR_GEOMETRY_OPACITY(point);
}
