// Vertex data on the device, and what of it forms which acceleration structure.
#pragma once

#include "acceleration.h"
#include "interop/scene.h"
#include "resources.h"
#include "upload.h"

#include <glint/package.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glint {

// A primitive's attributes in one buffer; addresses are 0 where it lacks them.
struct GpuPrimitive {
    Buffer buffer;
    VkDeviceAddress indices = 0;
    VkDeviceAddress positions = 0;
    VkDeviceAddress normals = 0;
    VkDeviceAddress tangents = 0;
    VkDeviceAddress texCoords0 = 0;
    VkDeviceAddress texCoords1 = 0;
    VkDeviceAddress colors = 0;
    std::uint32_t vertexCount = 0;
    std::uint32_t triangleCount = 0;
};

// Copies are queued in `uploader`. Primitives without triangles get no buffer. `ordered`: the indices of each
// primitive, in another order of its triangles; empty: as the primitives have them.
Result<std::vector<GpuPrimitive>> uploadPrimitives(Context::State& context, MemoryPool& pool,
                                                   Uploader& uploader,
                                                   std::span<const PrimitiveView> primitives,
                                                   std::span<const std::vector<std::uint32_t>> ordered = {});

// Deformed vertices of a primitive of an instance; 0 where it lacks the attribute.
struct DeformedVertices {
    VkDeviceAddress positions = 0;
    VkDeviceAddress normals = 0;
    VkDeviceAddress tangents = 0;
};
// By indices into SceneView::instances and primitives. An instance that is here has its own parts.
using DeformedAddresses = std::map<std::pair<std::uint32_t, std::uint32_t>, DeformedVertices>;

// Consecutive triangles of a primitive: a geometry of a BLAS.
struct TriangleRange {
    std::uint32_t primitive = 0;  // index into SceneView::primitives
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

// Triangles of a mesh that are seen from one side, or from both: one BLAS, as culling is a property of its
// instances. A mesh above the capacity of a BLAS has several parts of a kind. Primitives without triangles
// are in no part.
struct MeshPart {
    std::uint32_t mesh = 0;
    bool doubleSided = false;
    std::vector<TriangleRange> ranges;
    std::optional<std::uint32_t> instance{};  // that alone has it, as it deforms the mesh
};

// A part placed in the world: an instance of the TLAS.
struct PartInstance {
    std::uint32_t part = 0;
    std::uint32_t instance = 0;     // index into SceneView::instances
    std::uint32_t customIndex = 0;  // first of its geometry records
};

// A draw of the raster pass.
struct Draw {
    std::uint32_t geometry = 0;  // GeometryRecord index
    std::uint32_t vertexCount = 0;
    bool doubleSided = false;
    bool mirrored = false;
    std::uint32_t instance = 0;   // index into SceneView::instances
    bool hidden = false;          // the instance is flattened or not visible, as long as it is
    std::uint32_t primitive = 0;  // index into SceneView::primitives
};

// Those of a mesh among primitives that are sorted as SceneView::primitives are: indices [first, end).
struct PrimitiveRange {
    std::uint32_t first = 0;
    std::uint32_t end = 0;
};
PrimitiveRange primitivesOf(std::span<const PrimitiveView> primitives, std::uint32_t mesh);

struct SceneLayout {
    std::vector<MeshPart> parts;  // in order of mesh; single-sided first
    std::vector<PartInstance> partInstances;
    std::vector<Draw> draws;  // one a geometry record
    std::vector<gpu::GeometryRecord> geometries;
    std::vector<gpu::InstanceRecord> instances;  // one an instance of the scene
    std::uint64_t triangles = 0;                 // of all instances
};

// Pure. `primitives` are those of uploadPrimitives(); the capacity is at least one triangle. Error
// "scene-geometries": more records than the 24 bits of a custom index can number.
Result<SceneLayout> layOutScene(const PackageScene& known, const SceneView& scene,
                                std::span<const GpuPrimitive> primitives, const BlasCapacity& capacity,
                                const DeformedAddresses& deformed = {});

}  // namespace glint
