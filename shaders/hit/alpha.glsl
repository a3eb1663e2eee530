// The alpha of a candidate, for ray traversal over masked geometry.
#include "bsdf/features.glsl"
#include "host/geometry.glsl"
#include "host/material.glsl"
#include "host/texture.glsl"

// Returns whether the candidate passes its material's alpha test: glTF 2.0, section 3.9.4. It reads mip 0, because
// traversal knows no footprint. The module's own cases do not matter here: a ray of any case meets masks of all cases.
bool passesAlphaTest(HostGeometry geometry, uint primitive, vec2 barycentrics) {
    Features features = Features(0u, GLINT_ALPHA_ALWAYS, 0u, GLINT_ALPHA_SOMETIMES, 0u, geometry.featureInputs);
    MaterialRecord material = hostMaterials().data[geometry.materialIndex];
    uvec3 corner = uvec3(hostVertex(geometry, 3u * primitive), hostVertex(geometry, 3u * primitive + 1u),
                         hostVertex(geometry, 3u * primitive + 2u));
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    float alpha = material.baseColorFactor.a;
    if (inputOfKey(features, GLINT_BASE_COLOR_TEXTURE)) {
        TextureRecord record = GLINT_TEXTURE(material, kBaseColorTexture);
        vec2 uv = vec2(0.0);
        if (inputOfKey(features, GLINT_TEX_COORD_0) && record.texCoord == 0u) {
            uv = weights.x * hostTexCoord0(geometry, corner.x) + weights.y * hostTexCoord0(geometry, corner.y) +
                 weights.z * hostTexCoord0(geometry, corner.z);
        } else if (inputOfKey(features, GLINT_TEX_COORD_1)) {
            uv = weights.x * hostTexCoord1(geometry, corner.x) + weights.y * hostTexCoord1(geometry, corner.y) +
                 weights.z * hostTexCoord1(geometry, corner.z);
        }
        if (inputOfKey(features, GLINT_TEXTURE_TRANSFORM)) {
            uv = vec2(dot(record.rowU, vec3(uv, 1.0)), dot(record.rowV, vec3(uv, 1.0)));
        }
        alpha *= hostFinestTexture(record, uv).a;
    }
    if (inputOfKey(features, GLINT_VERTEX_COLOR)) {
        alpha *= dot(weights, vec3(hostColor(geometry, corner.x).a, hostColor(geometry, corner.y).a,
                                   hostColor(geometry, corner.z).a));
    }
    return alpha >= material.alphaCutoff;
}
