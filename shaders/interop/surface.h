// The data that shading reads besides the attributes of a triangle and the values of its material.
#ifndef GLINT_INTEROP_SURFACE_H
#define GLINT_INTEROP_SURFACE_H

#include "interop/types.h"

GLINT_INTEROP_BEGIN

// InstanceRecord::flags
GLINT_CONSTANT(kInstanceMirrored, 1u);  // the determinant of objectToWorld is negative

// One instance of a mesh. Matrices are three rows of four (positions) or three (normals).
struct InstanceRecord {
    vec4 objectToWorld[3];
    vec3 normalToWorld[3];  // cofactors of the linear part times a scale with its determinant's sign: finite even if it
                            // is singular
    uint flags;             // kInstance*
};

// One texture of a material, at the end of its record. uv' = (dot(rowU, (u, v, 1)), dot(rowV, (u, v, 1))), as in KHR_texture_transform.
struct TextureRecord {
    uint textureIndex;  // index into the bindless images
    uint samplerIndex;  // index into the bindless samplers
    uint texCoord;      // 0 or 1
    vec3 rowU;
    vec3 rowV;
    // The next two are 0 in a package, because only the runtime knows image and device.
    vec2 texels;       // size of mip 0
    float anisotropy;  // maximum of the sampler's filter; 1 for none
};

GLINT_INTEROP_END
#endif
