#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_query : require
// primary.glsl for devices with ray queries.
#include "primary.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

bool isVisible(vec3 origin, vec3 direction, float distance) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, structure, gl_RayFlagsOpaqueEXT | gl_RayFlagsTerminateOnFirstHitEXT, 0xFFu,
                          origin, 0.0, direction, distance);
    rayQueryProceedEXT(query);
    return rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT;
}

void main() {
    lightPixel(gl_GlobalInvocationID.xy);
}
