// The resources of every pass: descriptor sets, push constants, extensions.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_nonuniform_qualifier : require

#include "interop/frame.h"
#include "generated/scene.glsl"

layout(push_constant, scalar) uniform PushBlock {
    PushConstants pushed;
};

#define GLINT_FRAME pushed.frame.data
// The record of the material of a Hit or a SurfacePoint.
#define GLINT_MATERIAL(hit) GLINT_FRAME.materials.data[(hit).material]

// Returns the seconds that materials may follow.
float frameTime() {
    return GLINT_FRAME.time;
}

layout(set = kSetScene, binding = kBindingTextures) uniform texture2D sceneTextures[];
layout(set = kSetScene, binding = kBindingSamplers) uniform sampler sceneSamplers[];
