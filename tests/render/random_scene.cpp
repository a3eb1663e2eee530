#include "render/random_scene.h"

#include "unit/gltf/gltf_builder.h"
#include "unit/gltf/png_writer.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

namespace glint::testing {

namespace {

using test::GltfBuilder;
using test::Json;

// The distributions of the standard library differ between its implementations.
class Dice {
public:
    explicit Dice(std::uint64_t seed) : numbers_(seed * 0x9E3779B97F4A7C15ULL + 1) {}
    double share() {
        return static_cast<double>(numbers_() >> 11U) * 0x1.0p-53;
    }
    double between(double low, double high) {
        return low + (high - low) * share();
    }
    int below(int count) {
        return static_cast<int>(share() * count);
    }
    bool happens(double probability) {
        return share() < probability;
    }
    glm::dvec3 vector(double reach) {
        const double x = between(-reach, reach);
        const double y = between(-reach, reach);
        return {x, y, between(-reach, reach)};
    }

private:
    std::mt19937_64 numbers_;
};

}  // namespace

// The attributes of a primitive besides its positions.
struct Attributes {
    bool normals = false;
    bool uvs = false;
    bool colors = false;
};
constexpr int kAttributeChoices = 8;
static Attributes attributesOf(int choice) {
    return {(choice & 1) != 0, (choice & 2) != 0, (choice & 4) != 0};
}

// Flat facets, because transforms that stretch leave only the normals of these as they are.
struct Facets {
    std::vector<glm::dvec3> corners;  // four for each facet, counter-clockwise
    std::vector<glm::dvec2> uvs;
    std::vector<glm::dvec3> colors;
    Attributes has;
    int material = 0;
};

struct TreeNode {
    int parent = -1;
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
    bool asMatrix = false;
    int mesh = -1;
    bool hasCamera = false;
    int light = -1;
    bool hidden = false;

