// The part of a GpuScene that the renderer sees.
#pragma once

#include "context/device_objects.h"
#include "context/resources.h"
#include "data/acceleration.h"
#include "data/geometry.h"
#include "data/materials.h"
#include "interop/frame.h"
#include "scene/drawn_scene.h"
#include "scene/scene_upload.h"

#include <glint/package.h>
#include <glint/scene.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint {

struct SceneStore;

// The place of a geometry record's positions. Those that follow joints or morph weights are in a buffer of
// their instance, at an offset.
struct GeometryPositions {
    VkDeviceAddress positions = 0;
    std::uint32_t vertexCount = 0;  // of a geometry with vertices of its own; 0 for others
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
};

// The instance and the primitive of a geometry record.
struct GeometryPlace {
    InstanceHandle instance;      // its index is that of SceneView::instances, unless edits have changed it
    std::uint32_t mesh = 0;       // of SceneView::primitives, or the index of a mesh that an edit has added
    std::uint32_t primitive = 0;  // of the mesh
    std::uint32_t shaderId = 0;
};

// The data that the upload took from the package. Another package may replace it if it agrees with the data
// that is on the device and that a package does not contain: vertices, textures and acceleration structures.
struct ScenePackage {
    // An attribute of packs, as it is in the vertices.
    struct Attribute {
        std::string name;
        std::uint32_t channels = 0;
        std::array<float, 4> fallback{};

        friend bool operator==(const Attribute&, const Attribute&) = default;
    };
    // The emission of a material, in packages with emissive lights.
    struct Emission {
        std::array<float, 3> factor{};
        float strength = 1.0F;
        std::uint32_t texture = package::EmissionEntry::kNone;

        friend bool operator==(const Emission&, const Emission&) = default;
    };

    // A primitive some of whose triangles need no alpha test, and the inputs of that decision
    // (alphaInputs()).
    struct Decided {
        std::uint32_t entry = 0;
        std::vector<std::uint8_t> inputs;
    };

    bool isEmpty = false;  // the scene began without anything: kNoPackageScene
    std::string scene;     // name in the package
    std::vector<package::PrimitiveEntry> entries;
    RecordFields fields;
    std::vector<package::TextureEntry> textures;
    std::vector<std::array<float, 2>> texels;  // sizes of the textures
    std::vector<package::SamplerEntry> samplers;
    std::vector<Attribute> attributes;
    bool positionFetch = false;
    std::optional<package::EmissionEntry> emission{};
    std::vector<Emission> emissions;  // by material
    std::vector<Decided> decided;
};

struct GpuScene::State final : DrawnScene {
    explicit State(Context::State& contextState);
    ~State() override;

    Result<PackageFit> fit(const std::shared_ptr<const Package>& other) const override;
    Result<RetiredLot> recordReplacement(const std::shared_ptr<const Package>& other, std::uint32_t index,
                                         VkCommandBuffer commands) override;
    void partBlases() override;

    MemoryPool pool;
    MemoryPool brief;                                   // of what only one recording needs
    std::unique_ptr<SceneUpload> upload;                // null when the device has completed it
    ScenePackage package;                               // the package that draws the scene
    std::array<double, 3> origin{};                     // SceneView::origin, or that of the last MotionView
    std::map<std::uint32_t, DeviceMicromap> micromaps;  // by index into SceneView::primitives
    AccelerationStructure tlas;
    std::vector<DeviceImage> textures;
    std::vector<UniqueSampler> samplers;
    // The number of textures and samplers that the set's layout has; 0: as many as there are.
    std::uint32_t textureRoom = 0;
    std::uint32_t samplerRoom = 0;
    UniqueSetLayout setLayout;
    UniqueDescriptorPool descriptorPool;
    VkDescriptorSet set = VK_NULL_HANDLE;
    std::vector<DrawBatch> batches;
    // The materials to which the host has given values, with these values. A pose may change them.
    std::vector<ChangingMaterial> changing;
    MaterialTable materialLayout;  // without records
    Statistics statistics;
    std::unique_ptr<SceneStore> store;      // the content; null only while it is made
    std::unique_ptr<SceneEditor> editor;    // null if the scene can't be edited
    std::unique_ptr<TextureStream> stream;  // null unless SceneView::streamsTextures
};

// Returns whether instances may move, come or go after the upload.
bool isChanging(const GpuScene::State& state);
// Returns the number of the present arrangement of geometry records, and where the positions of each are; the
// list is empty if no instance has vertices of its own.
std::uint64_t shapeVersion(const GpuScene::State& state);
std::vector<GeometryPositions> geometryPositions(const GpuScene::State& state);
// Returns nothing if no instance has the record.
std::optional<GeometryPlace> placeOf(const GpuScene::State& state, std::uint32_t geometry);

// Returns the records of instances on the device.
const Buffer& instanceRecords(const GpuScene::State& state);
// Sets the addresses and numbers of the scene's records.
void fillScene(const GpuScene::State& state, gpu::FrameConstants& constants);

// Returns how many textures the array of set 0 has.
inline std::uint32_t textureCapacity(const GpuScene::State& state) {
    return state.textureRoom > 0 ? state.textureRoom : static_cast<std::uint32_t>(state.textures.size());
}

Status createSetLayout(GpuScene::State& state);

// The number of textures and samplers in the arrays of set 0, and whether some of them may be absent.
struct SceneSetSize {
    std::uint32_t textures = 1;
    std::uint32_t samplers = 1;
    bool hasRoom = false;
};
// Error "vulkan-call".
Result<UniqueSetLayout> createSceneSetLayout(Context::State& context, const SceneSetSize& size);
// `absent` is bound where a texture has no image or there is no texture.
Result<DescriptorSet> makeSceneSet(const GpuScene::State& state, VkAccelerationStructureKHR tlas,
                                   VkImageView absent);

// --- The package that a scene is drawn with (scene_package.cpp implements its replacement, too) ---

// Returns the data that an upload has taken. `known` may be a scene without tables.
ScenePackage describePackage(const Package& package, const PackageScene& known, const SceneView& scene);

}  // namespace glint
