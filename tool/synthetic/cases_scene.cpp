#include "synthetic/cases_scene.h"

#include "synthetic/case_materials.h"
#include "synthetic/textures.h"
#include "synthetic/tiles.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace glint::synthetic {

namespace {

// A rectangle at a height. Its front is its upper or its lower side.
struct Square {
    double x0 = 0.0;
    double z0 = 0.0;
    double x1 = 0.0;
    double z1 = 0.0;
    double height = 0.0;
    bool facesUp = true;
};

gltf::Primitive makePrimitive(const CaseMaterial& attributes, int material, std::string pointer) {
    gltf::Primitive primitive;
    primitive.pointer = std::move(pointer);
    primitive.material = material;
    primitive.colorContent =
        attributes.colors ? materials::ColorContent::Varying : materials::ColorContent::None;
    return primitive;
}

void addSquare(gltf::Primitive& primitive, const CaseMaterial& attributes, const Square& square) {
    const auto first = static_cast<std::uint32_t>(primitive.positions.size());
    for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        const double x = u == 0 ? square.x0 : square.x1;
        const double z = v == 0 ? square.z0 : square.z1;
        primitive.positions.push_back(
            {static_cast<float>(x), static_cast<float>(square.height), static_cast<float>(z)});
        primitive.texCoords0.push_back({static_cast<float>(u), static_cast<float>(v)});
        if (attributes.normals) {
            primitive.normals.push_back({0.0F, square.facesUp ? 1.0F : -1.0F, 0.0F});
        }
        if (attributes.tangents) {
            // V grows along z. That is cross(n, t) w for a square that faces down; a square that faces up
            // needs the opposite sign.
            primitive.tangents.push_back({1.0F, 0.0F, 0.0F, square.facesUp ? -1.0F : 1.0F});
        }
        if (attributes.colors) {
            const float shade = u == v ? 1.0F : 0.85F;
            primitive.colors.push_back({shade, shade, shade, 1.0F});
        }
    }
    // The order is counter-clockwise as seen from the front.
    constexpr std::uint32_t kUp[] = {0, 2, 1, 0, 3, 2};
    constexpr std::uint32_t kDown[] = {0, 1, 2, 0, 2, 3};
    for (const std::uint32_t corner : square.facesUp ? kUp : kDown) {
        primitive.indices.push_back(first + corner);
    }
}

gltf::Mesh makeFloor(const CaseMaterial& attributes, int material, double aspect) {
    constexpr double kMargin = 1.01;  // extent beyond the picture's edge
    const Extent extent = viewExtent(kCameraHeight, aspect);
    gltf::Mesh mesh{"floor", {makePrimitive(attributes, material, "/meshes/0/primitives/0")}};
    addSquare(mesh.primitives[0], attributes,
              {-kMargin * extent.x, -kMargin * extent.z, kMargin * extent.x, kMargin * extent.z, 0.0, true});
    return mesh;
}

// Makes one primitive for each case, from all of its tiles.
gltf::Mesh makeTiles(const Ceiling& ceiling, const std::vector<CaseMaterial>& cases) {
    gltf::Mesh mesh{"ceiling", {}};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        mesh.primitives.push_back(
            makePrimitive(cases[i], static_cast<int>(i), fmt::format("/meshes/1/primitives/{}", i)));
    }
    const auto edge = [&](double extent, int i) { return extent * (2.0 * i / ceiling.tiles - 1.0); };
    for (int row = 0; row < ceiling.tiles; ++row) {
        for (int column = 0; column < ceiling.tiles; ++column) {
            const auto place = ceiling.place(row, column);
            const auto index = static_cast<std::size_t>(ceiling.cases[place]);
            addSquare(
                mesh.primitives[index], cases[index],
                {edge(ceiling.extent.x, column), edge(ceiling.extent.z, row),
                 edge(ceiling.extent.x, column + 1), edge(ceiling.extent.z, row + 1), kCeilingHeight, false});
        }
    }
    return mesh;
}

gltf::Matrix4 identity() {
    return {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0};
}

// The camera looks straight down: its -Z is the world's -Y, its +Y is the world's -Z.
gltf::Camera makeCamera() {
    gltf::Camera camera;
    camera.name = "above";
    camera.yfov = kFieldOfView;
    camera.world = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0,           -1.0, 0.0,
                    0.0, 1.0, 0.0, 0.0, 0.0, kCameraHeight, 0.0,  1.0};
    return camera;
}

// Places the lights on a circle half way up. Their total flux does not depend on `count`.
void addLights(gltf::Scene& scene, int count) {
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        gltf::Light light;
        light.name = fmt::format("light {}", i);
        light.type = gltf::LightType::Point;
        light.intensity = 10.0F / static_cast<float>(count);
        light.position = {static_cast<float>(std::cos(angle)), static_cast<float>(kCeilingHeight / 2.0),
                          static_cast<float>(std::sin(angle))};
        scene.lights.push_back(std::move(light));
    }
}

gltf::Node placing(const std::string& name, int number) {
    gltf::Node node;
    node.name = name;
    node.world = identity();
    node.source = number;
    return node;
}

}  // namespace

std::string_view nameOf(Cost cost) {
    return cost == Cost::Cheap ? "cheap" : "expensive";
}

std::string_view nameOf(Coherence coherence) {
    return coherence == Coherence::Coherent ? "coherent" : "incoherent";
}

std::string_view nameOf(Shares shares) {
    return shares == Shares::Uniform ? "uniform" : "zipf";
}

gltf::Scene makeCasesScene(const CasesOptions& options) {
    gltf::Scene scene;
    scene.path = fmt::format("{}-{}-{}-{}.synthetic", options.cases, nameOf(options.cost),
                             nameOf(options.coherence), nameOf(options.shares));
    addTextures(scene);
    const std::vector<CaseMaterial> cases = makeCaseMaterials(options.cost, options.cases);
    const CaseMaterial floor = makeFloorMaterial(cases[0], options.coherence);
    for (const CaseMaterial& made : cases) {
        scene.materials.push_back(made.material);
    }
    scene.materials.push_back(floor.material);
    scene.meshes = {makeFloor(floor, options.cases, options.aspect), makeTiles(makeCeiling(options), cases)};
    for (int mesh = 0; mesh < 2; ++mesh) {
        scene.nodes.push_back(placing(scene.meshes[static_cast<std::size_t>(mesh)].name, mesh));
        scene.nodes.back().mesh = mesh;
    }
    scene.cameras = {makeCamera()};
    scene.nodes.push_back(placing("above", 2));
    scene.nodes.back().camera = 0;
    scene.nodes.back().world = scene.cameras[0].world;
    addLights(scene, options.lights);
    return scene;
}

}  // namespace glint::synthetic
