#include "cli/many_keys.h"

#include "cli/command.h"
#include "image/image_file.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace glint::testing {

namespace fs = std::filesystem;

namespace {

using nlohmann::json;

constexpr int kFloat = 5126;
constexpr int kUnsignedShort = 5123;

// Returns positions, normals, texture coordinates and indices of a square.
std::string squareBytes() {
    constexpr std::array<float, 32> kVertices{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0,  //
                                              0,  0,  1, 0, 0,  1, 0, 0, 1, 0,  0, 1,  //
                                              0,  1,  1, 1, 1,  0, 0, 0};
    constexpr std::array<std::uint16_t, 6> kIndices{0, 1, 2, 0, 2, 3};
    std::string bytes(sizeof kVertices + sizeof kIndices, '\0');
    std::memcpy(bytes.data(), kVertices.data(), sizeof kVertices);
    std::memcpy(bytes.data() + sizeof kVertices, kIndices.data(), sizeof kIndices);
    return bytes;
}

json makeMaterial(const std::vector<std::string>& lobes, std::size_t number) {
    json material{{"name", std::to_string(number)},
                  {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1.0}}}}};
    for (const std::string& lobe : lobes) {
        if (lobe == "textured") {
            material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
        } else if (lobe == "clearcoat") {
            material["extensions"]["KHR_materials_clearcoat"]["clearcoatFactor"] = 1.0;
        } else {
            material["extensions"]["KHR_materials_sheen"]["sheenColorFactor"] = {1.0, 1.0, 1.0};
        }
    }
    return material;
}

}  // namespace

fs::path writeManyKeys(const fs::path& folder, const Lobes& lobes, double red) {
    fs::create_directories(folder);
    const std::string square = squareBytes();
    writeText(folder / "scene.bin", square);
    writeBaseTexture(folder, 200);
    json gltf{{"asset", {{"version", "2.0"}}},
              {"scene", 0},
              {"extensionsUsed", {"KHR_materials_clearcoat", "KHR_materials_sheen"}},
              {"images", {{{"uri", "base.png"}}}},
              {"textures", {{{"source", 0}}}},
              {"buffers", {{{"uri", "scene.bin"}, {"byteLength", square.size()}}}},
              {"bufferViews",
               {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 48}},
                {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 48}},
                {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 32}},
                {{"buffer", 0}, {"byteOffset", 128}, {"byteLength", 12}}}},
              {"accessors",
               {{{"bufferView", 0},
                 {"componentType", kFloat},
                 {"count", 4},
                 {"type", "VEC3"},
                 {"min", {-1, -1, 0}},
                 {"max", {1, 1, 0}}},
                {{"bufferView", 1}, {"componentType", kFloat}, {"count", 4}, {"type", "VEC3"}},
                {{"bufferView", 2}, {"componentType", kFloat}, {"count", 4}, {"type", "VEC2"}},
                {{"bufferView", 3}, {"componentType", kUnsignedShort}, {"count", 6}, {"type", "SCALAR"}}}}};
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        gltf["materials"].push_back(makeMaterial(lobes[i], i));
        gltf["meshes"].push_back({{"primitives",
                                   {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}},
                                     {"indices", 3},
                                     {"material", i}}}}});
        gltf["nodes"].push_back({{"mesh", i}, {"translation", {3 * i, 0, 0}}});
        gltf["scenes"][0]["nodes"].push_back(i);
    }
    gltf["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][0] = red;
    fs::path path = folder / "scene.gltf";
    writeText(path, gltf.dump());
    return path;
}

void writeBaseTexture(const fs::path& folder, std::uint8_t red) {
    const image::DisplayImage image{2, 1, {{red, 100, 50}, {0, 30, 200}}};
    must(writeImage(folder / "base.png", image));
}

std::vector<std::pair<std::string, std::string>> contentsOf(const fs::path& folder) {
    std::vector<std::pair<std::string, std::string>> contents;
    if (fs::exists(folder)) {
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
            if (entry.is_regular_file()) {
                contents.emplace_back(fs::relative(entry.path(), folder).string(), readText(entry.path()));
            }
        }
    }
    std::ranges::sort(contents);
    return contents;
}

}  // namespace glint::testing
