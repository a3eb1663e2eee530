#include "data/geometry.h"

#include "data/instance_math.h"
#include "data/vertex_format.h"
#include "package/package.h"

#include <algorithm>
#include <cstring>
#include <map>

namespace glint {
namespace {

// Vectors of four floats get an alignment of their size, which suits every device.
constexpr VkDeviceSize kAttributeAlignment = 16;
constexpr std::size_t kMostShortVertices = std::size_t{1} << 16;

struct AttributeUpload {
    std::span<const std::uint8_t> bytes;
    VkDeviceAddress GpuPrimitive::*address;
    VkDeviceSize offset = 0;
};

// The words of attributes in a compact form. An attribute in another form has none.
struct CompactWords {
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> normals;
    std::vector<std::uint32_t> tangents;
    std::vector<std::uint32_t> texCoords0;
    std::vector<std::uint32_t> texCoords1;
    std::vector<std::uint32_t> colors;
    std::uint32_t forms = 0;
};

// Returns two indices in each word.
std::vector<std::uint32_t> shortIndices(std::span<const std::uint32_t> indices) {
    std::vector<std::uint32_t> words((indices.size() + 1) / 2);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        words[i / 2] |= indices[i] << (i % 2 * 16);
    }
    return words;
}

CompactWords compactWords(const PrimitiveView& view) {
    CompactWords compact;
    const auto keep = [&](std::optional<std::vector<std::uint32_t>> words, std::uint32_t form,
                          std::vector<std::uint32_t>& target) {
        if (words && !words->empty()) {
            target = std::move(*words);
            compact.forms |= form;
        }
    };
    const bool deforms = !view.joints.empty() || !view.targets.empty();
    if (!deforms) {
        keep(packNormals(view.normals), gpu::kGeometryPackedNormals, compact.normals);
        keep(packTangents(view.tangents), gpu::kGeometryPackedTangents, compact.tangents);
    }
    if (!view.texCoords0.empty()) {
        keep(packTexCoords(view.texCoords0), gpu::kGeometryPackedTexCoords0, compact.texCoords0);
    }
    if (!view.texCoords1.empty()) {
        keep(packTexCoords(view.texCoords1), gpu::kGeometryPackedTexCoords1, compact.texCoords1);
    }
    if (std::optional<PackedColors> colors = packColors(view.colors)) {
        keep(std::move(colors->words), colors->bits == 8 ? gpu::kGeometryColors8 : gpu::kGeometryColors16,
             compact.colors);
    }
    return compact;
}

std::vector<AttributeUpload> attributesOf(const PrimitiveView& view, const CompactWords& compact,
                                          const PrimitiveContent& content) {
    const auto either = [](const std::vector<std::uint32_t>& words, const auto& values) {
        return words.empty() ? bytesOf(values) : bytesOf(std::span(words));
    };
    const std::span<const std::uint32_t> positions = content.positionWords;
    return {{either(compact.indices, content.indices), &GpuPrimitive::indices},
            {positions.empty() ? bytesOf(view.positions) : bytesOf(positions), &GpuPrimitive::positions},
            {either(compact.normals, view.normals), &GpuPrimitive::normals},
            {either(compact.tangents, view.tangents), &GpuPrimitive::tangents},
            {either(compact.texCoords0, view.texCoords0), &GpuPrimitive::texCoords0},
            {either(compact.texCoords1, view.texCoords1), &GpuPrimitive::texCoords1},
            {either(compact.colors, view.colors), &GpuPrimitive::colors},
            {bytesOf(content.declared), &GpuPrimitive::attributes}};
}

}  // namespace

Status uploadBuildInput(Context::State& context, MemoryPool& pool, Uploader& uploader,
                        std::span<const std::array<float, 3>> positions, GpuPrimitive& primitive) {
    GLINT_TRY(auto buffer, createBuffer(context, pool, positions.size_bytes(),
                                        VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
                                            VK_BUFFER_USAGE_TRANSFER_DST_BIT));
    primitive.buildPositions = buffer.address;
    primitive.buildInput = std::move(buffer);
    return uploader.copyToBuffer(bytesOf(positions), primitive.buildInput, 0);
}

VkDeviceAddress indicesFrom(const GpuPrimitive& primitive, std::uint32_t triangle) {
    const bool isShort = (primitive.forms & gpu::kGeometryShortIndices) != 0;
    const VkDeviceSize bytes = isShort ? sizeof(std::uint16_t) : sizeof(std::uint32_t);
    return primitive.indices + VkDeviceSize{3} * triangle * bytes;
}

