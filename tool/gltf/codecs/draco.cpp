#include "gltf/codecs/draco.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <draco/compression/config/decoder_options.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#include <draco/metadata/metadata_decoder.h>
#include <optional>
#include <utility>

namespace glint::gltf {

namespace {

constexpr const char* kExportWithoutDraco = "export the scene again, or without Draco compression";

// Regular connectivity whose values are predicted without a residue takes nearly a hundredth of a bit for
// each face. No sensible file comes near this limit.
constexpr std::uint64_t kMaxFacesPerByte = 1ULL << 11;
// The bytes that attributes may take for each byte of the file: 64 bytes for each of half as many points.
constexpr std::uint64_t kMaxAttributeRatio = 1ULL << 16;

struct HeaderClaim {
    std::uint64_t faces = 0;
    std::uint64_t points = 0;  // a lower bound
    // Sets of attributes that have seams of their own. Each has a table of all corners.
    std::uint64_t seamTables = 0;
    bool isSequential = false;
};

draco::DecoderBuffer bufferOf(ByteView bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return buffer;
}

// Reads which amounts of data the header claims, because the library allocates by them before it reads more.
// The layout is that of the Draco bitstream specification 2.2, "Draco Decoder" to "Edgebreaker Connectivity
// Data". Returns nothing if the data have another version, are not a mesh, or are cut short.
std::optional<HeaderClaim> readClaim(ByteView bytes) {
    draco::DecoderBuffer buffer = bufferOf(bytes);
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok() ||
        header.encoder_type != draco::TRIANGULAR_MESH || header.version_major != 2 ||
        header.version_minor != 2 || header.encoder_method > draco::MESH_EDGEBREAKER_ENCODING) {
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
    std::uint8_t seamTables = 0;
    const bool isSequential = header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING;
    if ((!isSequential && !buffer.Decode(&traversal)) || !draco::DecodeVarint(&first, &buffer) ||
        !draco::DecodeVarint(&second, &buffer) || (!isSequential && !buffer.Decode(&seamTables))) {
        return std::nullopt;
    }
    return isSequential ? HeaderClaim{first, second, 0, true} : HeaderClaim{second, first, seamTables, false};
}

// Accounts for the memory that the decoder allocates for attributes before it reads their values. The mesh
// has `packed` bytes.
Status chargeAttributes(Document& document, std::uint64_t needed, std::size_t packed,
                        const std::string& pointer) {
    if (needed / kMaxAttributeRatio > packed) {
        return document.error(
            "draco-size", pointer,
            fmt::format("its {} bytes say they hold {} bytes of attributes", packed, needed),
            kExportWithoutDraco);
    }
    if (!document.unpackedBytes().take(needed)) {
        return document.error("draco-size", pointer, "the scene's compressed meshes unpack to too much",
                              "split the scene, or raise ImportOptions::maxFileBytes");
    }
    return okStatus();
}

Status checkClaim(Document& document, const HeaderClaim& claim, std::size_t packed,
                  const std::string& pointer) {
    // Each point is a corner of at least one face.
    if (claim.faces / kMaxFacesPerByte > packed || claim.points > 3 * claim.faces) {
        return document.error("draco-size", pointer,
                              fmt::format("its {} bytes say they hold {} triangles and {} points", packed,
                                          claim.faces, claim.points),
                              kExportWithoutDraco);
    }
    // A table has a number for each corner.
    const std::uint64_t tables = claim.seamTables * claim.faces * 3 * sizeof(std::uint32_t);
    GLINT_TRY_DO(chargeAttributes(document, tables, packed, pointer));
    return document.chargeVertices(3 * claim.faces, pointer);
}

// Adds a bound to one of the library's two decoders. It checks how much memory the values take, after the
// descriptions of the attributes and before their values are read. Nothing else bounds the number and the
// size of the attributes.
template <typename Decoder>
class BoundedDecoder : public Decoder {
public:
    BoundedDecoder(Document& document, std::size_t packed, const std::string& pointer)
        : document_(document), packed_(packed), pointer_(pointer) {}

