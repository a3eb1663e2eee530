// A place on a surface as the stages "coordinates" and "opacity" know it. They also run for candidates of rays and for
// rasterised triangles, so they know neither a normal nor a footprint.
#include "hit/bindings.glsl"
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

// Fetches what `features` may need: attributes that they read alone. The features may be of any key.
SurfacePoint surfacePoint(GeometryRecord geometry, uint primitive, vec2 barycentrics, Features features) {
    uvec3 corner = uvec3(geometry.indices.data[3u * primitive], geometry.indices.data[3u * primitive + 1u],
                         geometry.indices.data[3u * primitive + 2u]);
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    SurfacePoint point;
    point.material = geometry.materialIndex;
    point.position = vec3(0.0);
#if GLINT_MASK_STAGES
    vec3 place = weights.x * geometry.positions.data[corner.x] + weights.y * geometry.positions.data[corner.y] +
                 weights.z * geometry.positions.data[corner.z];
    point.position = transformPoint(GLINT_FRAME.instances.data[geometry.instanceIndex].objectToWorld, place);
#endif
    point.texCoords[0] = vec2(0.0);
    point.texCoords[1] = vec2(0.0);
    if (inputOfKey(features, GLINT_TEX_COORD_0)) {
        point.texCoords[0] = weights.x * geometry.texCoords0.data[corner.x] +
                             weights.y * geometry.texCoords0.data[corner.y] +
                             weights.z * geometry.texCoords0.data[corner.z];
    }
    if (inputOfKey(features, GLINT_TEX_COORD_1)) {
        point.texCoords[1] = weights.x * geometry.texCoords1.data[corner.x] +
                             weights.y * geometry.texCoords1.data[corner.y] +
                             weights.z * geometry.texCoords1.data[corner.z];
    }
#if GLINT_VERTEX_ATTRIBUTES && GLINT_MASK_STAGES
    point.attributes = fetchAttributes(geometry, corner, weights, features);
#endif
    return point;
}

// Returns the alpha of the vertices' colours.
float vertexAlpha(GeometryRecord geometry, uint primitive, vec2 barycentrics) {
    return dot(vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics),
               vec3(geometry.colors.data[geometry.indices.data[3u * primitive]].a,
                    geometry.colors.data[geometry.indices.data[3u * primitive + 1u]].a,
                    geometry.colors.data[geometry.indices.data[3u * primitive + 2u]].a));
}

// Returns the coordinates at which a texture slot is read.
vec2 pointCoordinates(SurfacePoint point, uint slot, Features features) {
    TextureRecord record = GLINT_TEXTURE(GLINT_FRAME.materials.data[point.material], slot);
    bool second = inputOfKey(features, GLINT_TEX_COORD_1) &&
                  (!inputOfKey(features, GLINT_TEX_COORD_0) || record.texCoord != 0u);
    vec2 uv = second ? point.texCoords[1] : point.texCoords[0];
    return inputOfKey(features, GLINT_TEXTURE_TRANSFORM)
               ? vec2(dot(record.rowU, vec3(uv, 1.0)), dot(record.rowV, vec3(uv, 1.0)))
               : uv;
}

// Returns the value of a texture slot. It is that of mip 0, because traversal knows no footprint.
vec4 samplePoint(SurfacePoint point, uint slot, Features features) {
    TextureRecord record = GLINT_TEXTURE(GLINT_FRAME.materials.data[point.material], slot);
    return textureLod(sampler2D(sceneTextures[nonuniformEXT(record.textureIndex)],
                                sceneSamplers[nonuniformEXT(record.samplerIndex)]),
                      pointCoordinates(point, slot, features), 0.0);
}
