// Attributes of triangles. Here they are those of Glint's scene: vertices and indices of 32 bits, by address.
#include "host/resources.glsl"

// What the host knows of the geometry that was hit. Glint reads its members shaderId, materialIndex, featureLobes,
// featureInputs and flags, as GeometryRecord describes them, and hands it back to the functions below.
#define HostGeometry GeometryRecord

// `geometry` is the number of the hit: instanceCustomIndex + geometryIndex.
HostGeometry hostGeometry(uint geometry) {
    return GLINT_FRAME.geometries.data[geometry];
}

// The same member of hostGeometry(), for what orders hits and needs nothing else.
uint hostShaderId(uint geometry) {
    return GLINT_FRAME.geometries.data[geometry].shaderId;
}

InstanceRecord hostInstance(HostGeometry geometry) {
    return GLINT_FRAME.instances.data[geometry.instanceIndex];
}

#if GLINT_ANSWERS_SURFACE
// The instance as it was in the frame before, for the motion of its points.
InstanceRecord hostPreviousInstance(HostGeometry geometry) {
    return GLINT_FRAME.previousInstances.data[geometry.instanceIndex];
}
#endif

// The number of the vertex at a corner. Triangle t has the corners 3t, 3t + 1 and 3t + 2.
uint hostVertex(HostGeometry geometry, uint corner) {
    return geometry.indices.data[corner];
}

// In the mesh's space. Counter-clockwise corners show the front.
vec3 hostPosition(HostGeometry geometry, uint vertex) {
    return geometry.positions.data[vertex];
}

// The following are asked for only if featureInputs says that the geometry has them.

// A unit vector in the mesh's space.
vec3 hostNormal(HostGeometry geometry, uint vertex) {
    return geometry.normals.data[vertex];
}

// A unit vector in the mesh's space; w = ±1 is the sign of the bitangent.
vec4 hostTangent(HostGeometry geometry, uint vertex) {
    return geometry.tangents.data[vertex];
}

vec2 hostTexCoord0(HostGeometry geometry, uint vertex) {
    return geometry.texCoords0.data[vertex];
}

vec2 hostTexCoord1(HostGeometry geometry, uint vertex) {
    return geometry.texCoords1.data[vertex];
}

// Linear RGBA.
vec4 hostColor(HostGeometry geometry, uint vertex) {
    return geometry.colors.data[vertex];
}

// One number of a vertex's attributes that packs declare: `channel` counts over all of them, of which a vertex has
// `stride` (Package::attributes()).
float hostAttribute(HostGeometry geometry, uint vertex, uint channel, uint stride) {
    return geometry.attributes.data[stride * vertex + channel];
}
