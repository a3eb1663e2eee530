#include "unit/gltf/packed_scenes.h"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <memory>
#include <meshoptimizer.h>
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
