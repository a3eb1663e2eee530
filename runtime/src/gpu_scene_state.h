// What the renderer sees of a GpuScene.
#pragma once

#include "acceleration.h"
#include "draw_batches.h"
#include "geometry.h"
#include "resources.h"
#include "scene_materials.h"
#include "scene_motion.h"
#include "traversal_order.h"

#include <glint/renderer.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace glint {

// Structures that the array of set 0 has room for: the scene, and what a host application adds.
inline constexpr std::uint32_t kTlasCapacity = 4;

// Members are destroyed in reverse: the pool's memory last.
struct GpuScene::State {
    explicit State(Context::State& contextState) : context(contextState), pool(contextState) {}

    Context::State& context;
    MemoryPool pool;
    std::vector<GpuPrimitive> primitives;
    DeformedBuffers deformed;
    std::vector<AccelerationStructure> blases;  // those that are built once
    std::vector<VkDeviceAddress> partBlases;    // by SceneLayout::parts
    // Null where the instances of the top level come as the scene has them.
    std::unique_ptr<InstanceOrder> instanceOrder;
    AccelerationStructure tlas;
    Buffer geometries;
    std::vector<std::uint32_t> shaderIds;  // of the geometry records, in their order
    Buffer instances;
    Buffer materials;
    Buffer lights;
    std::uint32_t lightCount = 0;
    std::vector<DeviceImage> textures;
    std::vector<UniqueSampler> samplers;
    UniqueSetLayout setLayout;
    UniqueDescriptorPool descriptorPool;
    VkDescriptorSet set = VK_NULL_HANDLE;
    std::vector<Draw> draws;  // empty where the scene stays: its batches are enough
    std::vector<DrawBatch> batches;
    // Materials that an update changes, as the device has them. Empty where the scene stays.
    std::vector<ChangingMaterial> changing;
    Statistics statistics;
    std::unique_ptr<SceneMotion> motion;  // null: the scene stays as it is
};

// Layout, pool and set 0, filled from the state's structures, textures and samplers.
Status createSceneSet(GpuScene::State& state);

}  // namespace glint
