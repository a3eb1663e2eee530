// Reads vertex attributes and the vertex order of one primitive, from accessors or from Draco data.
#include "gltf/document/accessor.h"
#include "gltf/document/validate.h"
#include "gltf/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <draco/compression/config/decoder_options.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#include <draco/metadata/metadata_decoder.h>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glint::gltf {

namespace {

// ---- KHR_draco_mesh_compression ----

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

// A decoded mesh.
struct DracoMesh {
    draco::Mesh mesh;
    std::vector<std::uint32_t> indices;  // a triangle list; each is below the number of points

    // Whether there is an attribute with that unique identifier.
    bool has(std::uint32_t id) const {
        return mesh.GetAttributeByUniqueId(id) != nullptr;
    }
};

// Decodes the data of the extension object, which checkDocument() accepted. `pointer` is that of the
// extension. Errors: "draco-decode" with the decoder's message, "draco-size" if the header claims more than
// its data can hold, "vertex-limit", and those of reading the buffer view.
Result<std::unique_ptr<DracoMesh>> decodeDraco(Document& document, const Value& extension,
                                               const std::string& pointer) {
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
    auto decoded = std::make_unique<DracoMesh>();
    const draco::Mesh& mesh = decoded->mesh;
    std::string problem;
    const auto decodeFrom = claim->isSequential ? decodeMesh<draco::MeshSequentialDecoder>
                                                : decodeMesh<draco::MeshEdgebreakerDecoder>;
    GLINT_TRY_DO(decodeFrom(document, bytes, pointer, decoded->mesh, problem));
    if (!problem.empty()) {
        return document.error(
            "draco-decode", pointer,
            fmt::format("/bufferViews/{} can't be decoded: Draco says \"{}\"", view, problem),
            kExportWithoutDraco);
    }
    const std::uint32_t points = mesh.num_points();
    decoded->indices.reserve(std::size_t{3} * mesh.num_faces());
    for (std::uint32_t i = 0; i < mesh.num_faces(); ++i) {
        for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i))) {
            if (corner.value() >= points) {
                return document.error("draco-decode", pointer,
                                      fmt::format("triangle {} of /bufferViews/{} uses point {} of {}", i,
                                                  view, corner.value(), points),
                                      kExportWithoutDraco);
            }
            decoded->indices.push_back(corner.value());
        }
    }
    return decoded;
}

// Returns the elements of the attribute with that unique identifier, packed tightly in the format of their
// accessor. The error is "draco-attribute" if there is no such attribute or its values have another form.
Result<base::Bytes> unpackAttribute(const Document& document, const draco::Mesh& mesh, std::uint32_t id,
                                    const ElementFormat& format, const std::string& pointer) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
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
            return appendValues<decltype(zero)>(mesh, *attribute, format.components, bytes);
        })) {
        return document.error("draco-attribute", pointer,
                              "has values in the Draco data that the accessor's component type does not hold",
                              kExportWithoutDraco);
    }
    return bytes;
}

// ---- Attributes ----

constexpr const char* kExportMesh = "export the mesh again";

// tinygltf keeps 32 bits of an integer, which are all that an identifier has.
std::uint32_t idOf(const Value& value) {
    return static_cast<std::uint32_t>(value.GetNumberAsInt());
}

