// The generated scene as a reader of glTF sees it.
#pragma once

#include "support/temporary_folder.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace gallery::test {

using Json = nlohmann::json;

using glint::test::TemporaryFolder;

std::string readAll(const std::filesystem::path& path);

struct Document {
    std::filesystem::path folder;
    Json json;
    std::string binary;

    // Returns the components of an accessor; normalised integers become floats.
    std::vector<float> values(const Json& accessor) const;
    std::vector<std::uint32_t> indices(const Json& accessor) const;
    const Json& accessor(const Json& index) const {
        return json["accessors"].at(index.get<std::size_t>());
    }
};

// Return the bytes of a component, and the number of components of an element.
std::size_t componentBytes(const Json& accessor);
std::size_t componentCount(const Json& accessor);

// Returns the textures that a material names, by slot: in itself, in pbrMetallicRoughness and in its
// extensions.
std::vector<std::pair<std::string, Json>> textureUses(const Json& material);

// Returns the materials that a primitive can have: its own and those of its variants.
std::vector<std::size_t> materialsOf(const Json& primitive);

// Returns the scene that the build generated; it is read once.
const Document& document();

}  // namespace gallery::test
