#include "gltf/planning_inputs.h"

#include "base/vectors.h"
#include "gltf/motion/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace glint::gltf {

namespace {

glm::dvec3 column(const Matrix4& matrix, std::size_t index) {
    return {matrix[4 * index], matrix[4 * index + 1], matrix[4 * index + 2]};
}

// The columns of the cofactors of the upper 3 x 3 matrix, which transform area vectors to the world.
using Cofactors = glm::dmat3;

Cofactors cofactorsOf(const Matrix4& matrix) {
    const glm::dvec3 x = column(matrix, 0);
    const glm::dvec3 y = column(matrix, 1);
    const glm::dvec3 z = column(matrix, 2);
    return {glm::cross(y, z), glm::cross(z, x), glm::cross(x, y)};
}

glm::dvec3 edge(const Primitive& primitive, std::uint32_t from, std::uint32_t to) {
    return base::toVector(primitive.positions[to]) - base::toVector(primitive.positions[from]);
}

double areaOf(const Primitive& primitive, const Cofactors& cofactors) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        const std::uint32_t corner = primitive.indices[i];
        const glm::dvec3 local = glm::cross(edge(primitive, corner, primitive.indices[i + 1]),
                                            edge(primitive, corner, primitive.indices[i + 2]));
        sum += 0.5 * glm::length(cofactors * local);
    }
    return std::isfinite(sum) ? sum : 0.0;
}

// A place where a mesh is drawn, and how many placements it stands for.
struct Place {
    Cofactors cofactors{};
    double count = 1.0;
};

// If there are more instances than this, an even selection of them is used, because a shear or an uneven
// scale costs a pass over the triangles for each instance.
constexpr std::size_t kMaxInstances = 1024;

void addPlaces(const Scene& scene, const Node& node, std::vector<Place>& places) {
    if (node.instancing < 0) {
        places.push_back({cofactorsOf(node.world)});
        return;
    }
    const Instancing& instancing = scene.instancings[static_cast<std::size_t>(node.instancing)];
    const std::size_t taken = std::min(instancing.count, kMaxInstances);
    for (std::size_t i = 0; i < taken; ++i) {
        const Matrix4 local = gltf::instanceTransform(instancing, i * instancing.count / taken);
        places.push_back({cofactorsOf(gltf::multiply(node.world, local)),
                          static_cast<double>(instancing.count) / static_cast<double>(taken)});
    }
}

// Returns the factor by which the upper 3 x 3 matrix scales every area. It is negative if the factor depends
// on the direction.
double uniformAreaScale(const Cofactors& cofactors) {
    // Single precision makes the columns of a rotation differ by less than this.
    constexpr double kTolerance = 1e-5;
    const double scale = glm::dot(cofactors[0], cofactors[0]);
    for (glm::length_t i = 0; i < 3; ++i) {
        const double off = glm::dot(cofactors[i], cofactors[(i + 1) % 3]);
        if (std::abs(glm::dot(cofactors[i], cofactors[i]) - scale) > kTolerance * scale ||
            std::abs(off) > kTolerance * scale) {
            return -1.0;
        }
    }
    return std::sqrt(scale);
}

// Returns the area at each place of a mesh. One pass over the triangles serves all places with a uniform
// scale.
std::vector<double> areasOf(const Primitive& primitive, const std::vector<Place>& places) {
    const double local = places.empty() ? 0.0 : areaOf(primitive, Cofactors(1.0));
    std::vector<double> areas;
    areas.reserve(places.size());
    for (const Place& place : places) {
        const double scale = uniformAreaScale(place.cofactors);
        const double area = scale >= 0.0 ? scale * local : areaOf(primitive, place.cofactors);
        areas.push_back(std::isfinite(area) ? area : 0.0);
    }
    return areas;
}

// Returns the median of the areas above 0, or 0 if there is none.
double medianOf(const std::vector<std::vector<double>>& areas) {
    std::vector<double> all;
    for (const std::vector<double>& list : areas) {
        std::ranges::copy_if(list, std::back_inserter(all), [](double area) { return area > 0.0; });
    }
    if (all.empty()) {
        return 0.0;
    }
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::ranges::nth_element(all, middle);
    return *middle;
}

