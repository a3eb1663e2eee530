// What the pass that skins and morphs meshes works on.
#ifndef GLINT_INTEROP_DEFORM_H
#define GLINT_INTEROP_DEFORM_H

#include "interop/scene.h"

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer FloatArray { float data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer DeformedVec3Array { vec3 data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer DeformedVec4Array { vec4 data[]; };
#endif

GLINT_INTEROP_BEGIN

// Threads of a workgroup, one a vertex.
GLINT_CONSTANT(kDeformGroupSize, 64u);
// Workgroups of a dispatch in x before it grows in y: half of the least limit that Vulkan allows.
GLINT_CONSTANT(kMaxDeformGroupsX, 32768u);

// DeformRecord::flags: which attributes it has.
GLINT_CONSTANT(kDeformNormals, 1u);
GLINT_CONSTANT(kDeformTangents, 2u);
GLINT_CONSTANT(kDeformTargetPositions, 4u);
GLINT_CONSTANT(kDeformTargetNormals, 8u);
GLINT_CONSTANT(kDeformTargetTangents, 16u);

// One primitive of one instance. Addresses are 0 where it lacks the attribute.
struct DeformRecord {
    uint vertexCount;
    uint targetCount;     // morph targets
    uint influenceCount;  // joints a vertex follows; 0: none
    uint flags;           // kDeform*
    GLINT_ADDRESS(Vec3) positions;  // at rest
    GLINT_ADDRESS(Vec3) normals;
    GLINT_ADDRESS(Vec4) tangents;
    GLINT_ADDRESS(Vec3) targetPositions;  // targetCount * vertexCount, target by target
    GLINT_ADDRESS(Vec3) targetNormals;
    GLINT_ADDRESS(Vec3) targetTangents;
    GLINT_ADDRESS(Float) targetWeights;  // targetCount
    GLINT_ADDRESS(Uint) joints;          // influenceCount a vertex: into jointRows
    GLINT_ADDRESS(Float) jointWeights;   // likewise
    GLINT_ADDRESS(Vec4) jointRows;       // three rows a joint: from the mesh's space to the world
    GLINT_ADDRESS(DeformedVec3) deformedPositions;
    GLINT_ADDRESS(DeformedVec3) deformedNormals;
    GLINT_ADDRESS(DeformedVec4) deformedTangents;
};

GLINT_INTEROP_END

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer DeformArray { DeformRecord data[]; };
#endif

GLINT_INTEROP_BEGIN

struct DeformConstants {
    GLINT_ADDRESS(Deform) records;
    uint record;  // which of them this dispatch deforms
    uint pad;
};

GLINT_INTEROP_END
#endif
