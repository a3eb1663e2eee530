#extension GL_EXT_ray_query : require
#extension GL_EXT_ray_flags_primitive_culling : require

layout(set = kSetScene, binding = kBindingTlas) uniform accelerationStructureEXT sceneTlas;

// The distance stands in the place of the cone's width.
HitRecord traceRay(uint target) {
    vec3 direction = FRAME.sampleAims.data[target].direction;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, sceneTlas,
                          gl_RayFlagsOpaqueEXT | gl_RayFlagsSkipAABBEXT | gl_RayFlagsCullBackFacingTrianglesEXT, 0xFFu,
                          FRAME.sampleStarts.data[target].origin_orRadiance, 0.0, direction, 1e18);
    rayQueryProceedEXT(query);
    HitRecord hit = HitRecord(kMissGeometry, 0u, 0.0, 0.0, 0.0);
    if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT) {
        hit.geometry = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true) +
                            rayQueryGetIntersectionGeometryIndexEXT(query, true));
        hit.primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
        hit.coneWidth = rayQueryGetIntersectionTEXT(query, true);
    }
    return hit;
}

// Returns geometry + 1, primitive, distance; 0 for a miss.
SampleStart describe(HitRecord hit) {
    vec3 value = vec3(float(hit.geometry) + 1.0, float(hit.primitive), hit.coneWidth);
    return SampleStart(hit.geometry == kMissGeometry ? vec3(0.0) : value, kRaySent);
}
