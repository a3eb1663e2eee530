// The records that shaders read of a scene, of a GpuScene or of an engine's own.
#pragma once

#include "data/emitters.h"
#include "data/light_tree.h"
#include "interop/frame.h"
#include "scene/record_store.h"

#include <glint/scene_view.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace glint {

struct SceneRecords {
    explicit SceneRecords(std::size_t materialBytes) : materials(materialBytes) {}

    // Brings the hierarchy of lights and the emissive triangles to these lights, and to the poses of the
    // instances that the triangles name.
    void followLights(std::span<const gpu::LightRecord> records, std::span<const InstanceView> poses,
                      TreeChange change);
    // Notes how many lights there are, when their records have been recorded.
    void countLights();
    // Sets the addresses of the records, and the numbers that countLights() has noted.
    void fill(gpu::FrameConstants& constants) const;

    RecordArray geometries{sizeof(gpu::GeometryRecord)};
    RecordArray instances{sizeof(gpu::InstanceRecord)};
    RecordArray materials;
    RecordArray lights{sizeof(gpu::LightRecord)};
    RecordArray lightNodes{sizeof(gpu::LightNode)};
    RecordArray emitterRecords{sizeof(gpu::EmitterRecord)};
    RecordArray firstEmitters{sizeof(std::uint32_t)};  // of each geometry record
    // The triangles that are lights, in packages with emissive lights. In a scene that neither moves nor is
    // edited they are on the device alone.
    Emitters emitters;
    LightTree lightTree;
    struct Counts {
        std::uint32_t lights = 0;
        std::uint32_t emitters = 0;
        std::uint32_t treeNodes = 0;
        std::uint32_t apart = 0;
    };
    Counts counts;
};

}  // namespace glint
