// A scene on the device: geometry, instances, materials, lights.
#ifndef GLINT_INTEROP_SCENE_H
#define GLINT_INTEROP_SCENE_H

#include "interop/lights.h"
#include "interop/models.h"
#include "interop/surface.h"

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer UintArray { uint data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer FloatArray { float data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vec2Array { vec2 data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vec3Array { vec3 data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vec4Array { vec4 data[]; };
#endif

GLINT_INTEROP_BEGIN

// GeometryRecord::flags
GLINT_CONSTANT(kGeometryAlphaTested, 1u);  // non-opaque in the acceleration structure: the candidate must be tested
GLINT_CONSTANT(kGeometryDoubleSided, 2u);  // back faces are visible
GLINT_CONSTANT(kGeometryMasked, 4u);       // the raster pass tests alpha, whether or not hits do
GLINT_CONSTANT(kGeometryBlended, 8u);      // alphaMode BLEND: alpha is compared with a random number, not with the cutoff
GLINT_CONSTANT(kGeometryEmitter, 16u);     // its triangles are lights, in packages with emissive lights
// Shadow rays keep a share of their light on their way through it: non-opaque in the acceleration structure.
GLINT_CONSTANT(kGeometryPassesLight, 32u);
// Compact forms of attributes (host/geometry.glsl). Without its flag an attribute has the form that GeometryRecord
// says.
GLINT_CONSTANT(kGeometryPackedNormals, 64u);     // octahedral, 2 x 16 bits
GLINT_CONSTANT(kGeometryPackedTangents, 128u);   // octahedral, 16 and 15 bits, and the sign
GLINT_CONSTANT(kGeometryPackedTexCoords0, 256u);  // four floats with least and step of u and v, then 2 x 16 bits
GLINT_CONSTANT(kGeometryPackedTexCoords1, 512u);
GLINT_CONSTANT(kGeometryColors8, 1024u);   // 4 x 8 bits, unorm
GLINT_CONSTANT(kGeometryColors16, 2048u);  // 4 x 16 bits, unorm
// Six floats with least and step of x, y and z, then 3 x 16 bits.
GLINT_CONSTANT(kGeometryPackedPositions, 4096u);
GLINT_CONSTANT(kGeometryShortIndices, 8192u);  // 16 bits each
GLINT_CONSTANT(kGeometryHostFlagsShift, 16u);  // the flags from this bit on are the host's own

// The materials of a geometry's triangles, for hosts: each number is added to GeometryRecord::materialIndex.
struct PrimitiveMaterials {
    GLINT_ADDRESS(UintArray) numbers;
};

// One geometry of one instance. A hit finds it at instanceCustomIndex + geometryIndex. The address of a missing
// attribute is 0, and featureInputs then lacks its bit.
struct GeometryRecord {
    uint shaderId;       // number of the case that shades it
    uint materialIndex;  // index into FrameConstants::materials
    uint featureLobes;   // the key: features that every model may have, lobes
    uint featureInputs;  // and inputs
    uint featureModel;   // the model of a pack, as interop/models.h has it; 0: one of glTF's
    uvec4 featureOwn;    // and its own features
    uint instanceIndex;  // index into FrameConstants::instances
    uint flags;          // kGeometry*
    uint primitiveMaterials;  // 0: all triangles have materialIndex; else 1 + the index of a PrimitiveMaterials
    GLINT_ADDRESS(UintArray) indices;     // 3 for each triangle
    GLINT_ADDRESS(Vec3Array) positions;   // object space
    GLINT_ADDRESS(Vec3Array) normals;     // object space, unit vectors
    GLINT_ADDRESS(Vec4Array) tangents;    // object space, unit vectors; w = ±1 is the sign of the bitangent
    GLINT_ADDRESS(Vec2Array) texCoords0;
    GLINT_ADDRESS(Vec2Array) texCoords1;
    GLINT_ADDRESS(Vec4Array) colors;  // linear RGBA
    GLINT_ADDRESS(FloatArray) attributes;  // of packs: the package's, vertex by vertex; 0 if no feature of the key reads any
};

GLINT_INTEROP_END

#ifndef __cplusplus
// MaterialRecord and MaterialArray: a package has the values that its scenes need.
#include "generated/material_record.glsl"
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer PrimitiveMaterialsArray {
    PrimitiveMaterials data[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer GeometryArray { GeometryRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer InstanceArray { InstanceRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer LightArray { LightRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer LightNodeArray { LightNode data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer EmitterArray { EmitterRecord data[]; };
#endif
#endif
