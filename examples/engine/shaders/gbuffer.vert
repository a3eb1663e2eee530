#version 460
#extension GL_GOOGLE_include_directive : require
// Pulls the vertices of one geometry.
#include "engine.glsl"

void main() {
    EngineGeometry geometry = FRAME.geometries.data[pushed.geometry];
    uint vertex = storedIndex(geometry.indices, FRAME.compact, uint(gl_VertexIndex));
    vec4 position = vec4(storedPosition(geometry.vertices, FRAME.compact, vertex), 1.0);
    uint row = 3u * geometry.instance;
    vec4 world = vec4(dot(FRAME.transforms.rows[row], position), dot(FRAME.transforms.rows[row + 1u], position),
                      dot(FRAME.transforms.rows[row + 2u], position), 1.0);
    gl_Position = vec4(dot(FRAME.worldToClip[0], world), dot(FRAME.worldToClip[1], world),
                       dot(FRAME.worldToClip[2], world), dot(FRAME.worldToClip[3], world));
}
