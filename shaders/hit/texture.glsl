// The material's textures at a hit.
#include "hit/hit.glsl"
#include "hit/frame_time.glsl"
#include "host/texture.glsl"

// Returns whether a slot reads the second UV set.
bool readsSecondSet(Hit hit, uint slot, Features features) {
    return hasInput(features, GLINT_ROLE_TEX_COORD1) &&
           (!hasInput(features, GLINT_ROLE_TEX_COORD0) || GLINT_TEXTURE(GLINT_MATERIAL(hit), slot).texCoord == 1u);
}

// Returns how the coordinates that a texture is read at change along both edges of the triangle, where those of the UV
// set change by uvEdges.
vec4 transformedEdges(TextureRecord record, vec4 uvEdges) {
    return vec4(dot(record.rowU.xy, uvEdges.xy), dot(record.rowV.xy, uvEdges.xy), dot(record.rowU.xy, uvEdges.zw),
                dot(record.rowV.xy, uvEdges.zw));
}

// Returns the value of a texture slot at coordinates of the caller's own. uvEdges has their change along both edges of
// the triangle, (Δu, Δv) each. Texture and coordinates are read in 32 bits, whatever the precision of the result.
GLINT_RELAXED vec4 sampleSlotAt(Hit hit, uint slot, Features features, vec2 uv, vec4 uvEdges) {
    TextureRecord record = GLINT_TEXTURE(GLINT_MATERIAL(hit), slot);
    if (hasInput(features, GLINT_ROLE_TEXTURE_TRANSFORM)) {
        uv = vec2(dot(record.rowU, vec3(uv, 1.0)), dot(record.rowV, vec3(uv, 1.0)));
        uvEdges = transformedEdges(record, uvEdges);
    }
    if (GLINT_TEXTURE_LOD_CONES == 0) {
        vec4 finest = hostFinestTexture(record, uv);
        return finest;
    }
    vec3 filtered = hostTextureFilter(record);
    vec4 gradients = coneGradients(hit.footprint, uvEdges, filtered.xy, filtered.z);
    vec4 texel = hostTexture(record, uv, gradients);
    return texel;
}

// Returns the value of one texture slot of the hit's material.
GLINT_RELAXED vec4 sampleSlot(Hit hit, uint slot, Features features) {
    bool second = readsSecondSet(hit, slot, features);
    return sampleSlotAt(hit, slot, features, second ? hit.texCoords[1] : hit.texCoords[0],
                        second ? hit.uvEdges[1] : hit.uvEdges[0]);
}

// --- Textures of other dimensions, which packs declare ---

#if GLINT_ARRAY_TEXTURES
// As sampleSlotAt(), of a layer of an array.
GLINT_RELAXED vec4 sampleArrayAt(Hit hit, uint slot, Features features, vec2 uv, vec4 uvEdges, float layer) {
    TextureRecord record = GLINT_TEXTURE(GLINT_MATERIAL(hit), slot);
    if (hasInput(features, GLINT_ROLE_TEXTURE_TRANSFORM)) {
        uv = vec2(dot(record.rowU, vec3(uv, 1.0)), dot(record.rowV, vec3(uv, 1.0)));
        uvEdges = transformedEdges(record, uvEdges);
    }
    if (GLINT_TEXTURE_LOD_CONES == 0) {
        vec4 finest = hostArrayTextureLevel(record, vec3(uv, layer), 0.0);
        return finest;
    }
    vec3 filtered = hostTextureFilter(record);
    vec4 gradients = coneGradients(hit.footprint, uvEdges, filtered.xy, filtered.z);
    vec4 texel = hostArrayTexture(record, vec3(uv, layer), gradients);
    return texel;
}

// As sampleSlot(), of a layer of an array.
GLINT_RELAXED vec4 sampleArray(Hit hit, uint slot, Features features, float layer) {
    bool second = readsSecondSet(hit, slot, features);
    return sampleArrayAt(hit, slot, features, second ? hit.texCoords[1] : hit.texCoords[0],
                         second ? hit.uvEdges[1] : hit.uvEdges[0], layer);
}

GLINT_RELAXED vec4 sampleArrayLevel(Hit hit, uint slot, vec2 uv, float layer, float level) {
    vec4 texel = hostArrayTextureLevel(GLINT_TEXTURE(GLINT_MATERIAL(hit), slot), vec3(uv, layer), level);
    return texel;
}
#endif

// Returns the level at which a footprint covers one texel. `texels` is its area on the finest level, in texels. As in
// coneGradients(), an endless footprint gives the finest level.
float levelOfArea(float texels) {
    return GLINT_TEXTURE_LOD_CONES != 0 && texels > 1.0 && texels < 1e18 ? 0.5 * log2(texels) : 0.0;
}

