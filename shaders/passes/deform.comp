#version 460
// Morphs and skins the vertices of a primitive: positions, normals, tangents.
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#include "interop/deform.h"

layout(push_constant, scalar) uniform Push { DeformConstants pushed; };

layout(local_size_x = kDeformGroupSize) in;

// The weighted mean of the joints' transforms.
struct Blend {
    vec4 rows[3];
};

Blend blendJoints(DeformRecord record, uint vertex) {
    Blend blend = Blend(vec4[3](vec4(0.0), vec4(0.0), vec4(0.0)));
    uint first = vertex * record.influenceCount;
    for (uint i = first; i < first + record.influenceCount; ++i) {
        float weight = record.jointWeights.data[i];
        uint row = 3u * record.joints.data[i];
        if (weight > 0.0) {
            blend.rows[0] += weight * record.jointRows.data[row];
            blend.rows[1] += weight * record.jointRows.data[row + 1u];
            blend.rows[2] += weight * record.jointRows.data[row + 2u];
        }
    }
    return blend;
}

vec3 applyRows(vec4 rows[3], vec4 v) {
    return vec3(dot(rows[0], v), dot(rows[1], v), dot(rows[2], v));
}

// Returns a vector's direction, or `fallback` if it has none or is not a number.
vec3 unitOr(vec3 v, vec3 fallback) {
    vec3 scaled = v / max(max(abs(v.x), abs(v.y)), abs(v.z));
    float squared = dot(scaled, scaled);
    return squared > 0.5 && squared < 4.0 ? scaled * inversesqrt(squared) : fallback;
}

// Transforms by the cofactors of the linear part, with its determinant's sign: the inverse transpose, which is finite
// even if the matrix is singular.
vec3 transformedNormal(vec4 rows[3], vec3 normal) {
    vec3 x = rows[0].xyz;
    vec3 y = rows[1].xyz;
    vec3 z = rows[2].xyz;
    vec3 yz = cross(y, z);
    float side = dot(x, yz) < 0.0 ? -1.0 : 1.0;
    return side * vec3(dot(yz, normal), dot(cross(z, x), normal), dot(cross(x, y), normal));
}

void main() {
    uint vertex = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * kMaxDeformGroupsX * kDeformGroupSize;
    DeformRecord record = pushed.records.data[pushed.record];
    if (vertex >= record.vertexCount) {
        return;
    }
    bool hasNormals = (record.flags & kDeformNormals) != 0u;
    bool hasTangents = (record.flags & kDeformTangents) != 0u;
    vec3 rest = record.positions.data[vertex];
    vec3 position = rest;
    vec3 normal = hasNormals ? record.normals.data[vertex] : vec3(0.0);
    vec4 tangent = hasTangents ? record.tangents.data[vertex] : vec4(0.0);

    for (uint target = 0u; target < record.targetCount; ++target) {
        float weight = record.targetWeights.data[target];
        uint element = target * record.vertexCount + vertex;
        if (weight == 0.0) {
            continue;
        }
        if ((record.flags & kDeformTargetPositions) != 0u) {
            position += weight * record.targetPositions.data[element];
        }
        if ((record.flags & kDeformTargetNormals) != 0u) {
            normal += weight * record.targetNormals.data[element];
        }
        if ((record.flags & kDeformTargetTangents) != 0u) {
            tangent.xyz += weight * record.targetTangents.data[element];
        }
    }
    if (record.influenceCount > 0u) {
        Blend blend = blendJoints(record, vertex);
        position = applyRows(blend.rows, vec4(position, 1.0));
        normal = transformedNormal(blend.rows, normal);
        tangent.xyz = applyRows(blend.rows, vec4(tangent.xyz, 0.0));
    }

    // A position that is not a number would make a triangle inactive, which a refit must not change.
    bool isFinite = all(lessThanEqual(abs(position), vec3(3.0e38)));
    record.deformedPositions.data[vertex] = isFinite ? position : rest;
    if (hasNormals) {
        record.deformedNormals.data[vertex] = unitOr(normal, record.normals.data[vertex]);
    }
    if (hasTangents) {
        vec4 base = record.tangents.data[vertex];
        record.deformedTangents.data[vertex] = vec4(unitOr(tangent.xyz, base.xyz), base.w);
    }
}
