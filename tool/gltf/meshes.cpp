#include "gltf/meshes.h"

#include "gltf/accessor.h"
#include "gltf/extensions.h"
#include "gltf/repair.h"
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

// One primitive on its way from the file to the scene.
struct Reader {
    Document& document;
    const tinygltf::Primitive& source;
    Primitive& primitive;

    int accessor(const char* attribute) const {
        const auto found = source.attributes.find(attribute);
        return found == source.attributes.end() ? -1 : found->second;
    }
    std::string pointer(const char* attribute) const {
        return fmt::format("{}/attributes/{}", primitive.pointer, attribute);
    }
};

// Reads an attribute of `components` or fewer (at least `fewest`), the rest filled with 1; leaves `values`
// empty where the primitive lacks it.
template <std::size_t N>
Status readAttribute(const Reader& reader, const char* attribute, std::size_t fewest, Integers integers,
                     std::vector<std::array<float, N>>& values) {
    const int accessor = reader.accessor(attribute);
    if (accessor < 0) {
        return okStatus();
    }
    const Document& document = reader.document;
    const bool isPosition = static_cast<const void*>(&values) == &reader.primitive.positions;
    const std::size_t expected = reader.primitive.positions.size();
    if (!isPosition && elementCount(document, accessor) != expected) {
        return document.error(
            "attribute-count", reader.pointer(attribute),
            fmt::format("has {} elements, POSITION has {}", elementCount(document, accessor), expected),
            "export the mesh again");
    }
    const Result<FloatElements> elements = readFloats(reader.document, accessor, integers);
    if (!elements) {
        return elements.error();
    }
    if (elements->components < fewest || elements->components > N) {
        return document.error("attribute-type", reader.pointer(attribute),
                              fmt::format("has {} components, not {}", elements->components, N),
                              "export the mesh again");
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
    const int accessor = reader.accessor("COLOR_0");
    if (accessor < 0) {
        return okStatus();
    }
    const auto& source = reader.document.model().accessors[static_cast<std::size_t>(accessor)];
    if (source.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !source.normalized) {
        reader.document.warn("color-normalized", reader.pointer("COLOR_0"),
                             "integer colours are not marked as normalised; they are read as if they were",
                             "export the mesh again");
    }
    return readAttribute(reader, "COLOR_0", 3, Integers::Normalized, reader.primitive.colors);
}

ColorContent contentOf(const std::vector<Float4>& colors) {
    if (colors.empty()) {
        return ColorContent::None;
    }
    const bool white = std::all_of(colors.begin(), colors.end(), [](const Float4& color) {
        return color == Float4{1.0F, 1.0F, 1.0F, 1.0F};
    });
    return white ? ColorContent::White : ColorContent::Varying;
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
    if (primitive.normals.empty() && reader.accessor("TANGENT") >= 0) {
        reader.document.warn("tangent-without-normal", reader.pointer("TANGENT"),
                             "tangents without normals are ignored, as glTF says");
        return okStatus();
    }
    return readAttribute(reader, "TANGENT", 4, kValues, primitive.tangents);
}

Result<std::vector<std::uint32_t>> readVertexOrder(const Reader& reader) {
    const std::size_t vertices = reader.primitive.positions.size();
    if (reader.source.indices < 0) {
        std::vector<std::uint32_t> order(vertices);
        std::iota(order.begin(), order.end(), 0U);
        return order;
    }
    Result<IndexElements> indices = readIndices(reader.document, reader.source.indices);
    if (!indices) {
        return indices.error();
    }
    const std::string pointer = reader.primitive.pointer + "/indices";
    for (std::size_t i = 0; i < indices->values.size(); ++i) {
        const std::uint32_t index = indices->values[i];
        if (index == indices->restart) {
            return reader.document.error("primitive-restart", pointer,
                                         fmt::format("index {} is the primitive restart value {}", i, index),
                                         "glTF has no primitive restart: export the mesh again");
        }
        if (index >= vertices) {
            return reader.document.error(
                "index-range", pointer,
                fmt::format("index {} is {}, but there are {} vertices", i, index, vertices),
                "export the mesh again");
        }
    }
    return std::move(indices->values);
}

// A primitive whose geometry exists compressed only must not be read as zeros.
std::optional<Diagnostic> checkCompression(const Reader& reader, const Json& json) {
    const char* extension = compressionOf(json);
    if (extension == nullptr) {
        return std::nullopt;
    }
    const auto isBare = [&](int accessor) {
        return accessor >= 0 && find(reader.document.json()["accessors"][static_cast<std::size_t>(accessor)],
                                     "bufferView") == nullptr;
    };
    bool bare = isBare(reader.source.indices);
    for (const auto& [name, accessor] : reader.source.attributes) {
        bare = bare || isBare(accessor);
    }
    if (bare) {
        return unsupportedExtension(reader.document, extension, reader.primitive.pointer);
    }
    return std::nullopt;
}

// Whether the primitive has a mode that makes triangles; warns or fails otherwise.
Result<bool> isDrawable(const Reader& reader) {
    const int mode = reader.source.mode;
    if (mode < 0 || mode > static_cast<int>(PrimitiveMode::TriangleFan)) {
        return reader.document.error("primitive-mode", reader.primitive.pointer + "/mode",
                                     fmt::format("{} is no mode", mode), "export the mesh again");
    }
    if (mode < static_cast<int>(PrimitiveMode::Triangles)) {
        reader.document.warn("primitive-skipped", reader.primitive.pointer,
                             "points and lines have no surface that a ray can hit; they are skipped");
        return false;
    }
    if (reader.accessor("POSITION") < 0) {
        return reader.document.error("position-missing", reader.primitive.pointer + "/attributes",
                                     "has no POSITION", "export the mesh again, or delete the primitive");
    }
    return true;
}

// Whether there is something to draw in `reader.primitive` after it was read.
Result<bool> readPrimitive(const Reader& reader, const Json& json) {
    Result<bool> drawable = isDrawable(reader);
    if (!drawable || !*drawable) {
        return drawable;
    }
    if (auto error = checkCompression(reader, json)) {
        return *error;
    }
    if (Status status = readAttributes(reader); !status) {
        return status.error();
    }
    Result<std::vector<std::uint32_t>> order = readVertexOrder(reader);
    if (!order) {
        return order.error();
    }
    TriangleList list = makeTriangles(static_cast<PrimitiveMode>(reader.source.mode), std::move(*order));
    Primitive& primitive = reader.primitive;
    if (list.leftOver > 0) {
        reader.document.warn(
            "triangle-incomplete", primitive.pointer,
            fmt::format("the last {} vertices make no triangle and are dropped", list.leftOver));
    }
    primitive.indices = std::move(list.indices);
    repairPrimitive(reader.document, primitive);
    primitive.colorContent = contentOf(primitive.colors);
    if (primitive.indices.empty()) {
        reader.document.warn("primitive-empty", primitive.pointer, "has no triangle and is skipped");
        return false;
    }
    return true;
}

Result<Mesh> readMesh(Document& document, std::size_t index, int defaultMaterial) {
    const tinygltf::Mesh& source = document.model().meshes[index];
    const Json& primitives = arrayMember(document.json()["meshes"][index], "primitives");
    Mesh mesh;
    mesh.name = source.name;
    for (std::size_t i = 0; i < source.primitives.size(); ++i) {
        Primitive primitive;
        primitive.pointer = fmt::format("/meshes/{}/primitives/{}", index, i);
        primitive.material =
            source.primitives[i].material < 0 ? defaultMaterial : source.primitives[i].material;
        const Result<bool> drawn = readPrimitive({document, source.primitives[i], primitive}, primitives[i]);
        if (!drawn) {
            return drawn.error();
        }
        if (*drawn) {
            mesh.primitives.push_back(std::move(primitive));
        }
    }
    return mesh;
}

}  // namespace

Result<bool> importMeshes(Document& document, const std::vector<bool>& placed, Scene& scene) {
    const int defaultMaterial = static_cast<int>(scene.materials.size());
    bool usesDefault = false;
    for (std::size_t i = 0; i < document.model().meshes.size(); ++i) {
        Result<Mesh> mesh = readMesh(document, i, defaultMaterial);
        if (!mesh && placed[i]) {
            return mesh.error();
        }
        if (!mesh) {
            Diagnostic warning = mesh.error();
            warning.severity = Severity::Warning;
            warning.message += "; no node draws the mesh, and it is left empty";
            document.warnings().push_back(std::move(warning));
            scene.meshes.push_back({document.model().meshes[i].name, {}});
            continue;
        }
        for (const Primitive& primitive : mesh->primitives) {
            usesDefault = usesDefault || primitive.material == defaultMaterial;
        }
        scene.meshes.push_back(std::move(*mesh));
    }
    return usesDefault;
}

}  // namespace glint::gltf