// Returns a bit for each of the model's attributes that the primitive has.
std::uint64_t attributesOf(const Scene& scene, const Primitive& primitive) {
    if (primitive.attributes.empty()) {
        return 0;
    }
    const std::vector<materials::VertexAttribute>& known =
        scene.materials[static_cast<std::size_t>(primitive.material)].model().attributes;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < known.size(); ++i) {
        const bool given = std::ranges::find(primitive.attributes, known[i].gltf, &VertexValues::name) !=
                           primitive.attributes.end();
        bits |= std::uint64_t{given} << i;
    }
    return bits;
}

}  // namespace

void expectHits(const Scene& scene, std::vector<materials::PrimitiveInputs>& inputs) {
    constexpr double kMedians = 10.0;
    std::vector<std::vector<Place>> places(scene.meshes.size());
    for (const Node& node : scene.nodes) {
        if (node.mesh >= 0 && node.canShow) {
            addPlaces(scene, node, places[static_cast<std::size_t>(node.mesh)]);
        }
    }
    std::vector<std::vector<double>> areas;
    areas.reserve(inputs.size());
    for (const materials::PrimitiveInputs& input : inputs) {
        const auto mesh = static_cast<std::size_t>(input.mesh);
        const Primitive& primitive = scene.meshes[mesh].primitives[static_cast<std::size_t>(input.primitive)];
        areas.push_back(areasOf(primitive, places[mesh]));
    }
    const double large = kMedians * medianOf(areas);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        inputs[i].expectedHits = 0.0;
        const std::vector<Place>& own = places[static_cast<std::size_t>(inputs[i].mesh)];
        for (std::size_t k = 0; k < own.size(); ++k) {
            const double area = areas[i][k];
            inputs[i].expectedHits += area > 0.0 ? own[k].count * area / (area + large) : 0.0;
        }
    }
}

std::string sceneLabel(const Scene& scene, std::size_t number) {
    const std::string& name = scene.scenesInFile[number];
    return name.empty() ? std::to_string(number) : fmt::format("{} \"{}\"", number, name);
}

SceneInFile sceneInFile(const Scene& scene) {
    const int index = scene.sceneInFile;
    return {index, index < 0 ? "" : scene.scenesInFile[static_cast<std::size_t>(index)]};
}

materials::PrimitiveInputs inputsOf(const Scene& scene, std::size_t mesh, std::size_t index) {
    const Primitive& primitive = scene.meshes[mesh].primitives[index];
    materials::PrimitiveInputs input;
    input.mesh = static_cast<int>(mesh);
    input.primitive = static_cast<int>(index);
    input.material = primitive.material;
    input.hasNormals = !primitive.normals.empty();
    input.hasTangents = !primitive.tangents.empty();
    input.hasTexCoords0 = !primitive.texCoords0.empty();
    input.hasTexCoords1 = !primitive.texCoords1.empty();
    input.colors = primitive.colorContent;
    input.attributes = attributesOf(scene, primitive);
    input.seen = primitive.seen;
    input.derivesTangents = primitive.derivesTangents;
    return input;
}

std::vector<materials::PrimitiveInputs> planningInputs(const Scene& scene) {
    std::vector<materials::PrimitiveInputs> inputs;
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        for (std::size_t i = 0; i < scene.meshes[mesh].primitives.size(); ++i) {
            inputs.push_back(inputsOf(scene, mesh, i));
        }
    }
    expectHits(scene, inputs);
    return inputs;
}

std::vector<materials::Material> planningMaterials(const Scene& scene) {
    std::vector<materials::Material> materials = scene.materials;
    for (const AnimatedMaterial& animated : scene.animatedMaterials) {
        materials[static_cast<std::size_t>(animated.material)] = animated.planned;
    }
    return materials;
}

}  // namespace glint::gltf
