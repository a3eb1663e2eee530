#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"

layout(location = 0) flat out uint primitive;

void main() {
    GeometryRecord geometry = FRAME.geometries.data[pushed.geometry];
    InstanceRecord instance = FRAME.instances.data[geometry.instanceIndex];
    vec4 p = vec4(geometry.positions.data[geometry.indices.data[gl_VertexIndex]], 1.0);
    vec4 world = vec4(dot(instance.objectToWorld[0], p), dot(instance.objectToWorld[1], p),
                      dot(instance.objectToWorld[2], p), 1.0);
    gl_Position = vec4(dot(FRAME.worldToClip[0], world), dot(FRAME.worldToClip[1], world),
                       dot(FRAME.worldToClip[2], world), dot(FRAME.worldToClip[3], world));
    primitive = gl_VertexIndex / 3u;
}
