#include "document.h"

#include <cstring>
#include <fstream>
#include <iterator>

namespace gallery::test {

namespace {

template <typename T>
T load(const std::string& bytes, std::size_t offset) {
    T value{};
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

Document read(const std::filesystem::path& folder) {
    return {folder, Json::parse(readAll(folder / "gallery.gltf")), readAll(folder / "gallery.bin")};
}

std::size_t byteOffset(const Document& document, const Json& accessor) {
    const Json& view = document.json["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
    return view.value("byteOffset", std::size_t{0}) + accessor.value("byteOffset", std::size_t{0});
}

}  // namespace

std::string readAll(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t componentBytes(const Json& accessor) {
    const int type = accessor["componentType"].get<int>();
    return type == 5121 ? 1 : type == 5123 ? 2 : 4;
}

std::size_t componentCount(const Json& accessor) {
    const auto type = accessor["type"].get<std::string>();
    return type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
}

std::vector<float> Document::values(const Json& accessor) const {
    const std::size_t bytes = componentBytes(accessor);
    const std::size_t offset = byteOffset(*this, accessor);
    const std::size_t count = accessor["count"].get<std::size_t>() * componentCount(accessor);
    std::vector<float> result;
    for (std::size_t index = 0; index < count; ++index) {
        const std::size_t at = offset + index * bytes;
        if (bytes == 1) {
            result.push_back(static_cast<float>(load<std::uint8_t>(binary, at)) / 255.0F);
        } else if (bytes == 2) {
            result.push_back(static_cast<float>(load<std::uint16_t>(binary, at)) / 65535.0F);
        } else {
            result.push_back(load<float>(binary, at));
        }
    }
    return result;
}

std::vector<std::uint32_t> Document::indices(const Json& accessor) const {
    const std::size_t bytes = componentBytes(accessor);
    const std::size_t offset = byteOffset(*this, accessor);
    std::vector<std::uint32_t> result;
    for (std::size_t index = 0; index < accessor["count"].get<std::size_t>(); ++index) {
        const std::size_t at = offset + index * bytes;
        result.push_back(bytes == 2 ? load<std::uint16_t>(binary, at) : load<std::uint32_t>(binary, at));
    }
    return result;
}

std::vector<std::pair<std::string, Json>> textureUses(const Json& material) {
    std::vector<Json> holders{material, material["pbrMetallicRoughness"]};
    if (material.contains("extensions")) {
        for (const Json& extension : material["extensions"]) {
            holders.push_back(extension);
        }
    }
    std::vector<std::pair<std::string, Json>> uses;
    for (const Json& holder : holders) {
        for (const auto& [name, value] : holder.items()) {
            if (name.ends_with("Texture")) {
                uses.emplace_back(name, value);
            }
        }
    }
    return uses;
}

std::vector<std::size_t> materialsOf(const Json& primitive) {
    std::vector<std::size_t> materials{primitive["material"].get<std::size_t>()};
    if (primitive.contains("extensions")) {
        for (const Json& mapping : primitive["extensions"]["KHR_materials_variants"]["mappings"]) {
            materials.push_back(mapping["material"].get<std::size_t>());
        }
    }
    return materials;
}

const Document& document() {
    static const Document kDocument = read(GLINT_GALLERY_FOLDER);
    return kDocument;
}

}  // namespace gallery::test