bool hasJointNumbers(const Document& document, int accessor) {
    const tinygltf::Accessor& source = document.accessor(accessor);
    return !source.normalized && (source.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                  source.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

class AttributeReader {
public:
    AttributeReader(Document& document, const tinygltf::Primitive& file, Primitive& primitive)
        : document_(document), file_(file), primitive_(primitive) {}

    Result<std::vector<std::uint32_t>> read(bool& isList) {
        if (const Value* const extension = extensionOf(file_.extensions, kDracoExtension)) {
            GLINT_TRY(draco_, decodeDraco(document_, *extension, dracoPointer()));
            dracoIds_ = &extension->Get("attributes").Get<Value::Object>();
            findMissing();
        }
        GLINT_TRY_DO(readAttributes());
        if (!draco_) {
            return readOrder();
        }
        warnOfUnlikeCounts();
        isList = true;
        return std::move(draco_->indices);
    }

private:
    std::string pointerOf(std::string_view attribute) const {
        return fmt::format("{}/attributes/{}", primitive_.pointer, attribute);
    }
    std::string dracoPointer() const {
        return fmt::format("{}/extensions/{}", primitive_.pointer, kDracoExtension);
    }

    // Returns the identifier that the attribute has in the Draco data, or nothing if it is read from its
    // accessor.
    std::optional<std::uint32_t> packedId(const std::string& attribute) const {
        if (draco_ == nullptr) {
            return std::nullopt;
        }
        const auto id = dracoIds_->find(attribute);
        return id == dracoIds_->end() ? std::nullopt : std::optional(idOf(id->second));
    }

    void noteUnlikeCount(const std::string& what, std::size_t count, std::size_t packed) {
        if (count != packed) {
            unlikeCounts_.push_back(fmt::format("{} {} instead of {}", what, count, packed));
        }
    }

    // Returns the accessor of an attribute that the primitive has, or -1. The name is one of kAttributes or
    // of the model's attributes, as only their accessors have been checked.
    int readableAccessor(const std::string& attribute) const {
        return isMissing(attribute) ? -1 : accessorOf(file_.attributes, attribute);
    }
    bool isMissing(const std::string& attribute) const {
        return std::ranges::find(missing_, attribute) != missing_.end();
    }

    // Lists attributes that the Draco data should have and lack. Without POSITION there is nothing to draw,
    // so its lack is an error where it is read.
    void findMissing() {
        for (const auto& [attribute, id] : *dracoIds_) {
            if (attribute != "POSITION" && file_.attributes.contains(attribute) && !draco_->has(idOf(id))) {
                missing_.push_back(attribute);
                document_.warn(
                    "draco-attribute", fmt::format("{}/attributes/{}", dracoPointer(), attribute),
                    fmt::format("is {}, but the Draco data has no such attribute; it is left out", idOf(id)),
                    kExportMesh);
            }
        }
    }

    // Reads the attribute's elements from the Draco data, or else from its accessor.
    Result<FloatElements> readElements(const std::string& attribute, int accessor, Integers integers) {
        const std::optional<std::uint32_t> id = packedId(attribute);
        if (!id) {
            return readFloats(document_, accessor, integers);
        }
        GLINT_TRY(const auto format, floatFormat(document_, accessor));
        GLINT_TRY_DO(document_.chargeVertices(draco_->mesh.num_points(), pointerOf(attribute)));
        noteUnlikeCount(attribute, document_.accessor(accessor).count, draco_->mesh.num_points());
        GLINT_TRY(const auto bytes,
                  unpackAttribute(document_, draco_->mesh, *id, format,
                                  fmt::format("{}/attributes/{}", dracoPointer(), attribute)));
        return toFloats(document_, accessor, integers, bytes);
    }

    // Reads an attribute of at least `fewest` and at most `components` components, and fills the missing ones
    // with 1. Leaves `values` empty if the primitive lacks the attribute.
    template <std::size_t N>
    Status readAttribute(const std::string& attribute, std::size_t fewest, Integers integers,
                         std::vector<std::array<float, N>>& values) {
        const int accessor = readableAccessor(attribute);
        if (accessor < 0) {
            return okStatus();
        }
        const bool isPosition = static_cast<const void*>(&values) == &primitive_.positions;
        const std::size_t expected = draco_ != nullptr ? draco_->mesh.num_points()
                                     : isPosition      ? document_.accessor(accessor).count
                                                       : primitive_.positions.size();
        if (document_.accessor(accessor).count != expected && !packedId(attribute)) {
            return document_.error(
                "attribute-count", pointerOf(attribute),
                fmt::format("has {} elements, {} has {}", document_.accessor(accessor).count,
                            draco_ != nullptr ? "the Draco data" : "POSITION", expected),
                kExportMesh);
        }
        GLINT_TRY(const auto elements, readElements(attribute, accessor, integers));
        return toVectors(document_, elements, fewest, 1.0F, pointerOf(attribute), kExportMesh, values);
    }

    Status readColors() {
        const int accessor = readableAccessor("COLOR_0");
        if (accessor < 0) {
            return okStatus();
        }
        const tinygltf::Accessor& source = document_.accessor(accessor);
        if (source.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !source.normalized) {
            document_.warn("color-normalized", pointerOf("COLOR_0"),
                           "integer colours are not marked as normalised; they are read as if they were",
                           kExportMesh);
        }
        return readAttribute("COLOR_0", 3, Integers::Normalized, primitive_.colors);
    }

    Status readInfluences() {
        std::vector<InfluenceSet> sets;
        for (int set = 0; set < kInfluenceSets; ++set) {
            const std::string joints = fmt::format("JOINTS_{}", set);
            const std::string weights = fmt::format("WEIGHTS_{}", set);
            const int jointAccessor = readableAccessor(joints);
            const int weightAccessor = readableAccessor(weights);
            if ((jointAccessor < 0 && weightAccessor < 0) || isMissing(joints) || isMissing(weights)) {
                break;
            }
            if (jointAccessor < 0 || weightAccessor < 0) {
                return document_.error("skin-attribute", primitive_.pointer + "/attributes",
                                       fmt::format("has one of {} and {}, not both", joints, weights),
                                       kExportMesh);
            }
            if (!hasJointNumbers(document_, jointAccessor)) {
                return document_.error("attribute-type", pointerOf(joints),
                                       "must have unsigned integers of 8 or 16 bits, not normalised",
                                       kExportMesh);
            }
            InfluenceSet& read = sets.emplace_back();
            GLINT_TRY_DO(readAttribute(joints, 4, Integers::AsValues, read.joints));
            GLINT_TRY_DO(readAttribute(weights, 4, Integers::Normalized, read.weights));
        }
        const std::string beyond = fmt::format("JOINTS_{}", sets.size());
        if (file_.attributes.contains(beyond)) {
            document_.warn(
                "skin-influences", pointerOf(beyond),
                fmt::format("only {} sets of joints are read; the others are left out", sets.size()),
                "export the mesh with fewer joints for each vertex");
        }
        primitive_.influences = joinInfluences(document_, primitive_.pointer, sets);
        return okStatus();
    }

    // Reads the attributes that packs declare.
    Status readDeclared() {
        for (const materials::VertexAttribute& declared : document_.options().materialModel->attributes) {
            const int accessor = readableAccessor(declared.gltf);
            const bool known = std::ranges::find(primitive_.attributes, declared.gltf, &VertexValues::name) !=
                               primitive_.attributes.end();
            if (accessor < 0 || known) {
                continue;
            }
            const std::string pointer = pointerOf(declared.gltf);
            GLINT_TRY(auto elements, readElements(declared.gltf, accessor, Integers::AsValues));
            if (elements.count != primitive_.positions.size()) {
                return document_.error("attribute-count", pointer,
                                       fmt::format("has {} elements, POSITION has {}", elements.count,
                                                   primitive_.positions.size()),
                                       kExportMesh);
            }
            if (elements.components != static_cast<std::size_t>(declared.type->channels)) {
                return document_.error(
                    "attribute-type", pointer,
                    fmt::format("has {} components; the pack's attribute \"{}\" has {}", elements.components,
                                declared.name, declared.type->channels),
                    "export the mesh again, or correct the declaration");
            }
            primitive_.attributes.push_back({declared.gltf,
                                             static_cast<std::uint32_t>(declared.type->channels),
                                             std::move(elements.values)});
        }
        return okStatus();
    }

    Status readAttributes() {
        constexpr Integers kValues = Integers::AsValues;
        GLINT_TRY_DO(readAttribute("POSITION", 3, kValues, primitive_.positions));
        GLINT_TRY_DO(readAttribute("NORMAL", 3, kValues, primitive_.normals));
        GLINT_TRY_DO(readAttribute("TEXCOORD_0", 2, kValues, primitive_.texCoords0));
        GLINT_TRY_DO(readAttribute("TEXCOORD_1", 2, kValues, primitive_.texCoords1));
        GLINT_TRY_DO(readColors());
        GLINT_TRY_DO(readInfluences());
        GLINT_TRY_DO(readDeclared());
        if (primitive_.normals.empty() && readableAccessor("TANGENT") >= 0) {
            document_.warn("tangent-without-normal", pointerOf("TANGENT"),
                           "tangents without normals are ignored, as glTF says");
            return okStatus();
        }
        return readAttribute("TANGENT", 4, kValues, primitive_.tangents);
    }

    Result<std::vector<std::uint32_t>> readOrder() {
        const std::size_t vertices = primitive_.positions.size();
        const int accessor = file_.indices;
        if (accessor < 0) {
            std::vector<std::uint32_t> order(vertices);
            std::iota(order.begin(), order.end(), 0U);
            return order;
        }
        GLINT_TRY(auto indices, readIndices(document_, accessor));
        const std::string pointer = primitive_.pointer + "/indices";
        constexpr const char* kExportWithoutRestart = "glTF has no primitive restart: export the mesh again";
        bool hasRestart = false;
        for (std::size_t i = 0; i < indices.values.size(); ++i) {
            const std::uint32_t index = indices.values[i];
            const bool isRestart = index == indices.restart;
            if (index >= vertices && isRestart) {
                return document_.error("primitive-restart", pointer,
                                       fmt::format("index {} is the primitive restart value {}", i, index),
                                       kExportWithoutRestart);
            }
            if (index >= vertices) {
                return document_.error(
                    "index-range", pointer,
                    fmt::format("index {} is {}, but there are {} vertices", i, index, vertices),
                    kExportMesh);
            }
            hasRestart = hasRestart || isRestart;
        }
        if (hasRestart) {
            document_.warn(
                "primitive-restart", pointer,
                fmt::format(
                    "has the primitive restart value {}, which is taken for the vertex of that number",
                    indices.restart),
                kExportWithoutRestart);
        }
        return std::move(indices.values);
    }

    // Draco merges points and drops degenerate triangles. Not every exporter corrects the accessors
    // afterwards.
    void warnOfUnlikeCounts() {
        const int indices = file_.indices;
        if (indices >= 0 && file_.mode == TINYGLTF_MODE_TRIANGLES) {
            noteUnlikeCount("indices", document_.accessor(indices).count, draco_->indices.size());
        }
        if (!unlikeCounts_.empty()) {
            document_.warn(
                "draco-count", primitive_.pointer,
                fmt::format("its accessors have other counts than the Draco data, whose counts are used: {}",
                            fmt::join(unlikeCounts_, ", ")),
                kExportMesh);
        }
    }

    Document& document_;
    const tinygltf::Primitive& file_;
    Primitive& primitive_;
    std::unique_ptr<DracoMesh> draco_;         // null for a primitive that is not compressed
    const Value::Object* dracoIds_ = nullptr;  // by attribute
    std::vector<std::string> unlikeCounts_;    // accessors with other counts than the Draco data
    std::vector<std::string> missing_;         // attributes that the Draco data lack
};

}  // namespace

Result<std::vector<std::uint32_t>> readVertices(Document& document, const tinygltf::Primitive& file,
                                                Primitive& primitive, bool& isList) {
    return AttributeReader(document, file, primitive).read(isList);
}

}  // namespace glint::gltf
