// Vertex data on the device, and its partition into acceleration structures.
#pragma once

#include "context/resources.h"
#include "context/upload.h"
#include "data/acceleration.h"
#include "data/vertex_format.h"
#include "interop/scene.h"

#include <glint/package.h>
#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace glint {

// The most geometry records of a scene. Custom indices have 24 bits. Packed records of samples have two
// numbers of them that stand for no geometry.
inline constexpr std::uint32_t kMostGeometries = (1U << 24) - 2;

// A primitive's attributes in one buffer. The address of an attribute that it lacks is 0.
struct GpuPrimitive {
    Buffer buffer;
    // The positions from which acceleration structures are built. They are in memory of their own, and needed
    // for the builds alone, if shaders read others (kGeometryPackedPositions).
    Buffer buildInput;
    VkDeviceAddress buildPositions = 0;
    VkDeviceAddress indices = 0;
    VkDeviceAddress positions = 0;
    VkDeviceAddress normals = 0;
    VkDeviceAddress tangents = 0;
    VkDeviceAddress texCoords0 = 0;
    VkDeviceAddress texCoords1 = 0;
    VkDeviceAddress colors = 0;
    VkDeviceAddress attributes = 0;  // of packs, as AttributeEntry describes
    std::uint32_t vertexCount = 0;
    std::uint32_t triangleCount = 0;
    // kGeometryPacked*, kGeometryColors* and kGeometryShortIndices: the compact attributes.
    std::uint32_t forms = 0;
};

// Returns the address of the indices of a triangle.
VkDeviceAddress indicesFrom(const GpuPrimitive& primitive, std::uint32_t triangle);
// Returns the triangles [first, first + count) as a geometry of a BLAS, with the flags of an opaque one.
BlasGeometry blasGeometry(const GpuPrimitive& primitive, std::uint32_t first, std::uint32_t count);

// The settings of the upload of primitives.
struct PrimitiveUpload {
    SceneView::VertexForm form = SceneView::VertexForm::Compact;
    // A primitive with more triangles becomes several geometries, which may begin at any of them.
    std::uint64_t unsplitTriangles = 0;
    MemoryPool* builds = nullptr;  // for GpuPrimitive::buildInput
};

// Returns the values of the package's attributes vertex by vertex; none if the primitive's key reads none.
std::vector<float> joinAttributes(const Package& package, const package::PrimitiveEntry& entry,
                                  const PrimitiveView& view);

// Returns the attributes' values, too, whatever a key reads. If the primitive lacks an attribute, its
// fallback or 0 is used.
std::vector<float> joinAllAttributes(const Package& package, const PrimitiveView& view);

// The parts of a primitive that are uploaded beside the attributes of its view.
struct PrimitiveContent {
    std::span<const std::uint32_t> indices;
    std::span<const float> declared;               // the joined attributes
    std::span<const std::uint32_t> positionWords;  // of packPositions(); empty: the view's positions
};

// Queues the copies in `uploader`. A primitive without triangles gets no buffer. Unless the form is the full
// one, an attribute gets a compact form (vertices/vertex_format.h) if that nearly keeps its values.
// Attributes that joints and morph targets change stay as they are.
Result<GpuPrimitive> uploadPrimitive(Context::State& context, MemoryPool& pool, Uploader& uploader,
                                     const PrimitiveView& view, const PrimitiveContent& content,
                                     const PrimitiveUpload& how);

// Uploads the positions that acceleration structures are built from, for a primitive whose shaders read
// others.
Status uploadBuildInput(Context::State& context, MemoryPool& pool, Uploader& uploader,
                        std::span<const std::array<float, 3>> positions, GpuPrimitive& primitive);

// Gives a record of a geometry what a package says of its primitive.
void takeEntry(const package::PrimitiveEntry& entry, gpu::GeometryRecord& record);
package::KeyWords keyOf(const gpu::GeometryRecord& record);

// Makes the record of a geometry whose addresses `source` has: a primitive, or the view of a host's geometry.
template <typename Source>
gpu::GeometryRecord recordOf(const package::PrimitiveEntry& entry, const Source& source,
                             std::uint32_t instance) {
    gpu::GeometryRecord record{};
    takeEntry(entry, record);
    record.instanceIndex = instance;
    record.indices = source.indices;
    record.positions = source.positions;
    record.normals = source.normals;
    record.tangents = source.tangents;
    record.texCoords0 = source.texCoords0;
    record.texCoords1 = source.texCoords1;
    record.colors = source.colors;
    record.attributes = source.attributes;
    return record;
}

// Makes the record of a geometry: triangles of `primitive` from `firstTriangle` on.
gpu::GeometryRecord makeGeometryRecord(const package::PrimitiveEntry& entry, const GpuPrimitive& primitive,
                                       std::uint32_t firstTriangle, std::uint32_t instance);

// Consecutive triangles of a primitive, which form a geometry of a BLAS.
struct TriangleRange {
    std::uint32_t primitive = 0;  // of the mesh
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // in the BLAS
    std::uint32_t drawn = 0;  // triangles of the raster pass, from `first` on; 0: another geometry draws them
    bool opaque = false;      // every ray stops there, although the material is tested for alpha
};

// The triangles of a mesh that are seen from one side, or those seen from both sides. A part is one BLAS,
// because culling is a property of the BLAS's instances. A mesh above the capacity of a BLAS has several
// parts of a kind. Primitives without triangles are in no part.
struct MeshPart {
    bool doubleSided = false;
    std::vector<TriangleRange> ranges;
};

// The triangles of a primitive whose alpha test was decided. They come in this order; those through which
// every ray passes come last and are in no BLAS, but are drawn.
struct OpacitySplit {
    std::uint32_t tested = 0;
    std::uint32_t opaque = 0;
};

// The properties of a primitive that decide in which parts its triangles are.
struct PartedPrimitive {
    std::uint32_t triangleCount = 0;
    bool doubleSided = false;
    std::optional<OpacitySplit> split{};
};

// Returns the parts of a mesh: single-sided ones first, and those of decided triangles, whose primitives have
// others in other parts, after all others. Pure. The capacity must be at least one triangle and one geometry.
std::vector<MeshPart> partitionMesh(std::span<const PartedPrimitive> primitives,
                                    const BlasCapacity& capacity);

// The primitives of a mesh, as indices [first, end). The primitives are sorted as SceneView::primitives are.
struct PrimitiveRange {
    std::uint32_t first = 0;
    std::uint32_t end = 0;
};
PrimitiveRange primitivesOf(std::span<const PrimitiveView> primitives, std::uint32_t mesh);

// A draw of the raster pass. Its instance i shows the GeometryRecord geometry + i * stride.
struct DrawBatch {
    std::uint32_t geometry = 0;
    std::uint32_t stride = 0;
    std::uint32_t count = 0;
    std::uint32_t vertexCount = 0;
    bool doubleSided = false;
    bool mirrored = false;
};

// Makes an instance of the TLAS. `customIndex` is the index of its first geometry record.
VkAccelerationStructureInstanceKHR makePlaced(bool doubleSided, std::uint32_t customIndex,
                                              const std::array<float, 12>& objectToWorld,
                                              VkDeviceAddress blas);

}  // namespace glint
