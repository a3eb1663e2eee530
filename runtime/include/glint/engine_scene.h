// A scene that a host keeps on the device by itself: its vertex buffers, acceleration structures, textures
// and samplers stay where they are. docs/engine.md shows how to use it.
#pragma once

#include <glint/context.h>
#include <glint/gpu_scene.h>
#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace glint {

// One geometry of one instance, which a ray can hit. Addresses are device addresses in the formats that the
// package's shaders read; by default they are tightly packed: three uint32 a triangle, three floats a
// position and a normal, four a tangent and a colour, two a UV. The address of an attribute may be 0 only if
// the package's key of this primitive lacks the attribute.
struct EngineGeometryView {
    std::uint32_t mesh = 0;       // mesh of the package's scene that gives material and key
    std::uint32_t primitive = 0;  // within the mesh
    std::uint32_t instance = 0;   // index into EngineSceneView::instances
    VkDeviceAddress indices = 0;
    VkDeviceAddress positions = 0;
    VkDeviceAddress normals = 0;
    VkDeviceAddress tangents = 0;
    VkDeviceAddress texCoords0 = 0;
    VkDeviceAddress texCoords1 = 0;
    VkDeviceAddress colors = 0;
    VkDeviceAddress attributes = 0;  // of packs: the floats of Package::attributes(), vertex by vertex
    // Bits for a host's own functions (`glint compile --host`), such as the format of its vertices. They are
    // the upper half of GeometryRecord::flags.
    std::uint16_t hostFlags = 0;
};

// A texture of the package's scene (PackageScene::textures) as the host has it.
struct EngineTextureView {
    std::uint32_t index = 0;  // in the host's array of images, Bindings::textures
    std::uint32_t width = 0;  // texels of mip 0
    std::uint32_t height = 0;
};

// A sampler of the package's scene (PackageScene::samplers) as the host has it.
struct EngineSamplerView {
    std::uint32_t index = 0;     // in the host's array of samplers, Bindings::samplers
    float maxAnisotropy = 1.0F;  // of its filter; 1 without
};

// The rule by which the shaders find the geometry of a hit. A geometry's index in EngineSceneView::geometries
// is the number of the instance's first geometry plus the index of the geometry in its BLAS.
enum class RecordsBy : std::uint32_t {
    CustomIndex = 0,       // instanceCustomIndex is the number of the instance's first geometry
    CustomIndexTable = 1,  // firstRecords[instanceCustomIndex] is that number
    InstanceTable = 2,     // firstRecords[place of the instance in the TLAS] is that number
};

struct EngineSceneView {
    std::uint32_t packageScene = 0;  // index of the scene in the package
    std::span<const EngineGeometryView> geometries;
    std::span<const std::array<float, 12>> instances;  // objectToWorld, three rows of four
    std::span<const EngineTextureView> textures;       // one for each of PackageScene::textures
    std::span<const EngineSamplerView> samplers;       // one for each of PackageScene::samplers
    std::span<const LightView> lights;
    RecordsBy recordsBy = RecordsBy::CustomIndex;
    std::span<const std::uint32_t> firstRecords{};
    // For strategies with a pipeline of their own: for each hit record of the shader binding table, the
    // number of the geometry that it is for. A hit's record is instanceShaderBindingTableRecordOffset plus
    // the index of the geometry in its BLAS. If empty, record i is for geometry i.
    std::span<const std::uint32_t> hitRecords{};
};

// The tables that Glint's shaders read of such a scene: a record for each geometry, instance, material and
// light. The Context must outlive it; the host keeps the objects that it points to alive.
class EngineScene {
public:
    // Makes the records, and records their upload. Nothing waits for the device. The requirements of
    // `commands` and `frame`, and when the scene may be used and destroyed, are as in GpuScene::record(). The
    // spans are not kept. Errors: "scene-package" (the package has no such scene or primitive),
    // "engine-scene" (a number is out of range, an attribute that a key needs is missing, or a transform is
    // not finite), "scene-light", and those of memory and Vulkan's calls.
    static Result<std::unique_ptr<EngineScene>> record(Context& context, const Package& package,
                                                       const EngineSceneView& scene, VkCommandBuffer commands,
                                                       std::uint64_t frame);
    // Says that the device has completed all commands of frames up to `frame`, and frees the staging memory.
    void complete(std::uint64_t frame);
    // Records the same into a command buffer of its own, submits it and waits for the device.
    static Result<std::unique_ptr<EngineScene>> create(Context& context, const Package& package,
                                                       const EngineSceneView& scene);
    // The records of a scene that Glint has uploaded, for a host that brings rays of its own and no scene
    // yet. The GpuScene must outlive it, and update() is GpuScene's. Rays are relative to its
    // SceneView::origin. The host binds GpuScene::descriptorSet(). Error "scene-edit-share": the scene can be
    // edited.
    static Result<std::unique_ptr<EngineScene>> share(Context& context, GpuScene& scene);
    ~EngineScene();
    EngineScene(const EngineScene&) = delete;
    EngineScene& operator=(const EngineScene&) = delete;

    // Records new transforms, as many as at creation, and new lights, at most as many. Motion is then
    // measured from the previous transforms. All places are relative to an origin of the engine's choice,
    // which may follow its camera: `originMoved` says in metres how far it has moved since the previous
    // transforms, which then count from the new one. The values are stored in the command buffer, so they
    // need not be kept and any number of frames may be in flight. Errors: "engine-scene" (also for a shared
    // scene), "scene-light".
    Status update(VkCommandBuffer commands, std::span<const std::array<float, 12>> instances,
                  std::span<const LightView> lights, const std::array<double, 3>& originMoved = {});

    // The address of the material records, with the host's numbers of textures and samplers:
    // glintHostMaterials() of the library.
    VkDeviceAddress materials() const;
    std::uint64_t bytes() const;  // on the device

    struct State;  // for the runtime's own sources
    State& state();

private:
    explicit EngineScene(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace glint
