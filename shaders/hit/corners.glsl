// Where the corners of the hit triangle come from: its vertex buffer, or the acceleration structure, which has read them
// already. For modules that trace and shade; included before hit/hit.glsl.
#include "generated/scene.glsl"

#if GLINT_POSITION_FETCH
#extension GL_EXT_ray_tracing_position_fetch : require
#if GLINT_TRACER == 1
// Of the last ray that traceRay() followed, in the mesh's space.
vec3 tracedCorners[3];
#define GLINT_KEEPS_CORNERS
#define GLINT_CORNER(i) tracedCorners[i]
#endif
#endif
