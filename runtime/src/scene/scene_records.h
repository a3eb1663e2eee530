// The records that shaders read of a scene, of a GpuScene or of an engine's own.
#pragma once

#include "data/emitters.h"
#include "data/light_tree.h"
#include "interop/frame.h"
#include "scene/record_store.h"

#include <glint/scene_view.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glint {

// Lights and instances, by number, that have changed since the hierarchy of lights last followed them: other
// places, other brightness. A number may be there twice.
struct LightMoves {
    std::vector<std::uint32_t> lights;
    std::vector<std::uint32_t> instances;

    bool isEmpty() const {
        return lights.empty() && instances.empty();
    }
};

struct SceneRecords {
    explicit SceneRecords(std::size_t materialBytes) : materials(materialBytes) {}

    // Builds the hierarchy of `lights` and emissive triangles, at these poses of the instances that the
    // triangles name. With `keepsDark` it has leaves for triangles that are dark and may shine later.
    void buildLights(const InstancePoses& poses, bool keepsDark);
    // Gives the hierarchy the bounds of lights and triangles that have moved. Requires the triangles, and the
    // types of the lights, of the last build. Few moves take O(k log n) time, but for the first after a
    // build.
    void refitLights(const LightMoves& moves, const InstancePoses& poses);
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
    LightTree lightTree;  // whose nodes are there alone, too
    struct Counts {
        std::uint32_t lights = 0;
        std::uint32_t emitters = 0;
        std::uint32_t treeNodes = 0;
        std::uint32_t apart = 0;
    };
    Counts counts;
};

}  // namespace glint
