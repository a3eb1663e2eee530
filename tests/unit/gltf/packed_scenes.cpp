#include "unit/gltf/packed_scenes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <memory>
#include <meshoptimizer.h>
#include <span>
#include <utility>
#include <webp/encode.h>

namespace glint::test {

namespace {

// Adds an attribute that has one value for each point.
template <typename T>
void addAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType dataType,
                  std::uint32_t id, const std::vector<T>& values) {
    constexpr auto kComponents = static_cast<std::uint8_t>(std::tuple_size_v<T>);
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, kComponents, dataType, false, sizeof(T), 0);
    const int index = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(values.size()));
    for (std::uint32_t i = 0; i < values.size(); ++i) {
        mesh.attribute(index)->SetAttributeValue(draco::AttributeValueIndex(i), values[i].data());
    }
    mesh.attribute(index)->set_unique_id(id);
}

Json vertexAccessor(int view, int componentType, std::size_t count, const char* type, bool normalized) {
    Json accessor{{"componentType", componentType}, {"count", count}, {"type", type}};
    if (view >= 0) {
        accessor["bufferView"] = view;
    }
    if (normalized) {
        accessor["normalized"] = true;
    }
    return accessor;
}

// The positions of a grid.
Json positionAccessor(int view, std::size_t count) {
    Json accessor = vertexAccessor(view, 5126, count, "VEC3", false);
    accessor["min"] = {0, 0, 0};
    accessor["max"] = {kGridCells, kGridCells, 0};
    return accessor;
}

}  // namespace

Grid makeGrid() {
    constexpr std::uint32_t kSide = kGridCells + 1;
    Grid grid;
    for (std::uint32_t y = 0; y < kSide; ++y) {
        for (std::uint32_t x = 0; x < kSide; ++x) {
            grid.positions.push_back({static_cast<float>(x), static_cast<float>(y), 0.0F});
            grid.normals.push_back({0.0F, 0.0F, 1.0F});
            grid.texCoords.push_back({static_cast<std::uint16_t>(x * 65535 / kGridCells),
                                      static_cast<std::uint16_t>(y * 65535 / kGridCells)});
        }
    }
    for (std::uint32_t y = 0; y < kGridCells; ++y) {
        for (std::uint32_t x = 0; x < kGridCells; ++x) {
            const std::uint32_t corner = y * kSide + x;
            for (const std::uint32_t step : {0U, 1U, kSide, 1U, kSide + 1, kSide}) {
                grid.indices.push_back(corner + step);
            }
        }
    }
    return grid;
}

base::Bytes encodeDraco(const Grid& grid, DracoMethod method) {
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(grid.positions.size()));
    for (std::size_t i = 0; i < grid.indices.size(); i += 3) {
        mesh.AddFace({draco::PointIndex(grid.indices[i]), draco::PointIndex(grid.indices[i + 1]),
                      draco::PointIndex(grid.indices[i + 2])});
    }
    addAttribute(mesh, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, kDracoPosition, grid.positions);
    addAttribute(mesh, draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, kDracoNormal, grid.normals);
    addAttribute(mesh, draco::GeometryAttribute::TEX_COORD, draco::DT_UINT16, kDracoTexCoord, grid.texCoords);
    auto metadata = std::make_unique<draco::GeometryMetadata>();
    metadata->AddEntryString("made by", "a test");
    mesh.AddMetadata(std::move(metadata));
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(method == DracoMethod::Sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                                                : draco::MESH_EDGEBREAKER_ENCODING);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeToBuffer(&buffer).ok()) {
        return {};
    }
    return {buffer.data(), buffer.data() + buffer.size()};
}

