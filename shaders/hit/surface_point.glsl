// A place on a surface as the stages "coordinates" and "opacity" know it. They also run for candidates of rays and for
// rasterised triangles, so they know neither a normal nor a footprint.
#include "host/geometry.glsl"
#include "hit/frame_time.glsl"
#include "host/texture.glsl"
#include "bsdf/features.glsl"
#include "generated/attributes.glsl"
#include "hit/geometry.glsl"

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
    uvec3 corner = uvec3(hostVertex(geometry, 3u * primitive), hostVertex(geometry, 3u * primitive + 1u),
                         hostVertex(geometry, 3u * primitive + 2u));
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    SurfacePoint point;
    point.material = geometry.materialIndex;
    point.position = vec3(0.0);
#if GLINT_MASK_STAGES
    vec3 place = weights.x * hostPosition(geometry, corner.x) + weights.y * hostPosition(geometry, corner.y) +
                 weights.z * hostPosition(geometry, corner.z);
    point.position = transformPoint(hostInstance(geometry).objectToWorld, place);
#endif
    point.texCoords[0] = vec2(0.0);
    point.texCoords[1] = vec2(0.0);
    if (inputOfKey(features, GLINT_TEX_COORD_0)) {
        point.texCoords[0] = weights.x * hostTexCoord0(geometry, corner.x) +
                             weights.y * hostTexCoord0(geometry, corner.y) +
                             weights.z * hostTexCoord0(geometry, corner.z);
    }
    if (inputOfKey(features, GLINT_TEX_COORD_1)) {
        point.texCoords[1] = weights.x * hostTexCoord1(geometry, corner.x) +
                             weights.y * hostTexCoord1(geometry, corner.y) +
                             weights.z * hostTexCoord1(geometry, corner.z);
    }
#if GLINT_VERTEX_ATTRIBUTES && GLINT_MASK_STAGES
    point.attributes = fetchAttributes(geometry, corner, weights, features);
#endif
    return point;
}

// Returns the alpha of the vertices' colours.
float vertexAlpha(HostGeometry geometry, uint primitive, vec2 barycentrics) {
    return dot(vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics),
               vec3(hostColor(geometry, hostVertex(geometry, 3u * primitive)).a,
                    hostColor(geometry, hostVertex(geometry, 3u * primitive + 1u)).a,
                    hostColor(geometry, hostVertex(geometry, 3u * primitive + 2u)).a));
}

// Returns the coordinates at which a texture slot is read.
vec2 pointCoordinates(SurfacePoint point, uint slot, Features features) {
    TextureRecord record = GLINT_TEXTURE(GLINT_MATERIAL(point), slot);
    bool second = inputOfKey(features, GLINT_TEX_COORD_1) &&
                  (!inputOfKey(features, GLINT_TEX_COORD_0) || record.texCoord != 0u);
    vec2 uv = second ? point.texCoords[1] : point.texCoords[0];
    return inputOfKey(features, GLINT_TEXTURE_TRANSFORM)
               ? vec2(dot(record.rowU, vec3(uv, 1.0)), dot(record.rowV, vec3(uv, 1.0)))
               : uv;
}

// Returns the value of a texture slot. It is that of mip 0, because traversal knows no footprint.
vec4 samplePoint(SurfacePoint point, uint slot, Features features) {
    TextureRecord record = GLINT_TEXTURE(GLINT_MATERIAL(point), slot);
    return hostFinestTexture(record, pointCoordinates(point, slot, features));
}
