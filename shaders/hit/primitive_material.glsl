// The material of a triangle. Hosts whose triangles have materials of their own define hostMaterial().
#include "host/geometry.glsl"

// Returns the index of the material's record.
uint materialOf(HostGeometry geometry, uint primitive) {
#ifdef GLINT_HOST_PRIMITIVE_MATERIALS
    return hostMaterial(geometry, primitive);
#else
    return geometry.materialIndex;
#endif
}
