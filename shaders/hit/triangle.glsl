// The vertices of a triangle, with their attributes. Hosts that know a quicker way than vertex by vertex define these
// functions themselves.
#include "host/geometry.glsl"

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
