// The acceleration structure of the scene.
#include "hit/bindings.glsl"
#include "hit/stage.glsl"

#if GLINT_TRACER == 1
#extension GL_EXT_ray_query : require
#elif GLINT_TRACER == 2
#extension GL_EXT_ray_tracing : require
#endif

#if GLINT_TRACER != 0
layout(set = GLINT_BINDING_SCENE_SET, binding = GLINT_BINDING_TLAS) uniform accelerationStructureEXT sceneTlas[];
#endif
