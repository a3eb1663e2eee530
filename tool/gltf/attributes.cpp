#include "gltf/attributes.h"

#include "gltf/codecs/draco.h"
#include "gltf/document/accessor.h"
#include "gltf/document/validate.h"
#include "gltf/motion/skinning.h"
#include "gltf/triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace glint::gltf {

namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kExportMesh = "export the mesh again";

struct Reader {
    const PrimitiveSource& source;
    Primitive& primitive;
    const DracoMesh* draco = nullptr;  // null for a primitive that is not compressed
    const Json* dracoAttributes = nullptr;

    Document& document() const {
        return source.document;
    }
    std::string pointer(const char* attribute) const {
        return fmt::format("{}/attributes/{}", primitive.pointer, attribute);
    }
};

std::string dracoPointer(const Reader& reader) {
    return fmt::format("{}/extensions/{}", reader.primitive.pointer, kDraco);
}

// In a compressed primitive, an accessor with neither compressed data nor a buffer view would read as zeros.
bool isBare(const Document& document, int accessor) {
    return accessor >= 0 &&
           find(document.json()["accessors"][static_cast<std::size_t>(accessor)], "bufferView") == nullptr;
}

// Reads the attribute's elements from the Draco data.
Result<FloatElements> readPacked(const Reader& reader, const char* attribute, int accessor, std::uint32_t id,
                                 Integers integers) {
    Document& document = reader.document();
    const Result<ElementFormat> format = floatFormat(document, accessor);
    if (!format) {
        return format.error();
    }
    if (Status status = document.chargeVertices(reader.draco->pointCount(), reader.pointer(attribute));
        !status) {
        return status.error();
    }
    const Result<base::Bytes> bytes = reader.draco->attribute(
        document, id, *format, fmt::format("{}/attributes/{}", dracoPointer(reader), attribute));
    if (!bytes) {
        return bytes.error();
    }
    return toFloats(document, accessor, integers, *bytes);
}

Result<FloatElements> readElements(const Reader& reader, const char* attribute, int accessor,
                                   Integers integers) {
    if (reader.draco != nullptr) {
        if (const Json* id = find(*reader.dracoAttributes, attribute)) {
            return readPacked(reader, attribute, accessor, id->get<std::uint32_t>(), integers);
        }
        if (isBare(reader.document(), accessor)) {
            return reader.document().error("attribute-data", reader.pointer(attribute),
                                           "is neither in the Draco data nor in a buffer view", kExportMesh);
        }
    }
    return readFloats(reader.document(), accessor, integers);
}

// Reads an attribute of at least `fewest` and at most `components` components, and fills the missing ones
// with 1. Leaves `values` empty if the primitive lacks the attribute.
template <std::size_t N>
Status readAttribute(const Reader& reader, const char* attribute, std::size_t fewest, Integers integers,
                     std::vector<std::array<float, N>>& values) {
    const int accessor = attributeAccessor(reader.source, attribute);
    if (accessor < 0) {
        return okStatus();
    }
    const Document& document = reader.document();
    const bool isPosition = static_cast<const void*>(&values) == &reader.primitive.positions;
    const std::size_t expected = reader.draco != nullptr ? reader.draco->pointCount()
                                 : isPosition            ? document.accessor(accessor).count
                                                         : reader.primitive.positions.size();
    if (document.accessor(accessor).count != expected) {
        return document.error("attribute-count", reader.pointer(attribute),
                              fmt::format("has {} elements, {} has {}", document.accessor(accessor).count,
                                          reader.draco != nullptr ? "the Draco data" : "POSITION", expected),
                              kExportMesh);
    }
    const Result<FloatElements> elements = readElements(reader, attribute, accessor, integers);
    if (!elements) {
        return elements.error();
    }
    if (elements->components < fewest || elements->components > N) {
        return document.error("attribute-type", reader.pointer(attribute),
                              fmt::format("has {} components, not {}", elements->components, N), kExportMesh);
    }
    std::array<float, N> filled{};
    filled.fill(1.0F);
    values.assign(elements->count, filled);
    for (std::size_t i = 0; i < elements->count; ++i) {
        std::copy_n(&elements->values[i * elements->components], elements->components, values[i].begin());
    }
    return okStatus();
}