BlasGeometry blasGeometry(const GpuPrimitive& primitive, std::uint32_t first, std::uint32_t count) {
    BlasGeometry geometry;
    geometry.positions = primitive.buildPositions;
    geometry.indices = indicesFrom(primitive, first);
    geometry.shortIndices = (primitive.forms & gpu::kGeometryShortIndices) != 0;
    geometry.vertexCount = primitive.vertexCount;
    geometry.triangleCount = count;
    return geometry;
}

Result<GpuPrimitive> uploadPrimitive(Context::State& context, MemoryPool& pool, Uploader& uploader,
                                     const PrimitiveView& view, const PrimitiveContent& content,
                                     const PrimitiveUpload& how) {
    GpuPrimitive primitive;
    primitive.vertexCount = static_cast<std::uint32_t>(view.positions.size());
    primitive.triangleCount = static_cast<std::uint32_t>(view.indices.size() / 3);
    if (primitive.triangleCount == 0) {
        return primitive;
    }
    CompactWords compact = how.form == SceneView::VertexForm::Full ? CompactWords{} : compactWords(view);
    // Shaders read words, so triangles of 16-bit indices must begin where the primitive does.
    if (how.form != SceneView::VertexForm::Full && primitive.vertexCount <= kMostShortVertices &&
        primitive.triangleCount <= how.unsplitTriangles) {
        compact.indices = shortIndices(content.indices);
        compact.forms |= gpu::kGeometryShortIndices;
    }
    if (!content.positionWords.empty()) {
        compact.forms |= gpu::kGeometryPackedPositions;
    }
    primitive.forms = compact.forms;
    std::vector<AttributeUpload> attributes = attributesOf(view, compact, content);
    VkDeviceSize bytes = 0;
    for (AttributeUpload& attribute : attributes) {
        attribute.offset = bytes;
        bytes += alignUp(attribute.bytes.size(), kAttributeAlignment);
    }
    // The addresses of a buffer are aligned for its usage only. The slack aligns them for attributes too.
    GLINT_TRY(auto buffer,
              createBuffer(context, pool, bytes + kAttributeAlignment,
                           VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT));
    const VkDeviceSize slack = alignUp(buffer.address, kAttributeAlignment) - buffer.address;
    for (const AttributeUpload& attribute : attributes) {
        if (attribute.bytes.empty()) {
            continue;
        }
        const VkDeviceSize offset = slack + attribute.offset;
        primitive.*attribute.address = buffer.address + offset;
        GLINT_TRY_DO(uploader.copyToBuffer(attribute.bytes, buffer, offset));
    }
    primitive.buffer = std::move(buffer);
    primitive.buildPositions = primitive.positions;
    if (!content.positionWords.empty()) {
        GLINT_TRY_DO(uploadBuildInput(context, *how.builds, uploader, view.positions, primitive));
    }
    return primitive;
}

void takeEntry(const package::PrimitiveEntry& entry, gpu::GeometryRecord& record) {
    record.shaderId = entry.shaderId;
    record.materialIndex = entry.materialIndex;
    record.featureLobes = entry.key.lobes;
    record.featureInputs = entry.key.inputs;
    record.featureModel = entry.key.model;
    record.featureOwn = std::bit_cast<gpu::uvec4>(entry.key.own);
    record.flags = (record.flags & ~kEntryFlags) | entry.geometryFlags;
}

package::KeyWords keyOf(const gpu::GeometryRecord& record) {
    return {record.featureLobes, record.featureInputs, record.featureModel,
            std::bit_cast<package::KeyWords::Own>(record.featureOwn)};
}

gpu::GeometryRecord makeGeometryRecord(const package::PrimitiveEntry& entry, const GpuPrimitive& primitive,
                                       std::uint32_t firstTriangle, std::uint32_t instance) {
    gpu::GeometryRecord record = recordOf(entry, primitive, instance);
    record.flags |= primitive.forms;
    record.indices = indicesFrom(primitive, firstTriangle);
    return record;
}

namespace {

// Parts by whether they are seen from both sides.
using PartRanges = std::map<bool, std::vector<std::vector<TriangleRange>>>;

// Appends the triangles of a primitive to `ranges`. It begins a new part when one is full.
void appendRanges(std::uint32_t primitive, std::uint32_t triangleCount, const BlasCapacity& capacity,
                  std::vector<std::vector<TriangleRange>>& ranges) {
    const auto room = [&]() -> std::uint64_t {
        if (ranges.empty() || ranges.back().size() >= capacity.geometries) {
            return 0;
        }
        std::uint64_t held = 0;
        for (const TriangleRange& range : ranges.back()) {
            held += range.count;
        }
        return capacity.triangles - held;
    };
    for (std::uint32_t first = 0; first < triangleCount;) {
        // A primitive that fits into one part is not split.
        if (room() < std::min<std::uint64_t>(triangleCount - first, capacity.triangles)) {
            ranges.emplace_back();
        }
        const auto count = static_cast<std::uint32_t>(std::min<std::uint64_t>(triangleCount - first, room()));
        ranges.back().push_back({primitive, first, count, count});
        first += count;
    }
}

// Appends the range of a primitive, which fits into one part. It begins a new part when one is full.
void appendRange(const TriangleRange& range, const BlasCapacity& capacity,
                 std::vector<std::vector<TriangleRange>>& ranges) {
    appendRanges(range.primitive, range.count, capacity, ranges);
    ranges.back().back() = range;
}

}  // namespace

