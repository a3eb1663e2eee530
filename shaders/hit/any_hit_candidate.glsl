// The candidate of an any-hit shader.
#extension GL_EXT_ray_tracing : require
#include "hit/alpha.glsl"
#include "hit/geometry_index.glsl"
#include "light/candidate.glsl"

hitAttributeEXT vec2 hitBarycentrics;

PassageCandidate anyHitCandidate(uint geometry) {
    return PassageCandidate(gl_WorldRayOriginEXT, gl_WorldRayDirectionEXT, geometry, uint(gl_PrimitiveID),
                            hitBarycentrics, gl_HitTEXT);
}
