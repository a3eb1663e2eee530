// What the first build of a scene that moves and its updates have in common.
#pragma once

#include "scene_motion.h"

#include <span>
#include <vector>

namespace glint {

// Stretches of SceneMotion::timer.
inline constexpr std::uint32_t kDeformStretch = 0;
inline constexpr std::uint32_t kBlasStretch = 1;
inline constexpr std::uint32_t kTlasStretch = 2;
inline constexpr std::uint32_t kStretches = 3;

// What an update does.
struct Decisions {
    std::vector<bool> deformed;  // by instance
    std::vector<BuildAction> blases;
    BuildAction tlas = BuildAction::Keep;
};

// Of the scene's instances, in world space.
std::vector<Box> boxesOf(const SceneMotion& motion, std::span<const InstanceView> instances);

// Instances of the top level as the pose has them; what is flattened or not visible keeps its last place, out
// of sight. Draws follow. Returns whether an instance of the top level has changed.
bool place(GpuScene::State& state, std::span<const InstanceView> instances);

// Records of instances, lights and materials, and the instances of the top level, where the copy starts from.
void stage(const GpuScene::State& state, std::span<const InstanceView> instances,
           std::span<const LightView> lights);

// Everything that the device has to do, with its dependencies before and after.
void recordAll(GpuScene::State& state, VkCommandBuffer commands, const Decisions& decisions);

}  // namespace glint
