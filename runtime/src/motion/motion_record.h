// Functions that the first build of a moving scene shares with its updates.
#pragma once

#include "motion/scene_motion.h"

#include <span>
#include <vector>

namespace glint {

// The stretches that SceneMotion::timer measures.
inline constexpr std::uint32_t kDeformStretch = 0;
inline constexpr std::uint32_t kBlasStretch = 1;
inline constexpr std::uint32_t kTlasStretch = 2;
inline constexpr std::uint32_t kStretches = 3;

// The decisions of an update.
struct Decisions {
    std::vector<bool> deformed;  // indexed by instance
    std::vector<BuildAction> blases;
    BuildAction tlas = BuildAction::Keep;
};

// Returns the boxes of the scene's instances in world space.
std::vector<Box> boxesOf(const SceneMotion& motion, std::span<const InstanceView> instances);

// Places the instances of the TLAS and the draws as the pose says. An instance that is flattened or not
// visible keeps its last place and is hidden. Returns whether an instance of the TLAS has changed.
bool place(GpuScene::State& state, std::span<const InstanceView> instances);

// Writes the records of instances, lights and materials and the instances of the TLAS to the staging buffer,
// from which they are copied.
void stage(GpuScene::State& state, std::span<const InstanceView> instances,
           std::span<const LightView> lights);

// Records all the work of the device, with the dependencies before and after it.
void recordAll(GpuScene::State& state, VkCommandBuffer commands, const Decisions& decisions);

}  // namespace glint
