#version 460
// G-buffer: vertices are pulled by address. Each triangle has its own three, so its number needs no geometry shader
// capability.
#include "bsdf/features.glsl"
#include "hit/geometry.glsl"
#include "host/geometry.glsl"
#include "host/material.glsl"

layout(location = 0) flat out uint primitive;
layout(location = 3) flat out uint geometryIndex;
#if GLINT_MASK_STAGES
layout(location = 1) out vec2 barycentrics;
#elif GLINT_MAY_MASK
layout(location = 1) out vec2 texCoord;
layout(location = 2) out float vertexAlpha;
#endif

void main() {
    geometryIndex = pushed.geometry + uint(gl_InstanceIndex) * pushed.geometryStride;
    HostGeometry geometry = hostGeometry(geometryIndex);
    InstanceRecord instance = hostInstance(geometry);
    uint vertex = hostVertex(geometry, uint(gl_VertexIndex));
    vec4 world = vec4(transformPoint(instance.objectToWorld, hostPosition(geometry, vertex)), 1.0);
    gl_Position = vec4(dot(GLINT_FRAME.worldToClip[0], world), dot(GLINT_FRAME.worldToClip[1], world),
                       dot(GLINT_FRAME.worldToClip[2], world), dot(GLINT_FRAME.worldToClip[3], world));
    primitive = gl_VertexIndex / 3u;

#if GLINT_MASK_STAGES
    uint number = uint(gl_VertexIndex) % 3u;
    barycentrics = vec2(number == 1u ? 1.0 : 0.0, number == 2u ? 1.0 : 0.0);
#elif GLINT_MAY_MASK
    texCoord = vec2(0.0);
    vertexAlpha = 1.0;
    if ((geometry.flags & kGeometryMasked) != 0u) {
        TextureRecord record = GLINT_TEXTURE(hostMaterials().data[geometry.materialIndex], GLINT_ROLE_BASE_COLOR_SLOT);
        if ((geometry.featureInputs & GLINT_ROLE_BASE_COLOR_TEXTURE) != 0u) {
            vec2 uv = record.texCoord == 0u ? hostTexCoord0(geometry, vertex) : hostTexCoord1(geometry, vertex);
            texCoord = vec2(dot(record.rowU, vec3(uv, 1.0)), dot(record.rowV, vec3(uv, 1.0)));
        }
        if ((geometry.featureInputs & GLINT_ROLE_VERTEX_COLOR) != 0u) {
            vertexAlpha = hostColor(geometry, vertex).a;
        }
    }
#endif
}
