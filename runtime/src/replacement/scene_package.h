// The package that a scene on the device is drawn with, and its replacement by another one of the same scene.
#pragma once

#include "context/resources.h"
#include "scene/geometry.h"
#include "scene/scene_materials.h"

#include <glint/gpu_scene.h>
#include <glint/package.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint {

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

    std::uint64_t number = 0;  // of replacements so far
    std::string scene;         // name in the package
    std::vector<package::PrimitiveEntry> entries;
    std::vector<std::uint32_t> entryOf;          // by geometry record: index into `entries`
    std::vector<std::uint32_t> entryOfUploaded;  // by SceneView::primitives
    std::vector<package::TextureEntry> textures;
    std::vector<std::array<float, 2>> texels;  // sizes of the textures
    std::vector<package::SamplerEntry> samplers;
    std::vector<Attribute> attributes;
    std::vector<ChangingMaterial> hostMaterials;  // of scenes that do not move: those of SceneView::materials
    bool positionFetch = false;
    bool lightTree = false;
    std::optional<package::EmissionEntry> emission{};
    std::vector<Emission> emissions;  // by material
    std::vector<Decided> decided;
    // The memory of GpuScene::State::materials, once it was replaced by a buffer of another size.
    std::shared_ptr<MemoryPool> pool;
};

// Returns the data that an upload has taken. `layout` is that of the scene.
ScenePackage describePackage(const Package& package, const SceneView& scene, const SceneLayout& layout,
                             std::span<const ChangingMaterial> hostMaterials);

// Returns the index of the scene in `package`. Errors: "scene-package" (it has no such scene, or differs in
// data that only an upload can change), "position-fetch", "half-precision".
Result<std::uint32_t> findScene(const GpuScene::State& scene, const Package& package);

// Returns the shader ID of each geometry record in `package`. Requires findScene().
std::vector<std::uint32_t> shaderIdsIn(const GpuScene::State& scene, const PackageScene& known);

// Resources that a replacement leaves behind. Commands that were recorded until then may use them, and those
// of the replacement use them too. Members are destroyed in reverse order.
struct SceneLeftovers {
    std::vector<std::shared_ptr<MemoryPool>> pools;
    std::vector<Buffer> buffers;
};

// Records the copies that bring the scene's records of geometries and materials to `package`, which must run
// before all commands that read them, and makes `scene` one of that package. Values of materials that the
// host has given stay. Requires findScene(), which gave `index`. With an error nothing changes. Errors: those
// of buffers.
Result<SceneLeftovers> recordReplacement(GpuScene::State& scene, const Package& package, std::uint32_t index,
                                         VkCommandBuffer commands);

}  // namespace glint