GltfBuilder dracoScene(DracoMethod method) {
    const Grid grid = makeGrid();
    const base::Bytes packed = encodeDraco(grid, method);
    GltfBuilder builder;
    builder.root["extensionsUsed"] = builder.root["extensionsRequired"] =
        Json::array({"KHR_draco_mesh_compression"});
    const int view = builder.addView(packed.data(), packed.size());
    const std::size_t count = grid.positions.size();
    Json primitive;
    primitive["attributes"]["POSITION"] = builder.append("accessors", positionAccessor(-1, count));
    primitive["attributes"]["NORMAL"] =
        builder.append("accessors", vertexAccessor(-1, 5126, count, "VEC3", false));
    primitive["attributes"]["TEXCOORD_0"] =
        builder.append("accessors", vertexAccessor(-1, 5123, count, "VEC2", true));
    primitive["indices"] =
        builder.append("accessors", vertexAccessor(-1, 5123, grid.indices.size(), "SCALAR", false));
    primitive["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view},
        {"attributes",
         {{"POSITION", kDracoPosition}, {"NORMAL", kDracoNormal}, {"TEXCOORD_0", kDracoTexCoord}}}};
    builder.addMesh(std::move(primitive));
    return builder;
}

void addFallbackBuffer(GltfBuilder& builder, std::size_t bytes) {
    builder.otherBuffers.push_back(
        {{"byteLength", bytes}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
}

int addPackedView(GltfBuilder& builder, const base::Bytes& packed, std::size_t count, std::size_t stride,
                  const std::string& mode, const std::string& filter) {
    const int plain = builder.addView(packed.data(), packed.size());
    Json& view = builder.root["bufferViews"][static_cast<std::size_t>(plain)];
    Json extension{{"buffer", 0},
                   {"byteOffset", view["byteOffset"]},
                   {"byteLength", packed.size()},
                   {"byteStride", stride},
                   {"count", count},
                   {"mode", mode},
                   {"filter", filter}};
    view = {{"buffer", 1}, {"byteLength", count * stride}};
    if (mode == "ATTRIBUTES") {
        view["byteStride"] = stride;
    }
    view["extensions"]["EXT_meshopt_compression"] = std::move(extension);
    return plain;
}

base::Bytes packVertices(const void* vertices, std::size_t count, std::size_t stride) {
    base::Bytes packed(meshopt_encodeVertexBufferBound(count, stride));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), vertices, count, stride));
    return packed;
}

namespace {

// The deltas of one channel of four bytes, by byte.
using DeltaPlanes = std::array<base::Bytes, 4>;

// KHR_meshopt_compression: modes 0 and 1 are differences of bytes and of words, with the sign in the lowest
// bit; mode 2 is an exclusive or, turned to the left.
DeltaPlanes deltasOf(const std::uint8_t* vertices, std::size_t count, std::size_t stride, unsigned mode,
                     std::uint32_t& last) {
    DeltaPlanes planes;
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t value = 0;
        std::memcpy(&value, vertices + i * stride, sizeof value);
        std::uint32_t delta = std::rotl(value ^ last, static_cast<int>(mode >> 4U));
        const unsigned bits = mode == 0 ? 8 : 16;
        if (mode < 2) {
            delta = 0;
            for (unsigned shift = 0; shift < 32; shift += bits) {
                const std::uint32_t mask = (1U << bits) - 1;
                const std::uint32_t difference = ((value >> shift) - (last >> shift)) & mask;
                const bool negative = (difference >> (bits - 1)) != 0;
                delta |= ((negative ? ~(difference << 1U) : difference << 1U) & mask) << shift;
            }
        }
        for (unsigned k = 0; k < 4; ++k) {
            planes[k].push_back(static_cast<std::uint8_t>(delta >> (8 * k)));
        }
        last = value;
    }
    return planes;
}

void appendGroup(const base::Bytes& plane, std::size_t first, unsigned width, base::Bytes& packed) {
    base::Bytes codes(2 * std::size_t{width});
    base::Bytes whole;
    const unsigned sentinel = (1U << width) - 1;
    for (std::size_t i = 0; i < 16 && width > 0; ++i) {
        const unsigned delta = first + i < plane.size() ? plane[first + i] : 0;
        const bool fits = width == 8 || delta < sentinel;
        const std::size_t bit = i * width;
        const std::size_t shift = width == 1 ? bit % 8 : 8 - width - bit % 8;
        codes[bit / 8] = static_cast<std::uint8_t>(codes[bit / 8] | (fits ? delta : sentinel) << shift);
        if (!fits) {
            whole.push_back(static_cast<std::uint8_t>(delta));
        }
    }
    packed.insert(packed.end(), codes.begin(), codes.end());
    packed.insert(packed.end(), whole.begin(), whole.end());
}

