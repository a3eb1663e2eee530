// The state that the engine keeps between frames, and the constants of its shaders. gpu_resources.cpp makes
// it, glint_side.cpp makes what Glint needs, frame.cpp draws.
#pragma once

#include "frame.h"
#include "pipelines.h"

#include <glint/context.h>
#include <glint/steps.h>

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace engine {

inline constexpr std::uint32_t kInFlight = 2;
inline constexpr std::uint32_t kPushOffset = 16;  // of Glint's push constants: the package's push-offset
inline constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_ALL;
using Vec3 = std::array<float, 3>;

// shaders/engine.glsl has the same structures.
struct GeometryData {
    VkDeviceAddress vertices;
    VkDeviceAddress indices;
    std::uint32_t shaderId, material;
    glint::package::KeyWords key;
    std::uint32_t instance, pad;
};
struct SunData {
    Vec3 direction;
    Vec3 lux;
};
struct FrameData {
    std::array<std::array<float, 4>, 4> worldToClip;
    Vec3 cameraPosition;
    std::uint32_t width;
    Vec3 cameraForward;
    std::uint32_t height;
    Vec3 cameraRight;
    std::uint32_t sunCount;
    Vec3 cameraUp;
    float pixelSpread;
    Vec3 skyZenith;
    std::uint32_t pad;
    Vec3 skyHorizon;
    float anisotropy;
    Vec3 skyGround;
    std::uint32_t compact;
    VkDeviceAddress geometries, transforms, suns, rays, rayCount, answers, weights, colors, textureSizes,
        materials;
};
static_assert(sizeof(FrameData) == 64 + 7 * 16 + 10 * 8);
struct Pushed {
    VkDeviceAddress frame;
    std::uint32_t geometry;
};

// Ends the program with the message of an error.
template <typename T>
T expect(glint::Result<T> result) {
    if (!result) {
        fail(toString(result.error()));
    }
    return std::move(*result);
}

inline void expect(const glint::Status& status) {
    if (!status) {
        fail(toString(status.error()));
    }
}

// Returns the transform of each instance from stored positions, as the file has it.
inline std::vector<std::array<float, 12>> restTransforms(const World& world) {
    std::vector<std::array<float, 12>> stored;
    for (const Instance& instance : world.instances) {
        stored.push_back(storedToWorld(world, instance));
    }
    return stored;
}

// One frame of those in flight.
struct Slot {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    Buffer frame;
    Buffer transforms;
    Buffer instances;  // of the TLAS
    AccelerationStructure tlas;
    VkDescriptorSet worldSet = VK_NULL_HANDLE;  // with that structure
};

struct Engine::State {
    State(Gpu& theGpu, const glint::Package& thePackage, const World& theWorld, const std::string& theShaders,
          const FrameSettings& theSettings)
        : gpu(theGpu), package(thePackage), world(theWorld), shaders(theShaders), settings(theSettings) {}

    Gpu& gpu;
    const glint::Package& package;
    const World& world;
    const std::string& shaders;
    FrameSettings settings;

    std::vector<Buffer> vertices;  // of each geometry of each mesh, in their order
    std::vector<Buffer> indices;
    std::vector<AccelerationStructure> blases;  // of each mesh
    std::vector<std::uint32_t> firstRecords;    // of each instance, in the order of the TLAS
    std::vector<glint::EngineScene::View::Geometry> records;
    std::vector<std::uint32_t> recordIndexCounts;
    std::vector<Image> textures;
    std::vector<VkSampler> samplers;
    Buffer geometryData, suns, textureSizes, rays, rayCount, answers, weights, colors;
    Image seen, depth;
    std::array<Slot, kInFlight> slots;
    std::uint32_t frames = 0;

    VkDescriptorSetLayout imageLayout = VK_NULL_HANDLE, worldLayout = VK_NULL_HANDLE;
    VkDescriptorSet imageSet = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline gbuffer = VK_NULL_HANDLE, compose = VK_NULL_HANDLE;
    std::optional<PrimaryPass> primary;

    std::unique_ptr<glint::Context> context;
    std::unique_ptr<glint::EngineScene> scene;
    std::unique_ptr<glint::RaySteps> steps;

    void buildMeshes();
    void placeInstances();
    void loadTextures();
    void makeBuffers();
    void makeSets();
    void makePipelines();
    void makeSlots();
    void startGlint();
    void writeSlot(std::uint32_t slot, const std::vector<std::array<float, 12>>& stored);
    void recordStructure(VkCommandBuffer commands, Slot& slot);
    std::vector<glint::LightView> lights() const;
    void record(std::uint32_t slot, const std::vector<std::array<float, 12>>& stored);
    void draw(VkCommandBuffer commands, const Slot& slot);
};

}  // namespace engine
