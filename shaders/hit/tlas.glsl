// The acceleration structure of the scene: a host's descriptor, or the address that a host gives. It is no element of an
// array: a compiler that can't prove an index to be the same for all threads makes traversal several times slower.
#include "hit/bindings.glsl"
#include "hit/stage.glsl"

#if GLINT_TRACER == 1
#extension GL_EXT_ray_query : require
#elif GLINT_TRACER == 2
#extension GL_EXT_ray_tracing : require
#endif

#if GLINT_TRACER != 0
#if GLINT_TLAS_BY_ADDRESS
#define GLINT_TLAS accelerationStructureEXT(GLINT_FRAME.tlasAddress)
#else
layout(set = GLINT_BINDING_SCENE_SET, binding = GLINT_BINDING_TLAS) uniform accelerationStructureEXT sceneTlas;
#define GLINT_TLAS sceneTlas
#endif
#endif
