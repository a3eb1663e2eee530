// The material of a triangle, and its vertices with their attributes. Hosts that know a quicker way than vertex by
// vertex define the functions of the vertices themselves.
#include "host/geometry.glsl"

// Returns the index of the material's record. Hosts whose triangles have materials of their own define hostMaterial().
uint materialOf(HostGeometry geometry, uint primitive) {
#ifdef GLINT_HOST_PRIMITIVE_MATERIALS
    return hostMaterial(geometry, primitive);
#else
    return geometry.materialIndex;
#endif
}

#ifndef GLINT_HOST_TRIANGLES

uvec3 hostTriangle(HostGeometry geometry, uint primitive) {
    return uvec3(hostVertex(geometry, 3u * primitive), hostVertex(geometry, 3u * primitive + 1u),
                 hostVertex(geometry, 3u * primitive + 2u));
}

void hostPositions(HostGeometry geometry, uvec3 vertices, out vec3 corners[3]) {
    corners = vec3[3](hostPosition(geometry, vertices.x), hostPosition(geometry, vertices.y),
                      hostPosition(geometry, vertices.z));
}

void hostNormals(HostGeometry geometry, uvec3 vertices, out vec3 corners[3]) {
    corners = vec3[3](hostNormal(geometry, vertices.x), hostNormal(geometry, vertices.y),
                      hostNormal(geometry, vertices.z));
}

void hostTangents(HostGeometry geometry, uvec3 vertices, out vec4 corners[3]) {
    corners = vec4[3](hostTangent(geometry, vertices.x), hostTangent(geometry, vertices.y),
                      hostTangent(geometry, vertices.z));
}

void hostTexCoords0(HostGeometry geometry, uvec3 vertices, out vec2 corners[3]) {
    corners = vec2[3](hostTexCoord0(geometry, vertices.x), hostTexCoord0(geometry, vertices.y),
                      hostTexCoord0(geometry, vertices.z));
}

void hostTexCoords1(HostGeometry geometry, uvec3 vertices, out vec2 corners[3]) {
    corners = vec2[3](hostTexCoord1(geometry, vertices.x), hostTexCoord1(geometry, vertices.y),
                      hostTexCoord1(geometry, vertices.z));
}

void hostColors(HostGeometry geometry, uvec3 vertices, out vec4 corners[3]) {
    corners = vec4[3](hostColor(geometry, vertices.x), hostColor(geometry, vertices.y),
                      hostColor(geometry, vertices.z));
}

#endif
