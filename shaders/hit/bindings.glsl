// The resources of every pass: descriptor sets, push constants, extensions.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_nonuniform_qualifier : require

#include "generated/scene.glsl"
#include "interop/frame.h"

layout(push_constant, scalar) uniform PushBlock {
    layout(offset = GLINT_BINDING_PUSH_OFFSET) PushConstants pushed;
};

#define GLINT_FRAME pushed.frame.data

layout(set = GLINT_BINDING_SCENE_SET, binding = GLINT_BINDING_TEXTURES) uniform texture2D sceneTextures[];
layout(set = GLINT_BINDING_SCENE_SET, binding = GLINT_BINDING_SAMPLERS) uniform sampler sceneSamplers[];
