// The draws of a scene's raster pass, which are kept in runs of instances that one call for each primitive
// draws.
#pragma once

#include "data/geometry.h"

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace glint {

// A draw of one instance. It shows one geometry record.
struct Draw {
    std::uint32_t geometry = 0;  // GeometryRecord index
    std::uint32_t vertexCount = 0;
    bool doubleSided = false;
    bool mirrored = false;
    std::uint32_t primitive = 0;  // of the mesh
    std::uint32_t mesh = 0;       // of the scene
};

// A change of an instance takes O(log n) time for n runs.
class DrawRuns {
public:
    // Replaces the draws of an instance. It has none while it is hidden.
    void set(std::uint32_t instance, std::vector<Draw> draws);
    // Returns a batch for each draw of a run, in the order of the instances.
    std::vector<DrawBatch> batches() const;

private:
    // Instances of the same primitives that follow each other, whose geometry records are equally far apart.
    struct Run {
        std::uint32_t count = 1;   // instances
        std::uint32_t stride = 0;  // from the records of an instance to those of the next
        std::vector<Draw> draws;   // of the first
    };
    // Lets no run go on at the instance.
    void cut(std::uint32_t instance);
    // Joins the run at this instance, if there is one, with the run before it, if they are one.
    void join(std::uint32_t instance);

    std::map<std::uint32_t, Run> runs_;  // by their first instance
};

}  // namespace glint
