// Reads vertex attributes and the vertex order of one primitive, from accessors or from Draco data.
#include "gltf/codecs/draco.h"
#include "gltf/document/accessor.h"
#include "gltf/document/validate.h"
#include "gltf/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace glint::gltf {

namespace {

constexpr const char* kExportMesh = "export the mesh again";

struct Reader {
    const PrimitiveSource& source;
    Primitive& primitive;
    std::vector<std::string>& unlikeCounts;   // accessors with other counts than the Draco data
    const DracoMesh* draco = nullptr;         // null for a primitive that is not compressed
    const Value::Object* dracoIds = nullptr;  // by attribute
    std::vector<std::string> missing{};       // attributes that the Draco data lack

    Document& document() const {
        return source.document;
    }
    std::string pointer(const char* attribute) const {
        return fmt::format("{}/attributes/{}", primitive.pointer, attribute);
    }
};

std::string dracoPointer(const Reader& reader) {
    return fmt::format("{}/extensions/{}", reader.primitive.pointer, kDracoExtension);
}

// tinygltf keeps 32 bits of an integer, which are all that an identifier has.
std::uint32_t idOf(const Value& value) {
    return static_cast<std::uint32_t>(value.GetNumberAsInt());
}

// Returns the identifier that the attribute has in the Draco data, or nothing if it is read from its
// accessor.
std::optional<std::uint32_t> packedId(const Reader& reader, const char* attribute) {
    if (reader.draco == nullptr) {
        return std::nullopt;
    }
    const auto id = reader.dracoIds->find(attribute);
    return id == reader.dracoIds->end() ? std::nullopt : std::optional(idOf(id->second));
}

void noteUnlikeCount(const Reader& reader, const char* what, std::size_t count, std::size_t packed) {
    if (count != packed) {
        reader.unlikeCounts.push_back(fmt::format("{} {} instead of {}", what, count, packed));
    }
}

// Returns the accessor of an attribute that the primitive has, or -1. The name is one of kAttributes or of
// the model's attributes, as only their accessors have been checked.
int readableAccessor(const Reader& reader, const std::string& attribute) {
    return std::ranges::find(reader.missing, attribute) == reader.missing.end()
               ? accessorOf(reader.source.file.attributes, attribute)
               : -1;
}

// Lists attributes that the Draco data should have and lack. Without POSITION there is nothing to draw, so
// its lack is an error where it is read.
void findMissing(Reader& reader) {
    for (const auto& [attribute, id] : *reader.dracoIds) {
        if (attribute != "POSITION" && reader.source.file.attributes.contains(attribute) &&
            !reader.draco->has(idOf(id))) {
            reader.missing.push_back(attribute);
            reader.document().warn(
                "draco-attribute", fmt::format("{}/attributes/{}", dracoPointer(reader), attribute),
                fmt::format("is {}, but the Draco data has no such attribute; it is left out", idOf(id)),
                kExportMesh);
        }
    }
}

// Reads the attribute's elements from the Draco data.
Result<FloatElements> readPacked(const Reader& reader, const char* attribute, int accessor, std::uint32_t id,
                                 Integers integers) {
    Document& document = reader.document();
    GLINT_TRY(const auto format, floatFormat(document, accessor));
    GLINT_TRY_DO(document.chargeVertices(reader.draco->pointCount(), reader.pointer(attribute)));
    noteUnlikeCount(reader, attribute, document.accessor(accessor).count, reader.draco->pointCount());
    GLINT_TRY(const auto bytes,
              reader.draco->attribute(document, id, format,
                                      fmt::format("{}/attributes/{}", dracoPointer(reader), attribute)));
    return toFloats(document, accessor, integers, bytes);
}

Result<FloatElements> readElements(const Reader& reader, const char* attribute, int accessor,
                                   Integers integers) {
    if (const std::optional<std::uint32_t> id = packedId(reader, attribute)) {
        return readPacked(reader, attribute, accessor, *id, integers);
    }
    return readFloats(reader.document(), accessor, integers);
}

// Reads an attribute of at least `fewest` and at most `components` components, and fills the missing ones
// with 1. Leaves `values` empty if the primitive lacks the attribute.
template <std::size_t N>
Status readAttribute(const Reader& reader, const char* attribute, std::size_t fewest, Integers integers,
                     std::vector<std::array<float, N>>& values) {
    const int accessor = readableAccessor(reader, attribute);
    if (accessor < 0) {
        return okStatus();
    }
    const Document& document = reader.document();
    const bool isPosition = static_cast<const void*>(&values) == &reader.primitive.positions;
    const std::size_t expected = reader.draco != nullptr ? reader.draco->pointCount()
                                 : isPosition            ? document.accessor(accessor).count
                                                         : reader.primitive.positions.size();
    if (document.accessor(accessor).count != expected && !packedId(reader, attribute)) {
        return document.error("attribute-count", reader.pointer(attribute),
                              fmt::format("has {} elements, {} has {}", document.accessor(accessor).count,
                                          reader.draco != nullptr ? "the Draco data" : "POSITION", expected),
                              kExportMesh);
    }
    GLINT_TRY(const auto elements, readElements(reader, attribute, accessor, integers));
    return toVectors(document, elements, fewest, 1.0F, reader.pointer(attribute), kExportMesh, values);
}

Status readColors(const Reader& reader) {
    const int accessor = readableAccessor(reader, "COLOR_0");
    if (accessor < 0) {
        return okStatus();
    }
    const tinygltf::Accessor& source = reader.document().accessor(accessor);
    if (source.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !source.normalized) {
        reader.document().warn("color-normalized", reader.pointer("COLOR_0"),
                               "integer colours are not marked as normalised; they are read as if they were",
                               kExportMesh);
    }
    return readAttribute(reader, "COLOR_0", 3, Integers::Normalized, reader.primitive.colors);
}

bool hasJointNumbers(const Document& document, int accessor) {
    const tinygltf::Accessor& source = document.accessor(accessor);
    return !source.normalized && (source.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                  source.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

Status readInfluences(const Reader& reader) {
    std::vector<InfluenceSet> sets;
    for (int set = 0; set < kInfluenceSets; ++set) {
        const std::string joints = fmt::format("JOINTS_{}", set);
        const std::string weights = fmt::format("WEIGHTS_{}", set);
        const int jointAccessor = readableAccessor(reader, joints);
        const int weightAccessor = readableAccessor(reader, weights);
        const auto isMissing = [&](const std::string& name) {
            return std::ranges::find(reader.missing, name) != reader.missing.end();
        };
        if ((jointAccessor < 0 && weightAccessor < 0) || isMissing(joints) || isMissing(weights)) {
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
        GLINT_TRY_DO(readAttribute(reader, joints.c_str(), 4, Integers::AsValues, read.joints));
        GLINT_TRY_DO(readAttribute(reader, weights.c_str(), 4, Integers::Normalized, read.weights));
    }
    const std::string beyond = fmt::format("JOINTS_{}", sets.size());
    if (reader.source.file.attributes.contains(beyond)) {
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
        const int accessor = readableAccessor(reader, declared.gltf);
        const bool known = std::ranges::find(reader.primitive.attributes, declared.gltf,
                                             &VertexValues::name) != reader.primitive.attributes.end();
        if (accessor < 0 || known) {
            continue;
        }
        const std::string pointer = reader.pointer(declared.gltf.c_str());
        GLINT_TRY(auto elements, readElements(reader, declared.gltf.c_str(), accessor, Integers::AsValues));
        if (elements.count != reader.primitive.positions.size()) {
            return document.error("attribute-count", pointer,
                                  fmt::format("has {} elements, POSITION has {}", elements.count,
                                              reader.primitive.positions.size()),
                                  kExportMesh);
        }
        if (elements.components != static_cast<std::size_t>(declared.channels)) {
            return document.error("attribute-type", pointer,
                                  fmt::format("has {} components; the pack's attribute \"{}\" has {}",
                                              elements.components, declared.name, declared.channels),
                                  "export the mesh again, or correct the declaration");
        }
        reader.primitive.attributes.push_back(
            {declared.gltf, static_cast<std::uint32_t>(declared.channels), std::move(elements.values)});
    }
    return okStatus();
}

Status readAttributes(const Reader& reader) {
    Primitive& primitive = reader.primitive;
    constexpr Integers kValues = Integers::AsValues;
    GLINT_TRY_DO(readAttribute(reader, "POSITION", 3, kValues, primitive.positions));
    GLINT_TRY_DO(readAttribute(reader, "NORMAL", 3, kValues, primitive.normals));
    GLINT_TRY_DO(readAttribute(reader, "TEXCOORD_0", 2, kValues, primitive.texCoords0));
    GLINT_TRY_DO(readAttribute(reader, "TEXCOORD_1", 2, kValues, primitive.texCoords1));
    GLINT_TRY_DO(readColors(reader));
    GLINT_TRY_DO(readInfluences(reader));
    GLINT_TRY_DO(readDeclared(reader));
    if (primitive.normals.empty() && readableAccessor(reader, "TANGENT") >= 0) {
        reader.document().warn("tangent-without-normal", reader.pointer("TANGENT"),
                               "tangents without normals are ignored, as glTF says");
        return okStatus();
    }
    return readAttribute(reader, "TANGENT", 4, kValues, primitive.tangents);
}

Result<std::vector<std::uint32_t>> readOrder(const Reader& reader) {
    Document& document = reader.document();
    const std::size_t vertices = reader.primitive.positions.size();
    const int accessor = reader.source.file.indices;
    if (accessor < 0) {
        std::vector<std::uint32_t> order(vertices);
        std::iota(order.begin(), order.end(), 0U);
        return order;
    }
    GLINT_TRY(auto indices, readIndices(document, accessor));
    const std::string pointer = reader.primitive.pointer + "/indices";
    constexpr const char* kExportWithoutRestart = "glTF has no primitive restart: export the mesh again";
    bool hasRestart = false;
    for (std::size_t i = 0; i < indices.values.size(); ++i) {
        const std::uint32_t index = indices.values[i];
        const bool isRestart = index == indices.restart;
        if (index >= vertices && isRestart) {
            return document.error("primitive-restart", pointer,
                                  fmt::format("index {} is the primitive restart value {}", i, index),
                                  kExportWithoutRestart);
        }
        if (index >= vertices) {
            return document.error(
                "index-range", pointer,
                fmt::format("index {} is {}, but there are {} vertices", i, index, vertices), kExportMesh);
        }
        hasRestart = hasRestart || isRestart;
    }
    if (hasRestart) {
        document.warn(
            "primitive-restart", pointer,
            fmt::format("has the primitive restart value {}, which is taken for the vertex of that number",
                        indices.restart),
            kExportWithoutRestart);
    }
    return std::move(indices.values);
}

// Draco merges points and drops degenerate triangles. Not every exporter corrects the accessors afterwards.
void warnOfUnlikeCounts(const Reader& reader) {
    const int indices = reader.source.file.indices;
    if (indices >= 0 && reader.source.file.mode == TINYGLTF_MODE_TRIANGLES) {
        noteUnlikeCount(reader, "indices", reader.document().accessor(indices).count,
                        reader.draco->indices().size());
    }
    if (!reader.unlikeCounts.empty()) {
        reader.document().warn(
            "draco-count", reader.primitive.pointer,
            fmt::format("its accessors have other counts than the Draco data, whose counts are used: {}",
                        fmt::join(reader.unlikeCounts, ", ")),
            kExportMesh);
    }
}

}  // namespace

Result<std::vector<std::uint32_t>> readVertices(const PrimitiveSource& source, Primitive& primitive,
                                                bool& isList) {
    std::vector<std::string> unlikeCounts;
    Reader reader{source, primitive, unlikeCounts};
    std::optional<DracoMesh> draco;
    if (const Value* const extension = extensionOf(source.file.extensions, kDracoExtension)) {
        GLINT_TRY(draco, DracoMesh::decode(source.document, *extension, dracoPointer(reader)));
        reader.draco = &*draco;
        reader.dracoIds = &extension->Get("attributes").Get<Value::Object>();
        findMissing(reader);
    }
    GLINT_TRY_DO(readAttributes(reader));
    if (!draco) {
        return readOrder(reader);
    }
    warnOfUnlikeCounts(reader);
    isList = true;
    return draco->indices();
}

}  // namespace glint::gltf
