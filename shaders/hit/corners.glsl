// The source of the hit triangle's corners: its vertex buffer, or the acceleration structure, which has already read
// them. For modules that trace and shade. Include it before hit/hit.glsl.
#include "generated/scene.glsl"

#if GLINT_POSITION_FETCH
#extension GL_EXT_ray_tracing_position_fetch : require
#if GLINT_TRACER == 1
// The corners of the last triangle that traceRay() hit, in the mesh's space.
vec3 tracedCorners[3];
#define GLINT_KEEPS_CORNERS
#define GLINT_CORNER(i) tracedCorners[i]
#endif
#endif