// Appends a byte of all elements of a block. Returns its control mode.
unsigned appendPlane(const base::Bytes& plane, std::size_t number, base::Bytes& packed) {
    const auto isZero = [](std::uint8_t delta) { return delta == 0; };
    if (std::ranges::all_of(plane, isZero)) {
        return 2;
    }
    if (number % 3 == 2) {
        packed.insert(packed.end(), plane.begin(), plane.end());
        return 3;
    }
    const unsigned control = number % 3 == 0 ? 0 : 1;
    const std::array<unsigned, 4> widths =
        control == 0 ? std::array{0U, 1U, 2U, 4U} : std::array{1U, 2U, 4U, 8U};
    const std::size_t groups = (plane.size() + 15) / 16;
    const std::size_t headers = packed.size();
    packed.resize(headers + (groups + 3) / 4);
    for (std::size_t i = 0; i < groups; ++i) {
        const auto group = std::span(plane).subspan(16 * i, std::min<std::size_t>(16, plane.size() - 16 * i));
        std::size_t choice = (i + number) % 4;
        choice += widths[choice] == 0 && !std::ranges::all_of(group, isZero) ? 1 : 0;
        std::uint8_t& header = packed[headers + i / 4];
        header = static_cast<std::uint8_t>(header | choice << (2 * (i % 4)));
        appendGroup(plane, 16 * i, widths[choice], packed);
    }
    return control;
}

}  // namespace

base::Bytes packVerticesV1(const void* vertices, std::size_t count, std::size_t stride) {
    const auto* const bytes = static_cast<const std::uint8_t*>(vertices);
    const std::size_t channels = stride / 4;
    const std::size_t mostInBlock = std::min<std::size_t>((8192 / stride) & ~std::size_t{15}, 256);
    const auto modeOf = [](std::size_t channel) {
        return static_cast<std::uint8_t>(channel % 3 < 2 ? channel % 3 : 2 | (3 + channel) % 16 << 4U);
    };
    base::Bytes packed{0xA1};
    std::vector<std::uint32_t> last(channels);
    std::memcpy(last.data(), vertices, stride);
    for (std::size_t first = 0; first < count; first += mostInBlock) {
        const std::size_t controls = packed.size();
        packed.resize(controls + channels);
        for (std::size_t channel = 0; channel < channels; ++channel) {
            const DeltaPlanes planes =
                deltasOf(bytes + first * stride + 4 * channel, std::min(mostInBlock, count - first), stride,
                         modeOf(channel), last[channel]);
            for (std::size_t k = 0; k < 4; ++k) {
                const unsigned control = appendPlane(planes[k], channel + k, packed);
                packed[controls + channel] =
                    static_cast<std::uint8_t>(packed[controls + channel] | control << (2 * k));
            }
        }
    }
    const std::size_t tail = stride + channels;
    packed.resize(packed.size() + (tail < 24 ? 24 - tail : 0));
    packed.insert(packed.end(), bytes, bytes + stride);
    for (std::size_t channel = 0; channel < channels; ++channel) {
        packed.push_back(modeOf(channel));
    }
    return packed;
}

std::vector<MeshoptVertex> meshoptVertices() {
    constexpr std::size_t kCount = 300;
    std::vector<MeshoptVertex> vertices;
    std::uint32_t noise = 1;
    for (std::size_t i = 0; i < kCount; ++i) {
        noise = noise * 1664525U + 1013904223U;
        const auto step = static_cast<float>(i);
        vertices.push_back({{step * 0.25F, static_cast<float>(noise >> 8U) * 1e-6F, i < 280 ? 1.5F : 2.5F},
                            {step / kCount, std::sqrt(step)},
                            {static_cast<float>(i / 40), -step}});
    }
    return vertices;
}

