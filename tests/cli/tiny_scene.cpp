#include "cli/tiny_scene.h"

#include "cli/command.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace glint::testing {

namespace {

using Json = nlohmann::json;

// Four corners and two triangles: 4 positions, 4 normals, 6 indices of 16 bits.
using Corners = std::array<std::array<float, 3>, 4>;

void append(std::string& bytes, const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
}

std::string quad(const Corners& corners, const std::array<float, 3>& normal) {
    std::string bytes;
    append(bytes, corners.data(), sizeof corners);
    for (int i = 0; i < 4; ++i) {
        append(bytes, normal.data(), sizeof normal);
    }
    const std::array<std::uint16_t, 6> indices{0, 1, 2, 0, 2, 3};
    append(bytes, indices.data(), sizeof indices);
    return bytes;
}

constexpr int kFloat = 5126;
constexpr int kUnsignedShort = 5123;
constexpr std::size_t kVectorBytes = 48;
constexpr std::size_t kQuadBytes = 2 * kVectorBytes + 12;

// Adds three buffer views and three accessors for the quad at `offset` of the buffer.
void addQuad(Json& gltf, const Corners& corners, std::size_t offset, int material) {
    const std::size_t first = gltf["accessors"].size();
    const auto view = [&](std::size_t start, std::size_t bytes) {
        gltf["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset + start}, {"byteLength", bytes}});
    };
    view(0, kVectorBytes);
    view(kVectorBytes, kVectorBytes);
    view(2 * kVectorBytes, 12);
    std::array<float, 3> low = corners[0];
    std::array<float, 3> high = corners[0];
    for (const std::array<float, 3>& corner : corners) {
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], corner[i]);
            high[i] = std::max(high[i], corner[i]);
        }
    }
    gltf["accessors"].push_back({{"bufferView", first},
                                 {"componentType", kFloat},
                                 {"count", 4},
                                 {"type", "VEC3"},
                                 {"min", low},
                                 {"max", high}});
    gltf["accessors"].push_back(
        {{"bufferView", first + 1}, {"componentType", kFloat}, {"count", 4}, {"type", "VEC3"}});
    gltf["accessors"].push_back(
        {{"bufferView", first + 2}, {"componentType", kUnsignedShort}, {"count", 6}, {"type", "SCALAR"}});
    gltf["meshes"].push_back({{"primitives",
                               {{{"attributes", {{"POSITION", first}, {"NORMAL", first + 1}}},
                                 {"indices", first + 2},
                                 {"material", material}}}}});
}

// Returns times, shifts, weights and a morph target, which follow the quads.
std::string motionData() {
    std::string bytes;
    const std::array<float, 2> times{0, 1};
    const std::array<float, 6> shifts{0, 0, 0, 1, 0, 0};
    const Corners lifts{{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 1, 0}}};
    append(bytes, times.data(), sizeof times);
    append(bytes, shifts.data(), sizeof shifts);
    append(bytes, lifts.data(), sizeof lifts);
    return bytes;
}

constexpr std::size_t kMotionBytes = 8 + 24 + 48;

void addMotion(Json& gltf) {
    const std::size_t first = gltf["accessors"].size();
    const auto accessor = [&](std::size_t start, std::size_t bytes, std::size_t count, const char* type) {
        gltf["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", 2 * kQuadBytes + start}, {"byteLength", bytes}});
        gltf["accessors"].push_back({{"bufferView", gltf["bufferViews"].size() - 1},
                                     {"componentType", kFloat},
                                     {"count", count},
                                     {"type", type}});
    };
    accessor(0, 8, 2, "SCALAR");
    accessor(8, 24, 2, "VEC3");
    accessor(32, 48, 4, "VEC3");
    gltf["accessors"][first]["min"] = {0.0};
    gltf["accessors"][first]["max"] = {1.0};
    gltf["accessors"][first + 2]["min"] = {0.0, 0.0, 0.0};
    gltf["accessors"][first + 2]["max"] = {0.0, 1.0, 0.0};
    gltf["meshes"][1]["primitives"][0]["targets"] = {{{"POSITION", first + 2}}};
    const auto channel = [](int sampler, int node, const char* path) {
        return Json{{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}};
    };
    // The weights from 0 to 1 are the times themselves.
    const Json shift{{"input", first}, {"output", first + 1}};
    const Json weights{{"input", first}, {"output", first}};
    gltf["animations"] = {
        {{"name", "Slide"},
         {"samplers", {shift, weights}},
         {"channels", {channel(0, 1, "translation"), channel(1, 1, "weights")}}},
        {{"name", "Look"}, {"samplers", {shift}}, {"channels", {channel(0, 2, "translation")}}}};
}