    const Status& status() const {
        return status_;
    }

protected:
    bool DecodeAllAttributes() override {
        const draco::PointCloud& mesh = *Decoder::point_cloud();
        std::uint64_t bytesOfPoint = 0;
        for (std::int32_t i = 0; i < mesh.num_attributes(); ++i) {
            const draco::PointAttribute& attribute = *mesh.attribute(i);
            bytesOfPoint += std::uint64_t{attribute.num_components()} *
                            static_cast<std::uint64_t>(draco::DataTypeLength(attribute.data_type()));
        }
        status_ = chargeAttributes(document_, bytesOfPoint * mesh.num_points(), packed_, pointer_);
        return status_.ok() && Decoder::DecodeAllAttributes();
    }

private:
    Document& document_;
    std::size_t packed_;
    const std::string& pointer_;
    Status status_ = okStatus();
};

// Fills `mesh`. If that fails, `error` is the library's message.
template <typename Decoder>
Status decodeMesh(Document& document, ByteView bytes, const std::string& pointer, draco::Mesh& mesh,
                  std::string& error) {
    draco::DecoderBuffer buffer = bufferOf(bytes);
    BoundedDecoder<Decoder> decoder(document, bytes.size(), pointer);
    const draco::Status decoded = decoder.Decode(draco::DecoderOptions(), &buffer, &mesh);
    if (decoder.status().ok() && !decoded.ok()) {
        error = decoded.error_msg_string();
    }
    return decoder.status();
}

// Returns whether the attribute has a type that glTF allows for vertices. Other types mean damage. Boolean
// bytes above 1 must not even be loaded.
bool isVertexType(draco::DataType type) {
    return type == draco::DT_INT8 || type == draco::DT_UINT8 || type == draco::DT_INT16 ||
           type == draco::DT_UINT16 || type == draco::DT_FLOAT32;
}

// Appends each point's value, converted to T, which must be able to hold it. Returns false if a value can't
// be read.
template <typename T>
bool appendValues(const draco::Mesh& mesh, const draco::PointAttribute& attribute, std::size_t components,
                  base::Bytes& bytes) {
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

}  // namespace

DracoMesh::DracoMesh(std::unique_ptr<draco::Mesh> mesh) : mesh_(std::move(mesh)) {}
DracoMesh::DracoMesh(DracoMesh&& other) noexcept = default;
DracoMesh& DracoMesh::operator=(DracoMesh&& other) noexcept = default;
DracoMesh::~DracoMesh() = default;

Result<DracoMesh> DracoMesh::decode(Document& document, const Value& extension, const std::string& pointer) {
    const int view = memberOr(extension, "bufferView", -1);
    GLINT_TRY(const auto bytes, document.bufferView(view));
    const std::optional<HeaderClaim> claim = readClaim(bytes);
    if (!claim) {
        return document.error(
            "draco-decode", pointer,
            "its buffer view holds no Draco mesh of bitstream version 2.2, which glTF asks for",
            kExportWithoutDraco);
    }
    GLINT_TRY_DO(checkClaim(document, *claim, bytes.size(), pointer));
    DracoMesh mesh(std::make_unique<draco::Mesh>());
    std::string problem;
    const auto decodeFrom = claim->isSequential ? decodeMesh<draco::MeshSequentialDecoder>
                                                : decodeMesh<draco::MeshEdgebreakerDecoder>;
    GLINT_TRY_DO(decodeFrom(document, bytes, pointer, *mesh.mesh_, problem));
    if (!problem.empty()) {
        return document.error(
            "draco-decode", pointer,
            fmt::format("/bufferViews/{} can't be decoded: Draco says \"{}\"", view, problem),
            kExportWithoutDraco);
    }
    const std::uint32_t points = mesh.mesh_->num_points();
    mesh.indices_.reserve(std::size_t{3} * mesh.mesh_->num_faces());
    for (std::uint32_t i = 0; i < mesh.mesh_->num_faces(); ++i) {
        for (const draco::PointIndex& corner : mesh.mesh_->face(draco::FaceIndex(i))) {
            if (corner.value() >= points) {
                return document.error("draco-decode", pointer,
                                      fmt::format("triangle {} of /bufferViews/{} uses point {} of {}", i,
                                                  view, corner.value(), points),
                                      kExportWithoutDraco);
            }
            mesh.indices_.push_back(corner.value());
        }
    }
    return mesh;
}

std::size_t DracoMesh::pointCount() const {
    return mesh_->num_points();
}

bool DracoMesh::has(std::uint32_t id) const {
    return mesh_->GetAttributeByUniqueId(id) != nullptr;
}

Result<base::Bytes> DracoMesh::attribute(const Document& document, std::uint32_t id,
                                         const ElementFormat& format, const std::string& pointer) const {
    const draco::PointAttribute* attribute = mesh_->GetAttributeByUniqueId(id);
    if (attribute == nullptr) {
        return document.error("draco-attribute", pointer,
                              fmt::format("is {}, but the Draco data has no such attribute", id),
                              kExportWithoutDraco);
    }
    if (attribute->num_components() != format.components) {
        return document.error("draco-attribute", pointer,
                              fmt::format("the Draco data has {} components, the accessor {}",
                                          attribute->num_components(), format.components),
                              kExportWithoutDraco);
    }
    base::Bytes bytes;
    if (!isVertexType(attribute->data_type()) || !withComponentType(format.componentType, [&](auto zero) {
            return appendValues<decltype(zero)>(*mesh_, *attribute, format.components, bytes);
        })) {
        return document.error("draco-attribute", pointer,
                              "has values in the Draco data that the accessor's component type does not hold",
                              kExportWithoutDraco);
    }
    return bytes;
}

}  // namespace glint::gltf
