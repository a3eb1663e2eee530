#include "gltf/draco.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#include <draco/metadata/metadata_decoder.h>
#include <optional>
#include <utility>

namespace glint::gltf {

namespace {

constexpr const char* kExport = "export the scene again, or without Draco compression";

// Regular connectivity with values that are predicted without a residue comes near a hundredth of a bit a
// face; nothing sensible comes near this.
constexpr std::uint64_t kMaxFacesPerByte = 1ULL << 11;

struct Claim {
    std::uint64_t faces = 0;
    std::uint64_t points = 0;  // at least
};

draco::DecoderBuffer bufferOf(ByteView bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return buffer;
}

// What the header says is in the data; the library allocates by it before it reads more. Layout: Draco
// bitstream specification 2.2, "Draco Decoder" to "Edgebreaker Connectivity Data"; empty where it is another
// version, no mesh, or cut short.
std::optional<Claim> readClaim(ByteView bytes) {
    draco::DecoderBuffer buffer = bufferOf(bytes);
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok() ||
        header.encoder_type != draco::TRIANGULAR_MESH || header.version_major != 2 ||
        header.version_minor != 2) {
        return std::nullopt;
    }
    buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
    if ((header.flags & METADATA_FLAG_MASK) != 0) {
        draco::GeometryMetadata metadata;
        if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) {
            return std::nullopt;
        }
    }
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    std::uint8_t traversal = 0;
    const bool isSequential = header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING;
    if ((!isSequential && !buffer.Decode(&traversal)) || !draco::DecodeVarint(&first, &buffer) ||
        !draco::DecodeVarint(&second, &buffer)) {
        return std::nullopt;
    }
    return isSequential ? Claim{first, second} : Claim{second, first};
}

Status checkClaim(Document& document, ByteView bytes, const std::string& pointer) {
    const std::optional<Claim> claim = readClaim(bytes);
    if (!claim) {
        return document.error(
            "draco-decode", pointer,
            "its buffer view holds no Draco mesh of bitstream version 2.2, which glTF asks for", kExport);
    }
    // Each point is a corner of a face.
    if (claim->faces / kMaxFacesPerByte > bytes.size() || claim->points > 3 * claim->faces) {
        return document.error("draco-size", pointer,
                              fmt::format("its {} bytes say they hold {} triangles and {} points",
                                          bytes.size(), claim->faces, claim->points),
                              kExport);
    }
    return document.chargeVertices(3 * claim->faces, pointer);
}

// Whether the attribute has a type that glTF gives to vertices. Others are damage; of a boolean, bytes above
// 1 must not even be loaded.
bool isVertexType(draco::DataType type) {
    return type == draco::DT_INT8 || type == draco::DT_UINT8 || type == draco::DT_INT16 ||
           type == draco::DT_UINT16 || type == draco::DT_FLOAT32;
}

// Appends each point's value, converted to T, which must hold it. False where one can't be had.
template <typename T>
bool appendValues(const draco::Mesh& mesh, const draco::PointAttribute& attribute, std::size_t components,
                  Bytes& bytes) {
    std::array<T, 4> value{};
    const std::size_t size = components * sizeof(T);
    bytes.resize(mesh.num_points() * size);
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
        const draco::AttributeValueIndex index = attribute.mapped_index(draco::PointIndex(i));
        if (index.value() >= attribute.size() ||
            !attribute.ConvertValue<T>(index, static_cast<std::int8_t>(components), value.data())) {
            return false;
        }
        std::memcpy(&bytes[i * size], value.data(), size);
    }
    return true;
}

bool appendValuesAs(int componentType, const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                    std::size_t components, Bytes& bytes) {
    switch (componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return appendValues<std::int8_t>(mesh, attribute, components, bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return appendValues<std::uint8_t>(mesh, attribute, components, bytes);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return appendValues<std::int16_t>(mesh, attribute, components, bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return appendValues<std::uint16_t>(mesh, attribute, components, bytes);
        default:
            return appendValues<float>(mesh, attribute, components, bytes);
    }
}

}  // namespace

DracoMesh::DracoMesh(std::unique_ptr<draco::Mesh> mesh) : mesh_(std::move(mesh)) {}
DracoMesh::DracoMesh(DracoMesh&& other) noexcept = default;
DracoMesh& DracoMesh::operator=(DracoMesh&& other) noexcept = default;
DracoMesh::~DracoMesh() = default;

Result<DracoMesh> DracoMesh::decode(Document& document, const Json& extension, const std::string& pointer) {
    const int view = extension["bufferView"].get<int>();
    const Result<ByteView> bytes = document.bufferView(view);
    if (!bytes) {
        return bytes.error();
    }
    if (Status status = checkClaim(document, *bytes, pointer); !status) {
        return status.error();
    }
    draco::DecoderBuffer buffer = bufferOf(*bytes);
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) {
        return document.error("draco-decode", pointer,
                              fmt::format("/bufferViews/{} can't be decoded: Draco says \"{}\"", view,
                                          decoded.status().error_msg_string()),
                              kExport);
    }
    DracoMesh mesh(std::move(decoded).value());
    const std::uint32_t points = mesh.mesh_->num_points();
    mesh.indices_.reserve(std::size_t{3} * mesh.mesh_->num_faces());
    for (std::uint32_t i = 0; i < mesh.mesh_->num_faces(); ++i) {
        for (const draco::PointIndex& corner : mesh.mesh_->face(draco::FaceIndex(i))) {
            if (corner.value() >= points) {
                return document.error("draco-decode", pointer,
                                      fmt::format("triangle {} of /bufferViews/{} uses point {} of {}", i,
                                                  view, corner.value(), points),
                                      kExport);
            }
            mesh.indices_.push_back(corner.value());
        }
    }
    return mesh;
}

std::size_t DracoMesh::pointCount() const {
    return mesh_->num_points();
}

Result<Bytes> DracoMesh::attribute(const Document& document, std::uint32_t id, const ElementFormat& format,
                                   const std::string& pointer) const {
    const draco::PointAttribute* attribute = mesh_->GetAttributeByUniqueId(id);
    if (attribute == nullptr) {
        return document.error("draco-attribute", pointer,
                              fmt::format("is {}, but the Draco data has no such attribute", id), kExport);
    }
    if (attribute->num_components() != format.components) {
        return document.error("draco-attribute", pointer,
                              fmt::format("the Draco data has {} components, the accessor {}",
                                          attribute->num_components(), format.components),
                              kExport);
    }
    Bytes bytes;
    if (!isVertexType(attribute->data_type()) ||
        !appendValuesAs(format.componentType, *mesh_, *attribute, format.components, bytes)) {
        return document.error("draco-attribute", pointer,
                              "has values in the Draco data that the accessor's component type does not hold",
                              kExport);
    }
    return bytes;
}

}  // namespace glint::gltf
