// Shared by the engine's shaders: its scene by address, in its own formats. world.h and frame.cpp have the same.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_nonuniform_qualifier : require

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Words { uint data[]; };

struct EngineGeometry {
    Words vertices;
    Words indices;
    uint shaderId;
    uint material;
    uint featureLobes;
    uint featureInputs;
    uint featureModel;
    uvec4 featureOwn;
    uint instance;
    uint pad;
};
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Geometries { EngineGeometry data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Transforms { vec4 rows[]; };

struct EngineSun {
    vec3 direction;
    vec3 lux;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Suns { EngineSun data[]; };

// RaySteps::Ray and RaySteps::Radiance of Glint.
struct EngineRay {
    vec3 origin;
    uint slot;
    vec3 direction;
    float coneWidth;
    float coneSpread;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Rays { EngineRay data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Count { uint value; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Colors { vec4 data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer TextureSizes { uvec2 data[]; };

struct EngineFrame {
    vec4 worldToClip[4];
    vec3 cameraPosition;
    uint width;
    vec3 cameraForward;
    uint height;
    vec3 cameraRight;  // to the right edge of the image plane at distance 1
    uint sunCount;
    vec3 cameraUp;     // to its top edge
    float pixelSpread;
    vec3 skyZenith;
    uint pad;
    vec3 skyHorizon;
    float anisotropy;  // of the filter of textures; 1 for none
    vec3 skyGround;
    uint compact;
    Geometries geometries;
    Transforms transforms;
    Suns suns;
    Rays rays;
    Count rayCount;
    Colors answers;   // RaySteps::Radiance
    Colors weights;   // of the ray of each pixel
    Colors colors;    // the picture
    TextureSizes textureSizes;
    uvec2 materials;  // address of Glint's records
};
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer FrameData { EngineFrame data; };

layout(push_constant, scalar) uniform Pushed {
    FrameData frame;
    uint geometry;
} pushed;
#define FRAME pushed.frame.data

const uint kFullWords = 18u;
const uint kCompactWords = 7u;

vec3 octahedral(uint word) {
    vec2 e = max(vec2(ivec2(int(word << 16) >> 16, int(word) >> 16)) / 32767.0, -1.0);
    float z = 1.0 - abs(e.x) - abs(e.y);
    float t = max(-z, 0.0);
    return normalize(vec3(e.x + (e.x >= 0.0 ? -t : t), e.y + (e.y >= 0.0 ? -t : t), z));
}

uint storedIndex(Words indices, uint compact, uint corner) {
    if (compact == 0u) {
        return indices.data[corner];
    }
    uint word = indices.data[corner / 2u];
    return (corner & 1u) == 0u ? word & 0xFFFFu : word >> 16;
}

float storedFloat(Words vertices, uint vertex, uint word) {
    return uintBitsToFloat(vertices.data[kFullWords * vertex + word]);
}

vec3 storedPosition(Words vertices, uint compact, uint vertex) {
    if (compact == 0u) {
        return vec3(storedFloat(vertices, vertex, 0u), storedFloat(vertices, vertex, 1u),
                    storedFloat(vertices, vertex, 2u));
    }
    uint xy = vertices.data[kCompactWords * vertex];
    uint zw = vertices.data[kCompactWords * vertex + 1u];
    return max(vec3(ivec3(int(xy << 16) >> 16, int(xy) >> 16, int(zw << 16) >> 16)) / 32767.0, -1.0);
}

vec3 storedNormal(Words vertices, uint compact, uint vertex) {
    return compact == 0u ? vec3(storedFloat(vertices, vertex, 3u), storedFloat(vertices, vertex, 4u),
                                storedFloat(vertices, vertex, 5u))
                         : octahedral(vertices.data[kCompactWords * vertex + 2u]);
}

vec4 storedTangent(Words vertices, uint compact, uint vertex) {
    if (compact == 0u) {
        return vec4(storedFloat(vertices, vertex, 6u), storedFloat(vertices, vertex, 7u),
                    storedFloat(vertices, vertex, 8u), storedFloat(vertices, vertex, 9u));
    }
    float side = int(vertices.data[kCompactWords * vertex + 1u]) < 0 ? -1.0 : 1.0;
    return vec4(octahedral(vertices.data[kCompactWords * vertex + 3u]), side);
}

vec2 storedTexCoord(Words vertices, uint compact, uint vertex, uint set) {
    return compact == 0u ? vec2(storedFloat(vertices, vertex, 10u + 2u * set), storedFloat(vertices, vertex, 11u + 2u * set))
                         : unpackHalf2x16(vertices.data[kCompactWords * vertex + 4u + set]);
}

vec4 storedColor(Words vertices, uint compact, uint vertex) {
    return compact == 0u ? vec4(storedFloat(vertices, vertex, 14u), storedFloat(vertices, vertex, 15u),
                                storedFloat(vertices, vertex, 16u), storedFloat(vertices, vertex, 17u))
                         : unpackUnorm4x8(vertices.data[kCompactWords * vertex + 6u]);
}

vec3 sky(vec3 direction) {
    vec3 pole = direction.y >= 0.0 ? FRAME.skyZenith : FRAME.skyGround;
    return mix(FRAME.skyHorizon, pole, min(abs(direction.y), 1.0));
}

vec3 cameraDirection(uvec2 pixel) {
    vec2 p = (vec2(pixel) + 0.5) / vec2(FRAME.width, FRAME.height);
    return normalize(FRAME.cameraForward + (2.0 * p.x - 1.0) * FRAME.cameraRight + (1.0 - 2.0 * p.y) * FRAME.cameraUp);
}