Json materials() {
    return Json::array(
        {{{"name", "Floor"},
          {"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.7, 0.6, 1.0}}, {"roughnessFactor", 0.1}}}},
         {{"name", "Wall"},
          {"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.6, 0.3, 1.0}}}},
          {"extensions", {{"KHR_materials_unlit", Json::object()}}}},
         {{"name", "Spare"}}});
}

}  // namespace

std::filesystem::path writeTinyScene(const std::filesystem::path& folder, const TinyScene& options) {
    const Corners floor{{{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}}};
    const Corners wall{{{-2, 0, -2}, {2, 0, -2}, {2, 2, -2}, {-2, 2, -2}}};
    writeText(folder / "scene.bin",
              quad(floor, {0, 1, 0}) + quad(wall, {0, 0, 1}) + (options.animated ? motionData() : ""));

    Json gltf{{"asset", {{"version", "2.0"}}},
              {"scene", 0},
              {"scenes", {{{"nodes", {0, 1}}}}},
              {"nodes", {{{"mesh", 0}}, {{"mesh", 1}}}},
              {"extensionsUsed", {"KHR_materials_unlit"}},
              {"materials", materials()},
              {"buffers", {{{"uri", "scene.bin"}, {"byteLength", 2 * kQuadBytes}}}}};
    addQuad(gltf, floor, 0, 0);
    addQuad(gltf, wall, kQuadBytes, 1);
    if (options.camera) {
        gltf["cameras"] = {
            {{"name", "Front"}, {"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.01}}}}};
        gltf["nodes"].push_back({{"name", "Front"}, {"camera", 0}, {"translation", {0, 1, 4}}});
        gltf["scenes"][0]["nodes"].push_back(2);
    }
    if (options.animated) {
        gltf["buffers"][0]["byteLength"] = 2 * kQuadBytes + kMotionBytes;
        addMotion(gltf);
    }
    if (options.unknownExtension) {
        gltf["extensionsUsed"].push_back("EXT_not_known_to_anyone");
    }
    if (options.masked) {
        gltf["materials"][1]["alphaMode"] = "MASK";
        gltf["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.25;
    }
    if (options.blended) {
        gltf["materials"][0]["alphaMode"] = "BLEND";
        gltf["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.5;
    }
    if (options.variants) {
        gltf["extensionsUsed"].push_back("KHR_materials_variants");
        gltf["extensionsUsed"].push_back("KHR_materials_clearcoat");
        gltf["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "Day"}}, {{"name", "Night"}}};
        gltf["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
            {{"material", 2}, {"variants", {0}}}};
        gltf["materials"][0]["extensions"]["KHR_materials_clearcoat"]["clearcoatFactor"] = 1.0;
    }
    std::filesystem::path path = folder / "scene.gltf";
    writeText(path, gltf.dump());
    return path;
}

void writeMudPack(const std::filesystem::path& folder, double shade) {
    std::filesystem::create_directories(folder);
    writeText(folder / "mud.json", R"({
        "name": "mud", "object": "extras", "stage": "surface", "glsl": { "surface": "mud.glsl" },
        "parameters": [{ "name": "mudAmount", "at": "mud", "type": "float", "default": 0, "range": [0, 1] }],
        "neutral": [{ "when": "mudAmount == 0", "because": "there is no mud" }]
    })");
    writeText(folder / "mud.glsl",
              "#include \"hit/surface_values.glsl\"\n\n"
              "void mudSurface(Hit hit, Features features, inout SurfaceValues values) {\n"
              "    float mud = GLINT_MATERIAL_MUD_AMOUNT(hit);\n"
              "    values.color.rgb = mix(values.color.rgb, " +
                  std::to_string(shade) +
                  " * vec3(1.0, 0.6, 0.3), mud);\n"
                  "    values.roughness = mix(values.roughness, 1.0, mud);\n"
                  "}\n");
}

void addMud(const std::filesystem::path& scene, double amount) {
    Json gltf = Json::parse(readText(scene));
    for (Json& material : gltf.at("materials")) {
        if (material.value("name", "") == "Floor") {
            material["extras"] = {{"mud", amount}};
        }
    }
    writeText(scene, gltf.dump());
}

}  // namespace glint::testing
