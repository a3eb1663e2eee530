// The part of an EngineScene that the steps see.
#pragma once

#include "context/context.h"
#include "context/resources.h"
#include "data/emitters.h"
#include "data/materials.h"
#include "data/retired.h"
#include "interop/frame.h"
#include "scene/drawn_scene.h"
#include "scene/gpu_scene_state.h"
#include "scene/record_store.h"
#include "scene/scene_records.h"

#include <glint/internal/package_format.h>
#include <glint/scene_view.h>
#include <glint/steps.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint {

struct EngineScene::State final : DrawnScene, SceneRecords {
    explicit State(Context::State& contextState);

    Result<PackageFit> fit(const std::shared_ptr<const Package>& package) const override;
    Result<RetiredLot> recordReplacement(const std::shared_ptr<const Package>& package, std::uint32_t index,
                                         VkCommandBuffer commands) override;

    // Records the changes of the stores, for a frame that is at or after the last one. `leftovers`, if given,
    // gets the resources that are no longer needed when the recording is complete; else complete() for the
    // frame frees them. With an error nothing is recorded, and the changes wait for the next call.
    Status recordChanges(VkCommandBuffer commands, std::uint64_t frame, RetiredLot* leftovers = nullptr);

    // Fills in the records and lights, or those of `shared` as they are now.
    void fill(gpu::FrameConstants& constants) const;
    // The scene whose records are read: this one, or the GpuScene that it shares.
    DrawnScene& drawn();

    GpuScene::State* shared = nullptr;  // null if the records are the scene's own, below

    RecordArray previousInstances{sizeof(gpu::InstanceRecord)};
    RecordArray firstRecords{sizeof(std::uint32_t)};
    RecordArray primitiveMaterials{sizeof(gpu::PrimitiveMaterials)};
    std::vector<RecordArray*> arrays{&geometries,     &instances,    &previousInstances,  &materials,
                                     &lights,         &firstRecords, &primitiveMaterials, &lightNodes,
                                     &emitterRecords, &firstEmitters};
    MemoryPool pool;
    MemoryPool brief;  // of staging memory
    Retired retired;
    std::uint64_t lastFrame = 0;
    EngineScene::View::RecordsBy recordsBy = EngineScene::View::RecordsBy::CustomIndex;
    std::vector<std::array<float, 12>> placed;  // the transforms of the instances
    std::uint32_t leastInstances = 0;           // that the geometries name
    std::vector<LightView> lightViews;

    // The host's content, from which another package makes its records.
    struct Primitive {
        std::uint32_t mesh = 0;
        std::uint32_t primitive = 0;
        std::uint32_t material = EngineScene::View::Geometry::kOfPackage;
        bool ownMaterials = false;                    // each of its triangles names one
        std::shared_ptr<const EmitterShape> shape{};  // View::Geometry::lightCorners; may be null
        TexelMeans texels{};                          // View::Geometry::lightTexels
    };
    struct OwnMaterial {
        std::uint32_t material = 0;
        std::vector<std::uint8_t> record;  // empty: the number is not in use
        bool ownTextures = false;
    };
    struct Host {
        std::vector<Primitive> primitives;  // of each geometry
        std::vector<EngineScene::View::Texture> textures;
        std::vector<EngineScene::View::Sampler> samplers;
        std::vector<std::uint32_t> hitRecords;
        std::vector<OwnMaterial> materials;  // in records with these fields
        RecordFields fields;
        MaterialTable layout;         // of these records, without bytes
        bool trustsTextures = false;  // Package::trustTextures()
        std::uint32_t ofPackage = 0;  // materials of the package, whose records come first
        std::optional<package::EmissionEntry> emission{};  // Package::emission()
        bool knowsDisks = false;                           // Package::diskLights()
    };
    Host host;
    std::string name;  // of the scene in the package
};

}  // namespace glint
