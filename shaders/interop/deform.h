// The data of the pass that skins and morphs meshes.
#ifndef GLINT_INTEROP_DEFORM_H
#define GLINT_INTEROP_DEFORM_H

#include "interop/scene.h"

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer DeformedVec3Array { vec3 data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer DeformedVec4Array { vec4 data[]; };
#endif

GLINT_INTEROP_BEGIN

// Threads of a workgroup; each handles one vertex.
GLINT_CONSTANT(kDeformGroupSize, 64u);
// The most workgroups of a dispatch in x before it grows in y: half of the least limit that Vulkan allows.
GLINT_CONSTANT(kMaxDeformGroupsX, 32768u);

// DeformRecord::flags: which attributes the record has.
GLINT_CONSTANT(kDeformNormals, 1u);
GLINT_CONSTANT(kDeformTangents, 2u);
GLINT_CONSTANT(kDeformTargetPositions, 4u);
GLINT_CONSTANT(kDeformTargetNormals, 8u);
GLINT_CONSTANT(kDeformTargetTangents, 16u);

// One primitive of one instance. The address of a missing attribute is 0.
struct DeformRecord {
    uint vertexCount;
    uint targetCount;     // number of morph targets
    uint influenceCount;  // joints that a vertex follows; 0 for none
    uint flags;           // kDeform*
    GLINT_ADDRESS(Vec3Array) positions;  // at rest
    GLINT_ADDRESS(Vec3Array) normals;
    GLINT_ADDRESS(Vec4Array) tangents;
    GLINT_ADDRESS(Vec3Array) targetPositions;  // targetCount * vertexCount, target by target
    GLINT_ADDRESS(Vec3Array) targetNormals;
    GLINT_ADDRESS(Vec3Array) targetTangents;
    GLINT_ADDRESS(FloatArray) targetWeights;  // targetCount
    GLINT_ADDRESS(UintArray) joints;          // influenceCount for each vertex: indices into jointRows
    GLINT_ADDRESS(FloatArray) jointWeights;   // influenceCount for each vertex
    GLINT_ADDRESS(Vec4Array) jointRows;       // three rows for each joint: from the mesh's space to the world
    GLINT_ADDRESS(DeformedVec3Array) deformedPositions;
    GLINT_ADDRESS(DeformedVec3Array) deformedNormals;
    GLINT_ADDRESS(DeformedVec4Array) deformedTangents;
};

GLINT_INTEROP_END

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer DeformArray { DeformRecord data[]; };
#endif

GLINT_INTEROP_BEGIN

struct DeformConstants {
    GLINT_ADDRESS(DeformArray) records;
    uint record;  // the record that this dispatch deforms
    uint pad;
};

GLINT_INTEROP_END
#endif
