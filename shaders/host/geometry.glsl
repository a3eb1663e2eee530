// Attributes of triangles. Here they are those of Glint's scene, by address.
#include "hit/geometry.glsl"
#include "host/resources.glsl"

// The host's data about the geometry that was hit. Glint reads its members shaderId, materialIndex, featureLobes,
// featureInputs and flags, as GeometryRecord describes them, and hands it back to the functions below.
#define HostGeometry GeometryRecord

// `geometry` is the number of the hit: instanceCustomIndex + geometryIndex.
HostGeometry hostGeometry(uint geometry) {
    return GLINT_FRAME.geometries.data[geometry];
}

// Returns the same member as hostGeometry(), for passes that order hits and need nothing else.
uint hostShaderId(uint geometry) {
    return GLINT_FRAME.geometries.data[geometry].shaderId;
}

InstanceRecord hostInstance(HostGeometry geometry) {
    return GLINT_FRAME.instances.data[geometry.instanceIndex];
}

#if GLINT_STEPS
// The index of a triangle's material, for hosts whose triangles may have materials of their own.
#define GLINT_HOST_PRIMITIVE_MATERIALS

uint hostMaterial(HostGeometry geometry, uint primitive) {
    if (geometry.primitiveMaterials == 0u) {
        return geometry.materialIndex;
    }
    PrimitiveMaterials materials = GLINT_FRAME.primitiveMaterials.data[geometry.primitiveMaterials - 1u];
    return geometry.materialIndex + materials.numbers.data[primitive];
}
#endif

#if GLINT_ANSWERS_SURFACE
// The instance of the previous frame, for the motion of its points.
InstanceRecord hostPreviousInstance(HostGeometry geometry) {
    return GLINT_FRAME.previousInstances.data[geometry.instanceIndex];
}
#endif

// The number of the vertex at a corner. Triangle t has the corners 3t, 3t + 1 and 3t + 2.
uint hostVertex(HostGeometry geometry, uint corner) {
    if ((geometry.flags & kGeometryShortIndices) != 0u) {
        uint pair = geometry.indices.data[corner >> 1];
        return (corner & 1u) != 0u ? pair >> 16 : pair & 0xFFFFu;
    }
    return geometry.indices.data[corner];
}

// Attributes are read in the form of their flag.

// Three coordinates of 16 bits behind their range. Products and sums are rounded as on the host, so that the position
// is that of the acceleration structure.
vec3 packedPosition(UintArray words, uint vertex) {
    vec3 least = uintBitsToFloat(uvec3(words.data[0], words.data[1], words.data[2]));
    vec3 step = uintBitsToFloat(uvec3(words.data[3], words.data[4], words.data[5]));
    uint place = 6u + (3u * vertex >> 1);
    uvec2 pair = uvec2(words.data[place], words.data[place + 1u]);
    uvec3 code = (vertex & 1u) != 0u ? uvec3(pair.x >> 16, pair.y & 0xFFFFu, pair.y >> 16)
                                     : uvec3(pair.x & 0xFFFFu, pair.x >> 16, pair.y & 0xFFFFu);
    precise vec3 offset = step * vec3(code);
    precise vec3 position = least + offset;
    return position;
}

// Returns the position in the mesh's space. Counter-clockwise corners show the front.
vec3 hostPosition(HostGeometry geometry, uint vertex) {
    if ((geometry.flags & kGeometryPackedPositions) != 0u) {
        return packedPosition(UintArray(geometry.positions), vertex);
    }
    return geometry.positions.data[vertex];
}

// The following are called only if featureInputs says that the geometry has them.

vec3 packedNormal(UintArray words, uint vertex) {
    return octahedralDecode(unpackSnorm2x16(words.data[vertex]));
}

// A unit vector in the mesh's space.
vec3 hostNormal(HostGeometry geometry, uint vertex) {
    return (geometry.flags & kGeometryPackedNormals) != 0u ? packedNormal(UintArray(geometry.normals), vertex)
                                                           : geometry.normals.data[vertex];
}

vec4 packedTangent(UintArray words, uint vertex) {
    uint word = words.data[vertex];
    vec2 code = vec2(float(bitfieldExtract(int(word), 0, 16)) / 32767.0, float(int(word) >> 17) / 16383.0);
    return vec4(octahedralDecode(code), (word & 0x10000u) != 0u ? -1.0 : 1.0);
}

// A unit vector in the mesh's space; w = ±1 is the sign of the bitangent.
vec4 hostTangent(HostGeometry geometry, uint vertex) {
    return (geometry.flags & kGeometryPackedTangents) != 0u ? packedTangent(UintArray(geometry.tangents), vertex)
                                                            : geometry.tangents.data[vertex];
}

// Two coordinates of 16 bits behind their range.
vec2 packedTexCoord(UintArray words, uint vertex) {
    vec2 least = uintBitsToFloat(uvec2(words.data[0], words.data[1]));
    vec2 step = uintBitsToFloat(uvec2(words.data[2], words.data[3]));
    uint word = words.data[4u + vertex];
    return least + step * vec2(float(word & 0xFFFFu), float(word >> 16));
}

vec2 hostTexCoord0(HostGeometry geometry, uint vertex) {
    return (geometry.flags & kGeometryPackedTexCoords0) != 0u
               ? packedTexCoord(UintArray(geometry.texCoords0), vertex)
               : geometry.texCoords0.data[vertex];
}

vec2 hostTexCoord1(HostGeometry geometry, uint vertex) {
    return (geometry.flags & kGeometryPackedTexCoords1) != 0u
               ? packedTexCoord(UintArray(geometry.texCoords1), vertex)
               : geometry.texCoords1.data[vertex];
}

