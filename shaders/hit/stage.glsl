// The threads of passes that may trace, in compute shaders or in ray generation shaders. Passes over pixels are at the
// rows of a band.
#ifndef GLINT_TRACER
#define GLINT_TRACER 1  // 0: none, 1: ray queries, 2: ray tracing pipeline
#endif
#ifndef GLINT_RAY_GENERATION
#define GLINT_RAY_GENERATION 0
#endif

#if GLINT_RAY_GENERATION
#extension GL_EXT_ray_tracing : require
#define GLINT_RAY_WORKGROUP
#define GLINT_PIXEL_WORKGROUP
#define GLINT_PIXEL_OF_THREAD (gl_LaunchIDEXT.xy + uvec2(0u, GLINT_FRAME.firstRow))
#else
#define GLINT_RAY_WORKGROUP layout(local_size_x = kRayGroupSize) in;
#define GLINT_PIXEL_WORKGROUP layout(local_size_x = kPixelGroupSize, local_size_y = kPixelGroupSize) in;
#define GLINT_PIXEL_OF_THREAD (gl_GlobalInvocationID.xy + uvec2(0u, GLINT_FRAME.firstRow))
#endif
