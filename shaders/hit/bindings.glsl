// The resources of every pass: descriptor sets, push constants, extensions.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_nonuniform_qualifier : require

#include "generated/scene.glsl"
#include "interop/frame.h"

layout(push_constant, scalar) uniform PushBlock {
    layout(offset = GLINT_BINDING_PUSH_OFFSET) PushConstants pushed;
};

#define GLINT_FRAME pushed.frame.data

// Returns whether the list is a host's: the rays of its own, and not those of further bounces.
bool isHostsList() {
#if GLINT_STEPS && GLINT_PATHS
    return GLINT_FRAME.bounce <= 1u;
#else
    return GLINT_STEPS != 0;
#endif
}

// Whether rays of lights and of occlusion are counted (RendererOptions::countsLight). It is a specialisation constant, so
// that drivers leave no code of counters in pipelines that do not count.
layout(constant_id = 1) const bool kCountsLight = false;

layout(set = GLINT_BINDING_SCENE_SET, binding = GLINT_BINDING_TEXTURES) uniform texture2D sceneTextures[];
// The same descriptors, of which each has the view that the declaration of its texture names.
#if GLINT_ARRAY_TEXTURES
layout(set = GLINT_BINDING_SCENE_SET, binding = GLINT_BINDING_TEXTURES) uniform texture2DArray sceneArrays[];
#endif
#if GLINT_CUBE_TEXTURES
layout(set = GLINT_BINDING_SCENE_SET, binding = GLINT_BINDING_TEXTURES) uniform textureCube sceneCubes[];
#endif
#if GLINT_VOLUME_TEXTURES
layout(set = GLINT_BINDING_SCENE_SET, binding = GLINT_BINDING_TEXTURES) uniform texture3D sceneVolumes[];
#endif
layout(set = GLINT_BINDING_SCENE_SET, binding = GLINT_BINDING_SAMPLERS) uniform sampler sceneSamplers[];
