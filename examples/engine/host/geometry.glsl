// Attributes of triangles in the engine's formats, for the steps that Glint records. The engine's interleaved vertices
// are at `positions` of a record, its indices at `indices`. shaders/engine.glsl has the same formats.
#include "host/resources.glsl"

#define HostGeometry GeometryRecord

// EngineSceneView::Geometry::hostFlags.
const uint kEngineCompact = 1u << kGeometryHostFlagsShift;
const uint kFullWords = 18u;
const uint kCompactWords = 7u;

HostGeometry hostGeometry(uint geometry) {
    return GLINT_FRAME.geometries.data[geometry];
}

uint hostShaderId(uint geometry) {
    return GLINT_FRAME.geometries.data[geometry].shaderId;
}

InstanceRecord hostInstance(HostGeometry geometry) {
    return GLINT_FRAME.instances.data[geometry.instanceIndex];
}

bool isCompact(HostGeometry geometry) {
    return (geometry.flags & kEngineCompact) != 0u;
}

UintArray vertexWords(HostGeometry geometry) {
    return UintArray(geometry.positions);
}

uint hostVertex(HostGeometry geometry, uint corner) {
    if (!isCompact(geometry)) {
        return geometry.indices.data[corner];
    }
    uint word = geometry.indices.data[corner / 2u];
    return (corner & 1u) == 0u ? word & 0xFFFFu : word >> 16;
}

float fullFloat(HostGeometry geometry, uint vertex, uint word) {
    return uintBitsToFloat(vertexWords(geometry).data[kFullWords * vertex + word]);
}

uint compactWord(HostGeometry geometry, uint vertex, uint word) {
    return vertexWords(geometry).data[kCompactWords * vertex + word];
}

vec2 snorm2x16(uint word) {
    return max(vec2(ivec2(int(word << 16) >> 16, int(word) >> 16)) / 32767.0, -1.0);
}

vec3 octahedralWord(uint word) {
    vec2 e = snorm2x16(word);
    float z = 1.0 - abs(e.x) - abs(e.y);
    float t = max(-z, 0.0);
    return normalize(vec3(e.x + (e.x >= 0.0 ? -t : t), e.y + (e.y >= 0.0 ? -t : t), z));
}

vec3 hostPosition(HostGeometry geometry, uint vertex) {
    if (isCompact(geometry)) {
        return vec3(snorm2x16(compactWord(geometry, vertex, 0u)), snorm2x16(compactWord(geometry, vertex, 1u)).x);
    }
    return vec3(fullFloat(geometry, vertex, 0u), fullFloat(geometry, vertex, 1u), fullFloat(geometry, vertex, 2u));
}

vec3 hostNormal(HostGeometry geometry, uint vertex) {
    return isCompact(geometry) ? octahedralWord(compactWord(geometry, vertex, 2u))
                               : vec3(fullFloat(geometry, vertex, 3u), fullFloat(geometry, vertex, 4u),
                                      fullFloat(geometry, vertex, 5u));
}

vec4 hostTangent(HostGeometry geometry, uint vertex) {
    if (isCompact(geometry)) {
        return vec4(octahedralWord(compactWord(geometry, vertex, 3u)),
                    int(compactWord(geometry, vertex, 1u)) < 0 ? -1.0 : 1.0);
    }
    return vec4(fullFloat(geometry, vertex, 6u), fullFloat(geometry, vertex, 7u), fullFloat(geometry, vertex, 8u),
                fullFloat(geometry, vertex, 9u));
}

vec2 texCoord(HostGeometry geometry, uint vertex, uint set) {
    return isCompact(geometry) ? unpackHalf2x16(compactWord(geometry, vertex, 4u + set))
                               : vec2(fullFloat(geometry, vertex, 10u + 2u * set),
                                      fullFloat(geometry, vertex, 11u + 2u * set));
}

vec2 hostTexCoord0(HostGeometry geometry, uint vertex) {
    return texCoord(geometry, vertex, 0u);
}

vec2 hostTexCoord1(HostGeometry geometry, uint vertex) {
    return texCoord(geometry, vertex, 1u);
}

vec4 hostColor(HostGeometry geometry, uint vertex) {
    return isCompact(geometry) ? unpackUnorm4x8(compactWord(geometry, vertex, 6u))
                               : vec4(fullFloat(geometry, vertex, 14u), fullFloat(geometry, vertex, 15u),
                                      fullFloat(geometry, vertex, 16u), fullFloat(geometry, vertex, 17u));
}

// No pack of this example declares attributes.
float hostAttribute(HostGeometry geometry, uint vertex, uint channel, uint stride) {
    return 0.0;
}
