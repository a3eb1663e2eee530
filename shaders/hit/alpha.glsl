// The alpha of a candidate, for ray traversal over masked geometry.
#include "hit/bindings.glsl"
#include "bsdf/features.glsl"

// Returns whether the candidate passes its material's alpha test: glTF 2.0, section 3.9.4. It reads mip 0, because
// traversal knows no footprint. The module's own cases do not matter here: a ray of any case meets masks of all cases.
bool passesAlphaTest(GeometryRecord geometry, uint primitive, vec2 barycentrics) {
    Features features = Features(0u, GLINT_ALPHA_ALWAYS, 0u, GLINT_ALPHA_SOMETIMES, 0u, geometry.featureInputs);
    MaterialRecord material = GLINT_FRAME.materials.data[geometry.materialIndex];
    uvec3 corner = uvec3(geometry.indices.data[3u * primitive], geometry.indices.data[3u * primitive + 1u],
                         geometry.indices.data[3u * primitive + 2u]);
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    float alpha = material.baseColorFactor.a;
    if (inputOfKey(features, GLINT_BASE_COLOR_TEXTURE)) {
        TextureRecord record = GLINT_TEXTURE(material, kBaseColorTexture);
        vec2 uv = vec2(0.0);
        if (inputOfKey(features, GLINT_TEX_COORD_0) && record.texCoord == 0u) {
            uv = weights.x * geometry.texCoords0.data[corner.x] + weights.y * geometry.texCoords0.data[corner.y] +
                 weights.z * geometry.texCoords0.data[corner.z];
        } else if (inputOfKey(features, GLINT_TEX_COORD_1)) {
            uv = weights.x * geometry.texCoords1.data[corner.x] + weights.y * geometry.texCoords1.data[corner.y] +
                 weights.z * geometry.texCoords1.data[corner.z];
        }
        if (inputOfKey(features, GLINT_TEXTURE_TRANSFORM)) {
            uv = vec2(dot(record.rowU, vec3(uv, 1.0)), dot(record.rowV, vec3(uv, 1.0)));
        }
        alpha *= textureLod(sampler2D(sceneTextures[nonuniformEXT(record.textureIndex)],
                                      sceneSamplers[nonuniformEXT(record.samplerIndex)]),
                            uv, 0.0)
                     .a;
    }
    if (inputOfKey(features, GLINT_VERTEX_COLOR)) {
        alpha *= dot(weights, vec3(geometry.colors.data[corner.x].a, geometry.colors.data[corner.y].a,
                                   geometry.colors.data[corner.z].a));
    }
    return alpha >= material.alphaCutoff;
}