Status readColors(const Reader& reader) {
    const int accessor = attributeAccessor(reader.source, "COLOR_0");
    if (accessor < 0) {
        return okStatus();
    }
    const Accessor& source = reader.document().accessor(accessor);
    if (source.componentType != ComponentType::Float && !source.normalized) {
        reader.document().warn("color-normalized", reader.pointer("COLOR_0"),
                               "integer colours are not marked as normalised; they are read as if they were",
                               kExportMesh);
    }
    return readAttribute(reader, "COLOR_0", 3, Integers::Normalized, reader.primitive.colors);
}

bool hasJointNumbers(const Document& document, int accessor) {
    const Accessor& source = document.accessor(accessor);
    return !source.normalized && (source.componentType == ComponentType::UnsignedByte ||
                                  source.componentType == ComponentType::UnsignedShort);
}

Status readInfluences(const Reader& reader) {
    std::vector<InfluenceSet> sets;
    for (int set = 0; set < kInfluenceSets; ++set) {
        const std::string joints = fmt::format("JOINTS_{}", set);
        const std::string weights = fmt::format("WEIGHTS_{}", set);
        const int jointAccessor = attributeAccessor(reader.source, joints.c_str());
        const int weightAccessor = attributeAccessor(reader.source, weights.c_str());
        if (jointAccessor < 0 && weightAccessor < 0) {
            break;
        }
        if (jointAccessor < 0 || weightAccessor < 0) {
            return reader.document().error("skin-attribute", reader.primitive.pointer + "/attributes",
                                           fmt::format("has one of {} and {}, not both", joints, weights),
                                           kExportMesh);
        }
        if (!hasJointNumbers(reader.document(), jointAccessor)) {
            return reader.document().error("attribute-type", reader.pointer(joints.c_str()),
                                           "must have unsigned integers of 8 or 16 bits, not normalised",
                                           kExportMesh);
        }
        InfluenceSet& read = sets.emplace_back();
        if (Status s = readAttribute(reader, joints.c_str(), 4, Integers::AsValues, read.joints); !s) {
            return s;
        }
        if (Status s = readAttribute(reader, weights.c_str(), 4, Integers::Normalized, read.weights); !s) {
            return s;
        }
    }
    const std::string beyond = fmt::format("JOINTS_{}", sets.size());
    if (find(reader.source.json["attributes"], beyond) != nullptr) {
        reader.document().warn(
            "skin-influences", reader.pointer(beyond.c_str()),
            fmt::format("only {} sets of joints are read; the others are left out", sets.size()),
            "export the mesh with fewer joints for each vertex");
    }
    reader.primitive.influences = joinInfluences(reader.document(), reader.primitive.pointer, sets);
    return okStatus();
}

// Reads the attributes that packs declare.
Status readDeclared(const Reader& reader) {
    const Document& document = reader.document();
    for (const materials::VertexAttribute& declared : document.options().materialModel->attributes) {
        const int accessor = attributeAccessor(reader.source, declared.gltf.c_str());
        const bool known = std::ranges::find(reader.primitive.attributes, declared.gltf,
                                             &VertexValues::name) != reader.primitive.attributes.end();
        if (accessor < 0 || known) {
            continue;
        }
        const std::string pointer = reader.pointer(declared.gltf.c_str());
        Result<FloatElements> elements =
            readElements(reader, declared.gltf.c_str(), accessor, Integers::AsValues);
        if (!elements) {
            return elements.error();
        }
        if (elements->count != reader.primitive.positions.size()) {
            return document.error("attribute-count", pointer,
                                  fmt::format("has {} elements, POSITION has {}", elements->count,
                                              reader.primitive.positions.size()),
                                  kExportMesh);
        }
        if (elements->components != static_cast<std::size_t>(declared.channels)) {
            return document.error("attribute-type", pointer,
                                  fmt::format("has {} components; the pack's attribute \"{}\" has {}",
                                              elements->components, declared.name, declared.channels),
                                  "export the mesh again, or correct the declaration");
        }
        reader.primitive.attributes.push_back(
            {declared.gltf, static_cast<std::uint32_t>(declared.channels), std::move(elements->values)});
    }
    return okStatus();
}

