// What the device knows of a scene: geometry, instances, materials, lights.
#ifndef GLINT_INTEROP_SCENE_H
#define GLINT_INTEROP_SCENE_H

#include "interop/types.h"

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer UintArray { uint data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vec2Array { vec2 data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vec3Array { vec3 data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vec4Array { vec4 data[]; };
#endif

GLINT_INTEROP_BEGIN

// Texture slots of a material, in the order of MaterialRecord::textures.
GLINT_CONSTANT(kTextureBaseColor, 0u);
GLINT_CONSTANT(kTextureMetallicRoughness, 1u);
GLINT_CONSTANT(kTextureNormal, 2u);
GLINT_CONSTANT(kTextureOcclusion, 3u);
GLINT_CONSTANT(kTextureEmissive, 4u);
GLINT_CONSTANT(kTextureSlotCount, 5u);

// GeometryRecord::flags
GLINT_CONSTANT(kGeometryAlphaTested, 1u);  // non-opaque in the acceleration structure: test the candidate
GLINT_CONSTANT(kGeometryDoubleSided, 2u);  // back faces are visible
GLINT_CONSTANT(kGeometryMasked, 4u);       // alphaMode MASK: the raster pass tests alpha, whatever hits do

// InstanceRecord::flags
GLINT_CONSTANT(kInstanceMirrored, 1u);  // the determinant of objectToWorld is negative

// LightRecord::type, in the order of KHR_lights_punctual's text
GLINT_CONSTANT(kLightDirectional, 0u);
GLINT_CONSTANT(kLightPoint, 1u);
GLINT_CONSTANT(kLightSpot, 2u);

// One geometry of one instance. A hit finds it at instanceCustomIndex + geometryIndex.
// Addresses are 0 where the primitive lacks the attribute; featureInputs then lacks the bit.
struct GeometryRecord {
    uint shaderId;       // number of the case that shades it
    uint materialIndex;  // into FrameConstants::materials
    uint featureLobes;   // the key, low word: lobes
    uint featureInputs;  // the key, high word: inputs
    uint instanceIndex;  // into FrameConstants::instances
    uint flags;          // kGeometry*
    GLINT_ADDRESS(Uint) indices;     // 3 a triangle
    GLINT_ADDRESS(Vec3) positions;   // object space
    GLINT_ADDRESS(Vec3) normals;     // object space, unit
    GLINT_ADDRESS(Vec4) tangents;    // object space, unit; w = ±1 is the sign of the bitangent
    GLINT_ADDRESS(Vec2) texCoords0;
    GLINT_ADDRESS(Vec2) texCoords1;
    GLINT_ADDRESS(Vec4) colors;  // linear RGBA
};

// One instance of a mesh. Matrices are three rows of four (positions) or three (normals).
struct InstanceRecord {
    vec4 objectToWorld[3];
    vec3 normalToWorld[3];  // cofactors of the linear part times the sign of its determinant: finite where singular
    uint flags;             // kInstance*
};

// One texture of a material. uv' = (dot(rowU, (u, v, 1)), dot(rowV, (u, v, 1))), as KHR_texture_transform.
struct TextureRecord {
    uint textureIndex;  // into the bindless images
    uint samplerIndex;  // into the bindless samplers
    uint texCoord;      // 0 or 1
    vec3 rowU;
    vec3 rowV;
    vec2 texels;  // size of mip 0; 0 in a package, as only the runtime sees the image
};

// One layout for every permutation; what a key lacks is never read.
struct MaterialRecord {
    vec4 baseColorFactor;  // linear
    vec3 emissiveFactor;   // linear
    float emissiveStrength;
    float metallicFactor;
    float roughnessFactor;
    float normalScale;
    float occlusionStrength;
    float alphaCutoff;
    TextureRecord textures[kTextureSlotCount];
};

// A punctual light in world space (KHR_lights_punctual).
struct LightRecord {
    vec3 position;   // point and spot
    uint type;       // kLight*
    vec3 direction;  // unit, the way the light travels; directional and spot
    float range;     // metres; 0 means unlimited
    vec3 intensity;  // colour times intensity: lux (directional) or candela
    float spotScale;   // 1 / max(0.001, cos(inner) - cos(outer))
    float spotOffset;  // -cos(outer) * spotScale
};

GLINT_INTEROP_END

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer GeometryArray { GeometryRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer InstanceArray { InstanceRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer MaterialArray { MaterialRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer LightArray { LightRecord data[]; };
#endif
#endif
