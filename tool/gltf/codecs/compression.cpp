#include "gltf/codecs/compression.h"

#include <fmt/format.h>

#include <array>
#include <span>
#include <string>

namespace glint::gltf {

namespace {

// Above this value, doubles no longer represent every integer.
constexpr double kMaxSize = 9007199254740991.0;
constexpr double kMaxAttributeId = 4294967295.0;
// The size in bytes of the largest vertex that the extension allows.
constexpr double kMaxStride = 256.0;

constexpr Rule size(std::string_view name, bool required) {
    return {.name = name, .kind = Kind::Integer, .required = required, .min = 0.0, .max = kMaxSize};
}

constexpr std::array kMeshopt{
    Rule{.name = "buffer", .kind = Kind::Index, .required = true, .target = "/buffers"},
    size("byteOffset", false),
    size("byteLength", true),
    Rule{.name = "byteStride", .kind = Kind::Integer, .required = true, .min = 1.0, .max = kMaxStride},
    size("count", true),
    Rule{.name = "mode", .kind = Kind::Text, .required = true},
    Rule{.name = "filter", .kind = Kind::Text}};

constexpr std::array kDracoRules{
    Rule{.name = "bufferView", .kind = Kind::Index, .required = true, .target = "/bufferViews"},
    Rule{.name = "attributes", .kind = Kind::Object, .required = true}};

constexpr std::array kSource{
    Rule{.name = "source", .kind = Kind::Index, .required = true, .target = "/images"}};

constexpr std::array<std::string_view, 2> kMeshoptNames{"EXT_meshopt_compression", "KHR_meshopt_compression"};

// Checks the extension of that name if `owner` has it.
std::optional<SchemaError> checkExtension(const Json& root, Json& owner, std::string_view name,
                                          std::span<const Rule> rules, const std::string& pointer) {
    if (findExtension(owner, name) == nullptr) {
        return std::nullopt;
    }
    Json& extension = owner["extensions"][std::string(name)];
    return checkObject(root, extension, rules, fmt::format("{}/extensions/{}", pointer, name));
}

std::optional<SchemaError> checkDraco(const Json& root, Json& primitive, const std::string& pointer) {
    constexpr std::string_view kName = "KHR_draco_mesh_compression";
    if (auto error = checkExtension(root, primitive, kName, kDracoRules, pointer)) {
        return error;
    }
    if (findExtension(primitive, kName) == nullptr) {
        return std::nullopt;
    }
    Json& attributes = primitive["extensions"][std::string(kName)]["attributes"];
    for (const auto& [attribute, id] : attributes.items()) {
        const std::array rule{Rule{
            .name = attribute, .kind = Kind::Integer, .required = true, .min = 0.0, .max = kMaxAttributeId}};
        if (auto error = checkObject(root, attributes, rule,
                                     fmt::format("{}/extensions/{}/attributes", pointer, kName))) {
            return error;
        }
    }
    return std::nullopt;
}

std::optional<SchemaError> checkPrimitives(const Json& root, Json& meshes) {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const std::size_t count = arrayMember(meshes[i], "primitives").size();
        for (std::size_t k = 0; k < count; ++k) {
            if (auto error = checkDraco(root, meshes[i]["primitives"][k],
                                        fmt::format("/meshes/{}/primitives/{}", i, k))) {
                return error;
            }
        }
    }
    return std::nullopt;
}

// Checks the extensions of those names in every element of the root's array.
template <std::size_t N>
std::optional<SchemaError> checkElements(Json& root, std::string_view array,
                                         const std::array<std::string_view, N>& names,
                                         std::span<const Rule> rules) {
    for (std::size_t i = 0; i < arrayMember(root, array).size(); ++i) {
        Json& element = root[std::string(array)][i];
        for (const std::string_view name : names) {
            if (auto error = checkExtension(root, element, name, rules, fmt::format("/{}/{}", array, i))) {
                return error;
            }
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<SchemaError> checkCompression(Json& root) {
    if (auto error = checkElements(root, "bufferViews", kMeshoptNames, kMeshopt)) {
        return error;
    }
    constexpr std::array<std::string_view, 3> kImages{"EXT_texture_webp", "KHR_texture_basisu",
                                                      "MSFT_texture_dds"};
    if (auto error = checkElements(root, "textures", kImages, kSource)) {
        return error;
    }
    return arrayMember(root, "meshes").empty() ? std::nullopt : checkPrimitives(root, root["meshes"]);
}

const Json* findMeshopt(const Json& object) {
    for (const std::string_view name : kMeshoptNames) {
        if (const Json* extension = findExtension(object, name)) {
            return extension;
        }
    }
    return nullptr;
}

int extensionSource(const Json& texture, std::string_view extension) {
    const Json* found = findExtension(texture, extension);
    return found == nullptr ? -1 : (*found)["source"].get<int>();
}

}  // namespace glint::gltf
