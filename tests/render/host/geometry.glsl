// A host of the tests: it reads the vertices of Glint's scene as an engine with a layout of its own would, word by word
// from interleaved memory.
#extension GL_EXT_buffer_reference_uvec2 : require
#include "host/resources.glsl"
#include "words/words.glsl"

struct HostGeometry {
    uint shaderId;
    uint materialIndex;
    uint featureLobes;
    uint featureInputs;
    uint flags;
    uint number;
};

HostGeometry hostGeometry(uint geometry) {
    GeometryRecord record = GLINT_FRAME.geometries.data[geometry];
    return HostGeometry(record.shaderId, record.materialIndex, record.featureLobes, record.featureInputs, record.flags,
                        geometry);
}

uint hostShaderId(uint geometry) {
    return hostGeometry(geometry).shaderId;
}

InstanceRecord hostInstance(HostGeometry geometry) {
    return GLINT_FRAME.instances.data[GLINT_FRAME.geometries.data[geometry.number].instanceIndex];
}

uint hostVertex(HostGeometry geometry, uint corner) {
    return GLINT_FRAME.geometries.data[geometry.number].indices.data[corner];
}

vec3 hostPosition(HostGeometry geometry, uint vertex) {
    return floatsAt(uvec2(GLINT_FRAME.geometries.data[geometry.number].positions), 3u * vertex).xyz;
}

vec3 hostNormal(HostGeometry geometry, uint vertex) {
    return floatsAt(uvec2(GLINT_FRAME.geometries.data[geometry.number].normals), 3u * vertex).xyz;
}

vec4 hostTangent(HostGeometry geometry, uint vertex) {
    return floatsAt(uvec2(GLINT_FRAME.geometries.data[geometry.number].tangents), 4u * vertex);
}

vec2 hostTexCoord0(HostGeometry geometry, uint vertex) {
    return floatsAt(uvec2(GLINT_FRAME.geometries.data[geometry.number].texCoords0), 2u * vertex).xy;
}

vec2 hostTexCoord1(HostGeometry geometry, uint vertex) {
    return floatsAt(uvec2(GLINT_FRAME.geometries.data[geometry.number].texCoords1), 2u * vertex).xy;
}

float hostAttribute(HostGeometry geometry, uint vertex, uint channel, uint stride) {
    return floatsAt(uvec2(GLINT_FRAME.geometries.data[geometry.number].attributes), stride * vertex + channel).x;
}

vec4 hostColor(HostGeometry geometry, uint vertex) {
    return floatsAt(uvec2(GLINT_FRAME.geometries.data[geometry.number].colors), 4u * vertex);
}
