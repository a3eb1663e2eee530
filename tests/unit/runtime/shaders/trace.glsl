#extension GL_EXT_ray_query : require
#extension GL_EXT_ray_flags_primitive_culling : require

layout(set = kSetScene, binding = kBindingTlas) uniform accelerationStructureEXT sceneTlas[];

HitRecord traceRay(RayRecord ray, uint index) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, sceneTlas[pushed.tlasIndex],
                          gl_RayFlagsOpaqueEXT | gl_RayFlagsSkipAABBEXT | gl_RayFlagsCullBackFacingTrianglesEXT, 0xFFu,
                          ray.origin, 0.0, ray.direction, 1e18);
    rayQueryProceedEXT(query);
    HitRecord hit = HitRecord(ray.target, kMissGeometry, 0u, 0.0, 0.0, 0.0, 0.0, index);
    if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT) {
        hit.geometry = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true) +
                            rayQueryGetIntersectionGeometryIndexEXT(query, true));
        hit.primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
        hit.distance_orDirectionZ = rayQueryGetIntersectionTEXT(query, true);
    }
    return hit;
}

// Returns geometry + 1, primitive, distance; 0 for a miss.
vec4 describe(HitRecord hit) {
    return hit.geometry == kMissGeometry ? vec4(0.0)
                                         : vec4(float(hit.geometry) + 1.0, float(hit.primitive), hit.distance_orDirectionZ, 1.0);
}