vec4 colorOf16(UintArray words, uint vertex) {
    return vec4(unpackUnorm2x16(words.data[2u * vertex]), unpackUnorm2x16(words.data[2u * vertex + 1u]));
}

// Linear RGBA.
vec4 hostColor(HostGeometry geometry, uint vertex) {
    UintArray words = UintArray(geometry.colors);
    if ((geometry.flags & kGeometryColors8) != 0u) {
        return unpackUnorm4x8(words.data[vertex]);
    }
    if ((geometry.flags & kGeometryColors16) != 0u) {
        return colorOf16(words, vertex);
    }
    return geometry.colors.data[vertex];
}

// One number of a vertex's attributes that packs declare. `channel` counts over all of them; a vertex has `stride`
// numbers (Package::attributes()).
float hostAttribute(HostGeometry geometry, uint vertex, uint channel, uint stride) {
    return geometry.attributes.data[stride * vertex + channel];
}

// The same for the three corners of a triangle. Their form is tested once, so that their loads follow each other and
// neighbouring words become one.
#define GLINT_HOST_TRIANGLES

uvec3 hostTriangle(HostGeometry geometry, uint primitive) {
    uint first = 3u * primitive;
    if ((geometry.flags & kGeometryShortIndices) != 0u) {
        uint place = first >> 1;
        uvec2 pair = uvec2(geometry.indices.data[place], geometry.indices.data[place + 1u]);
        return (first & 1u) != 0u ? uvec3(pair.x >> 16, pair.y & 0xFFFFu, pair.y >> 16)
                                  : uvec3(pair.x & 0xFFFFu, pair.x >> 16, pair.y & 0xFFFFu);
    }
    return uvec3(geometry.indices.data[first], geometry.indices.data[first + 1u], geometry.indices.data[first + 2u]);
}

void hostPositions(HostGeometry geometry, uvec3 vertices, out vec3 corners[3]) {
    if ((geometry.flags & kGeometryPackedPositions) != 0u) {
        UintArray words = UintArray(geometry.positions);
        corners = vec3[3](packedPosition(words, vertices.x), packedPosition(words, vertices.y), packedPosition(words,
                          vertices.z));
    } else {
        corners = vec3[3](geometry.positions.data[vertices.x], geometry.positions.data[vertices.y],
                          geometry.positions.data[vertices.z]);
    }
}

void hostNormals(HostGeometry geometry, uvec3 vertices, out vec3 corners[3]) {
    if ((geometry.flags & kGeometryPackedNormals) != 0u) {
        UintArray words = UintArray(geometry.normals);
        corners = vec3[3](packedNormal(words, vertices.x), packedNormal(words, vertices.y), packedNormal(words,
                          vertices.z));
    } else {
        corners = vec3[3](geometry.normals.data[vertices.x], geometry.normals.data[vertices.y],
                          geometry.normals.data[vertices.z]);
    }
}

void hostTangents(HostGeometry geometry, uvec3 vertices, out vec4 corners[3]) {
    if ((geometry.flags & kGeometryPackedTangents) != 0u) {
        UintArray words = UintArray(geometry.tangents);
        corners = vec4[3](packedTangent(words, vertices.x), packedTangent(words, vertices.y), packedTangent(words,
                          vertices.z));
    } else {
        corners = vec4[3](geometry.tangents.data[vertices.x], geometry.tangents.data[vertices.y],
                          geometry.tangents.data[vertices.z]);
    }
}

void hostTexCoords0(HostGeometry geometry, uvec3 vertices, out vec2 corners[3]) {
    if ((geometry.flags & kGeometryPackedTexCoords0) != 0u) {
        UintArray words = UintArray(geometry.texCoords0);
        corners = vec2[3](packedTexCoord(words, vertices.x), packedTexCoord(words, vertices.y), packedTexCoord(words,
                          vertices.z));
    } else {
        corners = vec2[3](geometry.texCoords0.data[vertices.x], geometry.texCoords0.data[vertices.y],
                          geometry.texCoords0.data[vertices.z]);
    }
}

void hostTexCoords1(HostGeometry geometry, uvec3 vertices, out vec2 corners[3]) {
    if ((geometry.flags & kGeometryPackedTexCoords1) != 0u) {
        UintArray words = UintArray(geometry.texCoords1);
        corners = vec2[3](packedTexCoord(words, vertices.x), packedTexCoord(words, vertices.y), packedTexCoord(words,
                          vertices.z));
    } else {
        corners = vec2[3](geometry.texCoords1.data[vertices.x], geometry.texCoords1.data[vertices.y],
                          geometry.texCoords1.data[vertices.z]);
    }
}

void hostColors(HostGeometry geometry, uvec3 vertices, out vec4 corners[3]) {
    UintArray words = UintArray(geometry.colors);
    if ((geometry.flags & kGeometryColors8) != 0u) {
        corners = vec4[3](unpackUnorm4x8(words.data[vertices.x]), unpackUnorm4x8(words.data[vertices.y]),
                          unpackUnorm4x8(words.data[vertices.z]));
    } else if ((geometry.flags & kGeometryColors16) != 0u) {
        corners = vec4[3](colorOf16(words, vertices.x), colorOf16(words, vertices.y), colorOf16(words, vertices.z));
    } else {
        corners = vec4[3](geometry.colors.data[vertices.x], geometry.colors.data[vertices.y],
                          geometry.colors.data[vertices.z]);
    }
}