Status readAttributes(const Reader& reader) {
    Primitive& primitive = reader.primitive;
    constexpr Integers kValues = Integers::AsValues;
    if (Status s = readAttribute(reader, "POSITION", 3, kValues, primitive.positions); !s) {
        return s;
    }
    if (Status s = readAttribute(reader, "NORMAL", 3, kValues, primitive.normals); !s) {
        return s;
    }
    if (Status s = readAttribute(reader, "TEXCOORD_0", 2, kValues, primitive.texCoords0); !s) {
        return s;
    }
    if (Status s = readAttribute(reader, "TEXCOORD_1", 2, kValues, primitive.texCoords1); !s) {
        return s;
    }
    if (Status s = readColors(reader); !s) {
        return s;
    }
    if (Status s = readInfluences(reader); !s) {
        return s;
    }
    if (Status s = readDeclared(reader); !s) {
        return s;
    }
    if (primitive.normals.empty() && attributeAccessor(reader.source, "TANGENT") >= 0) {
        reader.document().warn("tangent-without-normal", reader.pointer("TANGENT"),
                               "tangents without normals are ignored, as glTF says");
        return okStatus();
    }
    return readAttribute(reader, "TANGENT", 4, kValues, primitive.tangents);
}

Result<std::vector<std::uint32_t>> readOrder(const Reader& reader) {
    Document& document = reader.document();
    const std::size_t vertices = reader.primitive.positions.size();
    const int accessor = indexMember(reader.source.json, "indices");
    if (accessor < 0) {
        std::vector<std::uint32_t> order(vertices);
        std::iota(order.begin(), order.end(), 0U);
        return order;
    }
    Result<IndexElements> indices = readIndices(document, accessor);
    if (!indices) {
        return indices.error();
    }
    const std::string pointer = reader.primitive.pointer + "/indices";
    for (std::size_t i = 0; i < indices->values.size(); ++i) {
        const std::uint32_t index = indices->values[i];
        if (index == indices->restart) {
            return document.error("primitive-restart", pointer,
                                  fmt::format("index {} is the primitive restart value {}", i, index),
                                  "glTF has no primitive restart: export the mesh again");
        }
        if (index >= vertices) {
            return document.error(
                "index-range", pointer,
                fmt::format("index {} is {}, but there are {} vertices", i, index, vertices), kExportMesh);
        }
    }
    return std::move(indices->values);
}

// Draco drops degenerate triangles. Not every exporter corrects the accessor afterwards.
void compareIndexCount(const Reader& reader, bool isList) {
    const int accessor = indexMember(reader.source.json, "indices");
    const std::size_t packed = reader.draco->indices().size();
    if (isList && accessor >= 0 && reader.document().accessor(accessor).count != packed) {
        reader.document().warn(
            "draco-count", reader.primitive.pointer + "/indices",
            fmt::format("has {} elements, the Draco data {}; those of the Draco data are used",
                        reader.document().accessor(accessor).count, packed),
            kExportMesh);
    }
}

}  // namespace

int modeOf(const PrimitiveSource& source) {
    return integerMember(source.json, "mode", static_cast<int>(PrimitiveMode::Triangles));
}

int attributeAccessor(const PrimitiveSource& source, const char* attribute) {
    return indexMember(source.json["attributes"], attribute);
}

Result<std::vector<std::uint32_t>> readVertices(const PrimitiveSource& source, Primitive& primitive,
                                                bool& isList) {
    Reader reader{source, primitive};
    std::optional<DracoMesh> draco;
    if (const Json* extension = findExtension(source.json, kDraco)) {
        Result<DracoMesh> mesh = DracoMesh::decode(source.document, *extension, dracoPointer(reader));
        if (!mesh) {
            return mesh.error();
        }
        draco = std::move(*mesh);
        reader.draco = &*draco;
        reader.dracoAttributes = find(*extension, "attributes");
    }
    if (Status status = readAttributes(reader); !status) {
        return status.error();
    }
    if (!draco) {
        return readOrder(reader);
    }
    compareIndexCount(reader, modeOf(source) == static_cast<int>(PrimitiveMode::Triangles));
    isList = true;
    return draco->indices();
}

}  // namespace glint::gltf
