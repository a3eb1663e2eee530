// A place on a surface as the stages "coordinates" and "opacity" know it. They also run for candidates of rays and for
// rasterised triangles, so they know neither a normal nor a footprint.
#include "host/geometry.glsl"
#include "hit/frame_time.glsl"
#include "host/texture.glsl"
#include "bsdf/features.glsl"
#include "generated/attributes.glsl"
#include "hit/geometry.glsl"
#include "hit/triangle.glsl"

struct SurfacePoint {
    vec3 position;  // world
    uint material;
    vec2 texCoords[2];
#if GLINT_VERTEX_ATTRIBUTES
    VertexAttributes attributes;
#endif
};

// Fetches the attributes that `features` may need and that only they read. The features may be of any key.
SurfacePoint surfacePoint(HostGeometry geometry, uint primitive, vec2 barycentrics, Features features) {
    uvec3 corner = hostTriangle(geometry, primitive);
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    SurfacePoint point;
    point.material = materialOf(geometry, primitive);
    point.position = vec3(0.0);
#if GLINT_MASK_STAGES
    vec3 places[3];
    hostPositions(geometry, corner, places);
    vec3 place = weights.x * places[0] + weights.y * places[1] + weights.z * places[2];
    point.position = transformPoint(hostInstance(geometry).objectToWorld, place);
#endif
    point.texCoords[0] = vec2(0.0);
    point.texCoords[1] = vec2(0.0);
    if (inputOfKey(features, GLINT_ROLE_TEX_COORD0)) {
        vec2 uv[3];
        hostTexCoords0(geometry, corner, uv);
        point.texCoords[0] = weights.x * uv[0] + weights.y * uv[1] + weights.z * uv[2];
    }
    if (inputOfKey(features, GLINT_ROLE_TEX_COORD1)) {
        vec2 uv[3];
        hostTexCoords1(geometry, corner, uv);
        point.texCoords[1] = weights.x * uv[0] + weights.y * uv[1] + weights.z * uv[2];
    }
#if GLINT_VERTEX_ATTRIBUTES && GLINT_MASK_STAGES
    point.attributes = fetchAttributes(geometry, corner, weights, features);
#endif
    return point;
}

// Returns the alpha of the vertices' colours.
float vertexAlpha(HostGeometry geometry, uint primitive, vec2 barycentrics) {
    vec4 colors[3];
    hostColors(geometry, hostTriangle(geometry, primitive), colors);
    return dot(vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics), vec3(colors[0].a, colors[1].a, colors[2].a));
}

// Returns the coordinates at which a texture slot is read.
vec2 pointCoordinates(SurfacePoint point, uint slot, Features features) {
    TextureRecord record = GLINT_TEXTURE(GLINT_MATERIAL(point), slot);
    bool second = inputOfKey(features, GLINT_ROLE_TEX_COORD1) &&
                  (!inputOfKey(features, GLINT_ROLE_TEX_COORD0) || record.texCoord != 0u);
    vec2 uv = second ? point.texCoords[1] : point.texCoords[0];
    return inputOfKey(features, GLINT_ROLE_TEXTURE_TRANSFORM)
               ? vec2(dot(record.rowU, vec3(uv, 1.0)), dot(record.rowV, vec3(uv, 1.0)))
               : uv;
}

// Returns the value of a texture slot. It is that of mip 0, because traversal knows no footprint.
vec4 samplePoint(SurfacePoint point, uint slot, Features features) {
    TextureRecord record = GLINT_TEXTURE(GLINT_MATERIAL(point), slot);
    return hostFinestTexture(record, pointCoordinates(point, slot, features));
}
