#version 460
// Stores the hit of the ray, which is shaded elsewhere.
#extension GL_EXT_ray_tracing : require
#include "hit/geometry_index.glsl"
#include "hit/payload.glsl"

layout(location = 0) rayPayloadInEXT TracePayload traced;
hitAttributeEXT vec2 hitBarycentrics;

void main() {
    traced.geometry = geometryOfHit(gl_InstanceID, gl_InstanceCustomIndexEXT, gl_GeometryIndexEXT);
    traced.primitive = uint(gl_PrimitiveID);
    traced.barycentrics = hitBarycentrics;
    traced.distance = gl_HitTEXT;
}