// Returns the area of the footprint in units of the parallelogram of the triangle's edges.
float footprintArea(Hit hit) {
    return abs(hit.footprint.x * hit.footprint.w - hit.footprint.y * hit.footprint.z);
}

#if GLINT_CUBE_TEXTURES
GLINT_RELAXED vec4 sampleCubeLevel(Hit hit, uint slot, vec3 direction, float level) {
    vec4 texel = hostCubeTexture(GLINT_TEXTURE(GLINT_MATERIAL(hit), slot), direction, level);
    return texel;
}

// Returns the value of a cube in a direction of any length. `edges` has its change along both edges of the triangle.
// The level is that of a square with the area of the footprint on the cube's face.
GLINT_RELAXED vec4 sampleCubeAt(Hit hit, uint slot, vec3 direction, vec3[2] edges) {
    float side = 0.5 * hostTextureFilter(GLINT_TEXTURE(GLINT_MATERIAL(hit), slot)).x;
    float longest = max(max(abs(direction.x), abs(direction.y)), abs(direction.z));
    // The face is the plane where the longest component is 1. The projection on it scales the solid angle of the
    // parallelogram, |d · (a × b)| / |d|³, by (|d| / longest)³.
    float area = footprintArea(hit) * abs(dot(direction, cross(edges[0], edges[1]))) / (longest * longest * longest);
    return sampleCubeLevel(hit, slot, direction, levelOfArea(side * side * area));
}
#endif

#if GLINT_VOLUME_TEXTURES
GLINT_RELAXED vec4 sampleVolumeLevel(Hit hit, uint slot, vec3 place, float level) {
    vec4 texel = hostVolumeTexture(GLINT_TEXTURE(GLINT_MATERIAL(hit), slot), place, level);
    return texel;
}

// Returns the value of a 3D texture at a place, where the texture is the unit cube. `edges` has its change along both
// edges of the triangle. The level is that of a square with the footprint's area, as if the texture were as deep as
// its longer side is long, in texels.
GLINT_RELAXED vec4 sampleVolumeAt(Hit hit, uint slot, vec3 place, vec3[2] edges) {
    vec2 size = hostTextureFilter(GLINT_TEXTURE(GLINT_MATERIAL(hit), slot)).xy;
    vec3 texels = vec3(size, max(size.x, size.y));
    float area = footprintArea(hit) * length(cross(edges[0] * texels, edges[1] * texels));
    return sampleVolumeLevel(hit, slot, place, levelOfArea(area));
}
#endif

// Returns tangent and bitangent at the hit, from the TANGENT attribute or from the derivatives of position by the
// coordinates that `slot` is read at. The bitangent points up in the image, against V, as in glTF 2.0, section 3.7.2.1.
void tangentFrame(Hit hit, uint slot, Features features, out vec3 tangent, out vec3 bitangent) {
    vec3 along = hit.tangent.xyz;
    float handedness = hit.tangent.w;
    if (!hasInput(features, GLINT_ROLE_TANGENTS)) {
        vec4 uv = readsSecondSet(hit, slot, features) ? hit.uvEdges[1] : hit.uvEdges[0];
        if (hasInput(features, GLINT_ROLE_TURNED_FRAMES)) {
            uv = transformedEdges(GLINT_TEXTURE(GLINT_MATERIAL(hit), slot), uv);
        }
        float determinant = uv.x * uv.w - uv.y * uv.z;
        along = (hit.edges[0] * uv.w - hit.edges[1] * uv.y) * sign(determinant);
        vec3 alongV = (hit.edges[1] * uv.x - hit.edges[0] * uv.z) * sign(determinant);
        handedness = dot(cross(hit.normal, along), alongV) > 0.0 ? -1.0 : 1.0;
    }
    tangent = directionOr(along - hit.normal * dot(hit.normal, along), vec3(0.0));
    if (tangent == vec3(0.0)) {
        // U has no direction on the surface, so any frame will do.
        buildBasis(hit.normal, tangent, bitangent);
    } else {
        bitangent = cross(hit.normal, tangent) * handedness;
    }
}

// Returns the normal from a normal texture.
vec3 mappedNormal(Hit hit, uint slot, float scale, Features features) {
    vec4 packedNormal = sampleSlot(hit, slot, features);
    vec3 texel = packedNormal.xyz * 2.0 - 1.0;
    // A texture with red and green alone (BC5, EAC RG) reads 0 as blue. Otherwise no normal is on that side.
    if (packedNormal.z == 0.0) {
        texel.z = sqrt(max(1.0 - dot(texel.xy, texel.xy), 0.0));
    }
    vec3 tangent;
    vec3 bitangent;
    tangentFrame(hit, slot, features, tangent, bitangent);
    return directionOr(texel.x * scale * tangent + texel.y * scale * bitangent + texel.z * hit.normal, hit.normal);
}
