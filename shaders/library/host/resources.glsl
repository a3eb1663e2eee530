// The library has no resources. It calls functions of the shader that includes it.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#include "library/host.glsl"
#include "interop/surface.h"
#include "generated/scene.glsl"
#include "generated/material_record.glsl"
