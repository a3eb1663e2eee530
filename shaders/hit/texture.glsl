// Material textures at a hit.
#include "hit/hit.glsl"

// Level of detail of a texture under a ray cone: Akenine-Möller et al., "Texture Level of Detail Strategies for
// Real-Time Ray Tracing" (Ray Tracing Gems, chapter 20), with the cone's footprint on the surface: texels under it, by
// the ratio of the triangle's areas in texels and in the world; 0 where either vanishes.
float coneLod(Hit hit, vec4 uvEdges, vec2 texels) {
    float uvArea = abs(uvEdges.x * uvEdges.w - uvEdges.y * uvEdges.z) * texels.x * texels.y;
    vec3 worldCross = cross(hit.edges[0], hit.edges[1]);
    float worldArea = sqrt(dot(worldCross, worldCross));
    float texelsPerFootprint = hit.footprint * sqrt(uvArea / worldArea);
    return texelsPerFootprint > 1.0 && !isinf(texelsPerFootprint) ? log2(texelsPerFootprint) : 0.0;
}

// The value of one texture slot of the hit's material.
vec4 sampleSlot(Hit hit, uint slot, Features features) {
    TextureRecord record = GLINT_FRAME.materials.data[hit.material].textures[slot];
    bool second = hasInput(features, GLINT_TEXCOORD_1) &&
                  (!hasInput(features, GLINT_TEXCOORD_0) || record.texCoord == 1u);
    vec2 uv = second ? hit.texCoords[1] : hit.texCoords[0];
    vec4 uvEdges = second ? hit.uvEdges[1] : hit.uvEdges[0];
    if (hasInput(features, GLINT_TEXTURE_TRANSFORM)) {
        uv = vec2(dot(record.rowU, vec3(uv, 1.0)), dot(record.rowV, vec3(uv, 1.0)));
        uvEdges = vec4(dot(record.rowU.xy, uvEdges.xy), dot(record.rowV.xy, uvEdges.xy),
                       dot(record.rowU.xy, uvEdges.zw), dot(record.rowV.xy, uvEdges.zw));
    }
    return textureLod(sampler2D(sceneTextures[nonuniformEXT(record.textureIndex)],
                                sceneSamplers[nonuniformEXT(record.samplerIndex)]),
                      uv, coneLod(hit, uvEdges, record.texels));
}

// Tangent and bitangent for the normal texture: from the TANGENT attribute, or from the derivatives of position by
// UV. The bitangent points up in the image, against V, as in glTF 2.0, section 3.7.2.1.
void tangentFrame(Hit hit, Features features, out vec3 tangent, out vec3 bitangent) {
    vec3 along = hit.tangent.xyz;
    float handedness = hit.tangent.w;
    if (!hasInput(features, GLINT_TANGENTS)) {
        bool second = hasInput(features, GLINT_TEXCOORD_1) &&
                      (!hasInput(features, GLINT_TEXCOORD_0) ||
                       GLINT_FRAME.materials.data[hit.material].textures[kTextureNormal].texCoord == 1u);
        vec4 uv = second ? hit.uvEdges[1] : hit.uvEdges[0];
        float determinant = uv.x * uv.w - uv.y * uv.z;
        along = (hit.edges[0] * uv.w - hit.edges[1] * uv.y) * sign(determinant);
        vec3 alongV = (hit.edges[1] * uv.x - hit.edges[0] * uv.z) * sign(determinant);
        handedness = dot(cross(hit.normal, along), alongV) > 0.0 ? -1.0 : 1.0;
    }
    vec3 inPlane = along - hit.normal * dot(hit.normal, along);
    float squared = dot(inPlane, inPlane);
    if (squared > 0.0 && !isinf(squared)) {
        tangent = inPlane * inversesqrt(squared);
        bitangent = cross(hit.normal, tangent) * handedness;
    } else {
        // No direction of U on the surface: any frame will do.
        buildBasis(hit.normal, tangent, bitangent);
    }
}