    glm::dmat4 local() const {
        return glm::translate(glm::dmat4(1.0), translation) * glm::mat4_cast(rotation) *
               glm::scale(glm::dmat4(1.0), scale);
    }
};

struct Lamp {
    std::string type;
    glm::dvec3 color{1.0};
    double intensity = 1.0;
    double range = 0.0;
    double cone = 0.5;
};

namespace {

constexpr int kMaterials = 8;

Json base64Png(int size, const std::vector<std::uint8_t>& rgba) {
    const base::Bytes png = test::makePng({static_cast<std::uint32_t>(size),
                                           static_cast<std::uint32_t>(size),
                                           8,
                                           test::PngColor::Rgba,
                                           {},
                                           rgba});
    return {{"uri", "data:image/png;base64," + test::base64(png)}};
}

void addTextures(GltfBuilder& builder) {
    std::vector<std::uint8_t> chequers;
    std::vector<std::uint8_t> bumps;
    for (int i = 0; i < 16; ++i) {
        const bool dark = (i / 4 + i) % 2 == 0;
        chequers.insert(chequers.end(), {255, static_cast<std::uint8_t>(dark ? 60 : 230), 120,
                                         static_cast<std::uint8_t>(dark ? 0 : 255)});
        bumps.insert(bumps.end(), {static_cast<std::uint8_t>(dark ? 150 : 100), 140, 240, 255});
    }
    builder.append("images", base64Png(4, chequers));
    builder.append("images", base64Png(4, bumps));
    builder.append("samplers", Json::object());
    builder.append("textures", {{"source", 0}, {"sampler", 0}});
    builder.append("textures", {{"source", 1}, {"sampler", 0}});
}

// Adds every material. What varies does not change which features a material has.
void addMaterials(GltfBuilder& builder, Dice& dice) {
    const auto number = [&](double low, double high) { return dice.between(low, high); };
    const auto color = [&] {
        const glm::dvec3 rgb = dice.vector(0.4) + 0.5;
        return Json{rgb.x, rgb.y, rgb.z, 1.0};
    };
    const auto surface = [&](double metallic, double roughness) {
        return Json{
            {"baseColorFactor", color()}, {"metallicFactor", metallic}, {"roughnessFactor", roughness}};
    };
    builder.root["extensionsUsed"] = {"KHR_materials_unlit",        "KHR_materials_clearcoat",
                                      "KHR_materials_transmission", "KHR_materials_emissive_strength",
                                      "KHR_texture_transform",      "KHR_lights_punctual"};
    builder.append("materials", {{"pbrMetallicRoughness", surface(0.0, number(0.5, 0.9))}});
    Json bumpy{{"pbrMetallicRoughness", surface(0.0, number(0.3, 0.6))}, {"normalTexture", {{"index", 1}}}};
    bumpy["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {number(1.5, 3.0), 2.0}}}}}}};
    builder.append("materials", std::move(bumpy));
    builder.append("materials", {{"pbrMetallicRoughness", surface(1.0, 0.0)}});
    builder.append("materials",
                   {{"pbrMetallicRoughness", surface(1.0, number(0.2, 0.4))}, {"doubleSided", true}});
    Json fence{{"pbrMetallicRoughness", surface(0.0, number(0.3, 0.6))},
               {"alphaMode", "MASK"},
               {"doubleSided", true},
               {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", number(0.5, 1.0)}}}}}};
    fence["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    builder.append("materials", std::move(fence));
    builder.append(
        "materials",
        {{"pbrMetallicRoughness", surface(0.0, 0.7)},
         {"emissiveFactor", {0.9, number(0.2, 0.9), 0.3}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", number(2, 4)}}}}}});
    builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", color()}}},
                                 {"extensions", {{"KHR_materials_unlit", Json::object()}}}});
    builder.append(
        "materials",
        {{"pbrMetallicRoughness", surface(0.0, 0.0)},
         {"doubleSided", true},
         {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", number(0.6, 0.9)}}}}}});
}

// Returns a board, a box or a roof.
Facets drawFacets(Dice& dice) {
    Facets facets;
    facets.material = dice.below(kMaterials);
    facets.has = attributesOf(dice.below(kAttributeChoices));
    // Textures without UVs are rare, as in files.
    facets.has.uvs = facets.has.uvs || dice.happens(0.8);
    const auto add = [&](glm::dvec3 corner, glm::dvec3 right, glm::dvec3 up) {
        for (const glm::dvec2 uv : {glm::dvec2(0, 1), glm::dvec2(1, 1), glm::dvec2(1, 0), glm::dvec2(0, 0)}) {
            facets.corners.push_back(corner + uv.x * right + (1.0 - uv.y) * up);
            facets.uvs.push_back(uv);
            facets.colors.push_back(dice.vector(0.4) + 0.6);
        }
    };
    const double x = dice.between(0.3, 1.0);
    const double y = dice.between(0.3, 1.0);
    const double z = dice.between(0.3, 1.0);
    switch (dice.below(3)) {
        case 0:
            // Boards of one mesh must not lie in one plane, where rounding would decide which one is seen.
            add({-x, -y, z - 0.65}, {2 * x, 0, 0}, {0, 2 * y, 0});
            break;
        case 1:
            for (const double side : {-1.0, 1.0}) {
                add({-side * x, -y, side * z}, {2 * side * x, 0, 0}, {0, 2 * y, 0});
                add({side * x, -y, side * z}, {0, 0, -2 * side * z}, {0, 2 * y, 0});
                add({-x, side * y, side * z}, {2 * x, 0, 0}, {0, 0, -2 * side * z});
            }
            break;
        default:
            add({-x, -y, z}, {2 * x, 0, 0}, {0, y, -z});
            add({x, -y, -z}, {-2 * x, 0, 0}, {0, y, z});
            break;
    }
    return facets;
}

// Adds a mesh. `transform` goes into the vertices; if it mirrors, facets turn their corners around, because
// glTF makes the front of a mirrored triangle the side that shows its corners clockwise.
int addMesh(GltfBuilder& builder, const std::vector<Facets>& parts, const glm::dmat4& transform) {
    const bool mirrors = glm::determinant(glm::dmat3(transform)) < 0.0;
    Json primitives = Json::array();
    for (const Facets& facets : parts) {
        std::vector<float> positions;
        std::vector<float> normals;
        std::vector<float> uvs;
        std::vector<float> colors;
        std::vector<std::uint16_t> indices;
        const auto append = [](std::vector<float>& values, auto vector) {
            for (int i = 0; i < vector.length(); ++i) {
                values.push_back(static_cast<float>(vector[i]));
            }
        };
        for (std::size_t i = 0; i < facets.corners.size(); ++i) {
            append(positions, glm::dvec3(transform * glm::dvec4(facets.corners[i], 1.0)));
            const glm::dvec3* const facet = &facets.corners[i / 4 * 4];
            const glm::dvec3 normal = glm::cross(facet[1] - facet[0], facet[3] - facet[0]);
            append(normals, glm::normalize(glm::transpose(glm::inverse(glm::dmat3(transform))) * normal));
            append(uvs, facets.uvs[i]);
            append(colors, facets.colors[i]);
        }
        for (std::uint16_t first = 0; first < facets.corners.size(); first += 4) {
            for (const std::array<int, 3> corners : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
                for (const int i : {0, mirrors ? 2 : 1, mirrors ? 1 : 2}) {
                    indices.push_back(
                        static_cast<std::uint16_t>(first + corners[static_cast<std::size_t>(i)]));
                }
            }
        }
        Json primitive{{"material", facets.material}, {"indices", builder.addAccessor(indices, 1)}};
        Json& attributes = primitive["attributes"];
        attributes["POSITION"] = builder.addAccessor(positions, 3);
        if (facets.has.normals) {
            attributes["NORMAL"] = builder.addAccessor(normals, 3);
        }
        if (facets.has.uvs) {
            attributes["TEXCOORD_0"] = builder.addAccessor(uvs, 2);
        }
        if (facets.has.colors) {
            attributes["COLOR_0"] = builder.addAccessor(colors, 3);
        }
        primitives.push_back(std::move(primitive));
    }
    return builder.append("meshes", {{"primitives", std::move(primitives)}});
}

Json toJson(const glm::dvec3& vector) {
    return {vector.x, vector.y, vector.z};
}

Json toJson(const glm::dquat& rotation) {
    return {rotation.x, rotation.y, rotation.z, rotation.w};
}

}  // namespace

struct RandomScene::State {
    std::uint64_t seed = 0;
    std::vector<std::vector<Facets>> meshes;
    std::vector<TreeNode> nodes;  // parents first
    std::vector<Lamp> lamps;
    bool isOrthographic = false;
    ScenePlace place;

    glm::dmat4 world(std::size_t node) const {
        const TreeNode& one = nodes[node];
        return one.parent < 0 ? one.local() : world(static_cast<std::size_t>(one.parent)) * one.local();
    }
    bool isHidden(std::size_t node) const {
        const TreeNode& one = nodes[node];
        return one.hidden || (one.parent >= 0 && isHidden(static_cast<std::size_t>(one.parent)));
    }
};

namespace {

void drawNodes(Dice& dice, RandomScene::State& scene) {
    const int count = 1 + dice.below(10);
    for (int i = 0; i < count; ++i) {
        TreeNode node;
        node.parent = dice.happens(0.4) ? -1 : dice.below(i + 1) - 1;
        node.translation = dice.vector(1.5);
        const glm::dvec3 axis = dice.vector(1.0);
        node.rotation = glm::angleAxis(dice.between(0.0, 2.0 * std::numbers::pi), glm::normalize(axis));
        const double size = std::exp2(dice.between(-1.0, 0.7));
        for (int k = 0; k < 3; ++k) {
            const bool mirrors = dice.happens(0.2);
            node.scale[k] = (mirrors ? -size : size) * (dice.happens(0.3) ? dice.between(0.5, 1.5) : 1.0);
        }
        node.asMatrix = dice.happens(0.2);
        node.mesh = dice.happens(0.75) ? dice.below(static_cast<int>(scene.meshes.size())) : -1;
        node.hidden = dice.happens(0.04);
        scene.nodes.push_back(node);
    }
    for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
        TreeNode node;
        node.parent = dice.below(count + 1) - 1;
        node.translation = dice.vector(2.0);
        node.rotation = glm::angleAxis(dice.between(0.0, 6.0), glm::normalize(dice.vector(1.0)));
        node.light = static_cast<int>(i);
        scene.nodes.push_back(node);
    }
    // Without a camera, pictures frame everything. One that looks away from the scene now and then shows
    // nothing.
    if (dice.happens(0.4)) {
        TreeNode node;
        node.hasCamera = true;
        node.translation = dice.vector(1.0) + glm::dvec3(0.0, 0.0, 5.0);
        node.rotation = glm::angleAxis(dice.happens(0.1) ? std::numbers::pi : dice.between(-0.2, 0.2),
                                       glm::dvec3(0.0, 1.0, 0.0));
        scene.isOrthographic = dice.happens(0.3);
        scene.nodes.push_back(node);
    }
}

Lamp drawLamp(Dice& dice) {
    constexpr const char* kTypes[] = {"directional", "point", "spot"};
    Lamp lamp;
    lamp.type = kTypes[dice.below(3)];
    lamp.color = dice.vector(0.3) + 0.7;
    lamp.intensity = lamp.type == "directional" ? dice.between(0.5, 3.0) : dice.between(2.0, 30.0);
    lamp.range = lamp.type != "directional" && dice.happens(0.4) ? dice.between(3.0, 9.0) : 0.0;
    lamp.cone = dice.between(0.3, 1.2);
    return lamp;
}

// What is in candela, or in metres that no transform scales, grows with the scene.
Json lampJson(const Lamp& lamp, double scale) {
    const bool isFar = lamp.type == "directional";
    Json json{{"type", lamp.type},
              {"color", toJson(lamp.color)},
              {"intensity", lamp.intensity * (isFar ? 1.0 : scale * scale)}};
    if (lamp.range > 0.0) {
        json["range"] = lamp.range * scale;
    }
    if (lamp.type == "spot") {
        json["spot"] = {{"innerConeAngle", 0.5 * lamp.cone}, {"outerConeAngle", lamp.cone}};
    }
    return json;
}

Json cameraJson(bool isOrthographic, double scale) {
    if (isOrthographic) {
        return {{"type", "orthographic"},
                {"orthographic",
                 {{"xmag", 2.5 * scale},
                  {"ymag", 2.5 * scale},
                  {"znear", 0.01 * scale},
                  {"zfar", 50.0 * scale}}}};
    }
    return {{"type", "perspective"}, {"perspective", {{"yfov", 0.9}, {"znear", 0.01 * scale}}}};
}

// Returns a rotation whose -Z and +Y are those of the matrix, as far as they are at right angles.
glm::dquat withoutScale(const glm::dmat4& matrix) {
    const glm::dvec3 back = glm::normalize(glm::dvec3(matrix[2]));
    const glm::dvec3 upward(matrix[1]);
    const glm::dvec3 up = glm::normalize(upward - back * glm::dot(back, upward));
    return glm::quat_cast(glm::dmat3(glm::cross(up, back), up, back));
}

Json nodeJson(const TreeNode& node) {
    Json json = Json::object();
    if (node.asMatrix) {
        const glm::dmat4 matrix = node.local();
        json["matrix"] = std::vector<double>(glm::value_ptr(matrix), glm::value_ptr(matrix) + 16);
        return json;
    }
    json["translation"] = toJson(node.translation);
    json["rotation"] = toJson(node.rotation);
    json["scale"] = toJson(node.scale);
    return json;
}

}  // namespace

RandomScene::RandomScene(std::uint64_t seed) {
    auto state = std::make_unique<State>();
    state->seed = seed;
    Dice dice(seed);
    const int meshes = 1 + dice.below(3);
    for (int i = 0; i < meshes; ++i) {
        std::vector<Facets>& parts = state->meshes.emplace_back();
        do {
            parts.push_back(drawFacets(dice));
        } while (dice.happens(0.3));
    }
    const int lamps = dice.below(4);
    for (int i = 0; i < lamps; ++i) {
        state->lamps.push_back(drawLamp(dice));
    }
    drawNodes(dice, *state);
    state->place.scale = std::pow(10.0, dice.between(kLeastScaleDecade, kMostScaleDecade));
    const double reach = std::min(std::pow(10.0, kMostOffsetDecade),
                                  state->place.scale * std::pow(10.0, kMostOffsetOverScaleDecade));
    const glm::dvec3 offset = dice.vector(reach * std::pow(10.0, dice.between(-3.0, 0.0)));
    state->place.offset = {offset.x, offset.y, offset.z};
    state_ = std::move(state);
}

RandomScene::~RandomScene() = default;

const ScenePlace& RandomScene::place() const {
    return state_->place;
}

std::string RandomScene::file(const ScenePlace& place, SceneForm form) const {
    const State& scene = *state_;
    GltfBuilder builder;
    Dice dice(scene.seed + 0x517CC1B727220A95ULL);
    addTextures(builder);
    addMaterials(builder, dice);
    builder.root["extensionsUsed"].push_back("KHR_node_visibility");
    for (const Lamp& lamp : scene.lamps) {
        builder.root["extensions"]["KHR_lights_punctual"]["lights"].push_back(lampJson(lamp, place.scale));
    }
    Json top{{"translation", place.offset}, {"scale", {place.scale, place.scale, place.scale}}};
    top["children"] = Json::array();
    if (form == SceneForm::Tree) {
        for (const std::vector<Facets>& mesh : scene.meshes) {
            addMesh(builder, mesh, glm::dmat4(1.0));
        }
    }
    // The nodes of the tree keep their numbers; the one that places them comes last.
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const TreeNode& node = scene.nodes[i];
        const bool isBaked = form == SceneForm::Baked;
        Json json = isBaked ? Json::object() : nodeJson(node);
        const bool isHidden = isBaked ? scene.isHidden(i) : node.hidden;
        if (isHidden) {
            json["extensions"]["KHR_node_visibility"]["visible"] = false;
        }
        if (node.mesh >= 0) {
            const std::vector<Facets>& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
            json["mesh"] = isBaked ? addMesh(builder, mesh, scene.world(i)) : node.mesh;
        }
        if (isBaked && (node.hasCamera || node.light >= 0)) {
            const glm::dmat4 world = scene.world(i);
            json["translation"] = toJson(glm::dvec3(world[3]));
            json["rotation"] = toJson(withoutScale(world));
        }
        if (node.light >= 0) {
            json["extensions"]["KHR_lights_punctual"]["light"] = node.light;
        }
        if (node.hasCamera) {
            json["camera"] = builder.append("cameras", cameraJson(scene.isOrthographic, place.scale));
        }
        const int index = builder.append("nodes", std::move(json));
        if (isBaked || node.parent < 0) {
            top["children"].push_back(index);
        } else {
            builder.root["nodes"][static_cast<std::size_t>(node.parent)]["children"].push_back(index);
        }
    }
    const int root = builder.append("nodes", std::move(top));
    builder.append("scenes", {{"nodes", {root}}});
    builder.root["scene"] = 0;
    return builder.text();
}

std::string everyRandomMaterial() {
    GltfBuilder builder;
    Dice dice(0);
    addTextures(builder);
    addMaterials(builder, dice);
    for (int material = 0; material < kMaterials; ++material) {
        for (int choice = 0; choice < kAttributeChoices; ++choice) {
            Facets facets = drawFacets(dice);
            facets.material = material;
            facets.has = attributesOf(choice);
            builder.append("nodes", {{"mesh", addMesh(builder, {facets}, glm::dmat4(1.0))}});
        }
    }
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}}};
    builder.append("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    return builder.text();
}

}  // namespace glint::testing