GltfBuilder meshoptV1Scene() {
    const std::vector<MeshoptVertex> vertices = meshoptVertices();
    const std::size_t count = vertices.size();
    const std::size_t stride = sizeof(MeshoptVertex);
    GltfBuilder builder;
    addFallbackBuffer(builder, count * stride);
    const int view =
        addPackedView(builder, packVerticesV1(vertices.data(), count, stride), count, stride, "ATTRIBUTES");
    Json primitive;
    const auto add = [&](const char* attribute, const char* type, std::size_t offset) {
        Json accessor = vertexAccessor(view, 5126, count, type, false);
        accessor["byteOffset"] = offset;
        primitive["attributes"][attribute] = builder.append("accessors", std::move(accessor));
    };
    add("POSITION", "VEC3", offsetof(MeshoptVertex, position));
    add("TEXCOORD_0", "VEC2", offsetof(MeshoptVertex, texCoord0));
    add("TEXCOORD_1", "VEC2", offsetof(MeshoptVertex, texCoord1));
    builder.addMesh(std::move(primitive));
    return builder;
}

GltfBuilder meshoptScene() {
    meshopt_encodeVertexVersion(0);
    meshopt_encodeIndexVersion(1);
    const Grid grid = makeGrid();
    const std::size_t count = grid.positions.size();
    GltfBuilder builder;
    builder.root["extensionsUsed"] = builder.root["extensionsRequired"] =
        Json::array({"EXT_meshopt_compression", "KHR_mesh_quantization"});
    addFallbackBuffer(builder, 1U << 16);
    Json primitive;

    const int positions =
        addPackedView(builder, packVertices(grid.positions.data(), count, 12), count, 12, "ATTRIBUTES");
    primitive["attributes"]["POSITION"] = builder.append("accessors", positionAccessor(positions, count));

    std::vector<std::array<float, 4>> unit(count, {0.0F, 0.0F, 1.0F, 0.0F});
    base::Bytes octahedral(count * 4);
    meshopt_encodeFilterOct(octahedral.data(), count, 4, 8, unit[0].data());
    const int normals = addPackedView(builder, packVertices(octahedral.data(), count, 4), count, 4,
                                      "ATTRIBUTES", "OCTAHEDRAL");
    primitive["attributes"]["NORMAL"] =
        builder.append("accessors", vertexAccessor(normals, 5120, count, "VEC3", true));

    std::vector<std::array<float, 2>> values;
    for (const auto& position : grid.positions) {
        values.push_back({position[0] / kGridCells, position[1] / kGridCells});
    }
    base::Bytes exponential(count * 8);
    meshopt_encodeFilterExp(exponential.data(), count, 8, 15, values[0].data());
    const int texCoords = addPackedView(builder, packVertices(exponential.data(), count, 8), count, 8,
                                        "ATTRIBUTES", "EXPONENTIAL");
    primitive["attributes"]["TEXCOORD_0"] =
        builder.append("accessors", vertexAccessor(texCoords, 5126, count, "VEC2", false));

    base::Bytes triangles(meshopt_encodeIndexBufferBound(grid.indices.size(), count));
    triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), grid.indices.data(),
                                               grid.indices.size()));
    const int indices = addPackedView(builder, triangles, grid.indices.size(), 2, "TRIANGLES");
    primitive["indices"] =
        builder.append("accessors", vertexAccessor(indices, 5123, grid.indices.size(), "SCALAR", false));
    builder.addMesh(std::move(primitive));
    return builder;
}

base::Bytes encodeWebp(const base::Bytes& rgba8, int width, int height) {
    std::uint8_t* encoded = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(rgba8.data(), width, height, 4 * width, &encoded);
    base::Bytes bytes(encoded, encoded + size);
    WebPFree(encoded);
    return bytes;
}

GltfBuilder webpScene() {
    GltfBuilder builder;
    builder.root["extensionsUsed"] = builder.root["extensionsRequired"] = Json::array({"EXT_texture_webp"});
    const base::Bytes webp = encodeWebp({kWebpPixels.begin(), kWebpPixels.end()}, 2, 1);
    const int view = builder.addView(webp.data(), webp.size());
    builder.append("images", {{"bufferView", view}, {"mimeType", "image/webp"}});
    Json texture;
    texture["extensions"]["EXT_texture_webp"]["source"] = 0;
    builder.append("textures", std::move(texture));
    Json material;
    material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    builder.append("materials", std::move(material));
    builder.addTriangle()["material"] = 0;
    return builder;
}

}  // namespace glint::test