std::vector<MeshPart> partitionMesh(std::span<const PartedPrimitive> primitives,
                                    const BlasCapacity& capacity) {
    PartRanges members;
    PartRanges decided;
    for (std::uint32_t i = 0; i < primitives.size(); ++i) {
        const auto& [count, doubleSided, split] = primitives[i];
        if (count == 0) {
            continue;
        }
        if (!split) {
            appendRanges(i, count, capacity, members[doubleSided]);
            continue;
        }
        const auto [tested, opaque] = *split;
        if (tested == 0) {
            appendRange({i, 0, opaque, count, true}, capacity, members[doubleSided]);
            continue;
        }
        appendRange({i, 0, tested, count, false}, capacity, members[doubleSided]);
        if (opaque > 0) {
            appendRange({i, tested, opaque, 0, true}, capacity, decided[doubleSided]);
        }
    }
    std::vector<MeshPart> parts;
    for (PartRanges* const from : {&members, &decided}) {
        for (auto& [doubleSided, blases] : *from) {
            for (std::vector<TriangleRange>& ranges : blases) {
                parts.push_back({doubleSided, std::move(ranges)});
            }
        }
    }
    return parts;
}

std::vector<float> joinAttributes(const Package& package, const package::PrimitiveEntry& entry,
                                  const PrimitiveView& view) {
    const std::span<const package::AttributeEntry> known = package.attributes();
    if (std::ranges::none_of(known, [&](const auto& row) { return entry.key.hasAny(row.feature); })) {
        return {};
    }
    return joinAllAttributes(package, view);
}

std::vector<float> joinAllAttributes(const Package& package, const PrimitiveView& view) {
    const std::span<const package::AttributeEntry> known = package.attributes();
    std::size_t stride = 0;
    for (const package::AttributeEntry& row : known) {
        stride += row.channels;
    }
    std::vector<float> joined(stride * view.positions.size());
    std::size_t offset = 0;
    for (const package::AttributeEntry& row : known) {
        const auto given =
            std::ranges::find(view.attributes, package.string(row.name), &PrimitiveView::Attribute::name);
        for (std::size_t vertex = 0; vertex < view.positions.size(); ++vertex) {
            float* const target = &joined[vertex * stride + offset];
            if (given == view.attributes.end()) {
                std::copy_n(row.fallback, row.channels, target);
            } else {
                std::copy_n(&given->values[vertex * row.channels], row.channels, target);
            }
        }
        offset += row.channels;
    }
    return joined;
}

PrimitiveRange primitivesOf(std::span<const PrimitiveView> primitives, std::uint32_t mesh) {
    const auto first = std::ranges::lower_bound(primitives, mesh, {}, &PrimitiveView::mesh);
    const auto end = std::ranges::upper_bound(primitives, mesh, {}, &PrimitiveView::mesh);
    return {static_cast<std::uint32_t>(first - primitives.begin()),
            static_cast<std::uint32_t>(end - primitives.begin())};
}

VkAccelerationStructureInstanceKHR makePlaced(bool doubleSided, std::uint32_t customIndex,
                                              const std::array<float, 12>& objectToWorld,
                                              VkDeviceAddress blas) {
    VkAccelerationStructureInstanceKHR instance{};
    static_assert(sizeof(instance.transform) == sizeof(objectToWorld));
    std::memcpy(&instance.transform, objectToWorld.data(), sizeof(objectToWorld));
    // A custom index has 24 bits and the mask 8. The number of records is below kMostGeometries.
    instance.instanceCustomIndex = customIndex & 0xFFFFFFU;
    // A shader binding table that has hit records has one for each geometry record.
    instance.instanceShaderBindingTableRecordOffset = customIndex & 0xFFFFFFU;
    instance.mask = 0xFF;
    // Facing is determined in object space, so that a mirroring transform changes nothing. The default agrees
    // with glTF: a front is clockwise to a left-handed eye, which is counter-clockwise to a right-handed one.
    instance.flags = doubleSided ? VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR & 0xFFU : 0U;
    instance.accelerationStructureReference = blas;
    return instance;
}

}  // namespace glint
