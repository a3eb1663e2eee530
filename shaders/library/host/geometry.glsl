#include "host/resources.glsl"

struct HostGeometry {
    uint shaderId;
    uint materialIndex;
    uint featureLobes;
    uint featureInputs;
    uint featureModel;
    uvec4 featureOwn;
    uint number;
};

HostGeometry hostGeometry(uint geometry) {
    GlintGeometry given = glintHostGeometry(geometry);
    return HostGeometry(given.shaderId, given.material, given.featureLobes, given.featureInputs,
                        given.featureModel, given.featureOwn, geometry);
}

InstanceRecord hostInstance(HostGeometry geometry) {
    mat4x3 matrix = glintHostObjectToWorld(geometry.number);
    vec3 rows[3] = vec3[3](vec3(matrix[0].x, matrix[1].x, matrix[2].x), vec3(matrix[0].y, matrix[1].y, matrix[2].y),
                           vec3(matrix[0].z, matrix[1].z, matrix[2].z));
    // Only the direction of normals matters. The scale keeps products of small numbers in the range of floats.
    vec3 largest3 = max(max(abs(rows[0]), abs(rows[1])), abs(rows[2]));
    float largest = max(max(largest3.x, largest3.y), largest3.z);
    float scale = largest > 0.0 ? 1.0 / largest : 1.0;
    vec3 cofactors[3] = vec3[3](cross(scale * rows[1], scale * rows[2]), cross(scale * rows[2], scale * rows[0]),
                                cross(scale * rows[0], scale * rows[1]));
    float side = dot(scale * rows[0], cofactors[0]) < 0.0 ? -1.0 : 1.0;
    InstanceRecord instance;
    for (int i = 0; i < 3; ++i) {
        instance.objectToWorld[i] = vec4(rows[i], matrix[3][i]);
        instance.normalToWorld[i] = side * cofactors[i];
    }
    instance.flags = side < 0.0 ? kInstanceMirrored : 0u;
    return instance;
}

uint hostVertex(HostGeometry geometry, uint corner) {
    return glintHostVertex(geometry.number, corner);
}

vec3 hostPosition(HostGeometry geometry, uint vertex) {
    return glintHostPosition(geometry.number, vertex);
}

vec3 hostNormal(HostGeometry geometry, uint vertex) {
    return glintHostNormal(geometry.number, vertex);
}

vec4 hostTangent(HostGeometry geometry, uint vertex) {
    return glintHostTangent(geometry.number, vertex);
}

vec2 hostTexCoord0(HostGeometry geometry, uint vertex) {
    return glintHostTexCoord(geometry.number, vertex, 0u);
}

vec2 hostTexCoord1(HostGeometry geometry, uint vertex) {
    return glintHostTexCoord(geometry.number, vertex, 1u);
}

vec4 hostColor(HostGeometry geometry, uint vertex) {
    return glintHostColor(geometry.number, vertex);
}

float hostAttribute(HostGeometry geometry, uint vertex, uint channel, uint stride) {
    return glintHostAttribute(geometry.number, vertex, channel);
}
