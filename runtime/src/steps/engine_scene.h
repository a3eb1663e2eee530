// The part of an EngineScene that the steps see.
#pragma once

#include "context/context.h"
#include "context/resources.h"
#include "context/upload.h"
#include "scene/gpu_scene_state.h"

#include <glint/steps.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace glint {

// Members are destroyed in reverse order: the pool's memory last.
struct EngineScene::State {
    explicit State(Context::State& contextState)
        : context(contextState), pool(contextState, "engine scene") {}

    Context::State& context;
    MemoryPool pool;
    std::unique_ptr<StagedCopies> upload;  // null when the device has completed it
    Buffer geometries;
    Buffer instances;
    Buffer previousInstances;
    Buffer materials;
    Buffer lights;
    Buffer firstRecords;
    // The addresses of these buffers, or of those of `shared` as it is now.
    struct Addresses {
        VkDeviceAddress geometries = 0;
        VkDeviceAddress instances = 0;
        VkDeviceAddress previousInstances = 0;
        VkDeviceAddress materials = 0;
        VkDeviceAddress lights = 0;
        VkDeviceAddress firstRecords = 0;
    };
    Addresses addresses() const;
    const GpuScene::State* shared = nullptr;    // the scene whose records these are
    std::uint64_t records = 0;                  // recordsHash()
    std::vector<std::array<float, 12>> placed;  // the transforms of the instances
    std::uint32_t lightsNow() const;
    std::uint32_t lightCount = 0;  // of a scene that is not shared
    std::uint32_t lightCapacity = 0;
    RecordsBy recordsBy = RecordsBy::CustomIndex;
    std::vector<std::uint32_t> shaderIds;  // of the shader binding table's hit records
};

}  // namespace glint
