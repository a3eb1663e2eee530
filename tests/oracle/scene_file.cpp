#include "oracle/scene_file.h"

#include "support/must.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace glint::oracle {
namespace {

std::vector<float> flatten(const std::vector<Vec3>& vectors) {
    std::vector<float> numbers;
    for (const Vec3& v : vectors) {
        for (int axis = 0; axis < 3; ++axis) {
            numbers.push_back(static_cast<float>(v[axis]));
        }
    }
    return numbers;
}

Json array(const Vec3& v) {
    return Json::array({v.x, v.y, v.z});
}

// The -Z axis points from one place to the other, and +Y as far upwards as possible.
Json lookingAt(const Vec3& from, const Vec3& to) {
    const Vec3 backwards = glm::normalize(from - to);
    const Vec3 up = std::abs(backwards.y) < 0.999 ? Vec3(0.0, 1.0, 0.0) : Vec3(0.0, 0.0, -1.0);
    const Vec3 right = glm::normalize(glm::cross(up, backwards));
    Json matrix = Json::array();
    for (const Vec3& column : {right, glm::cross(backwards, right), backwards, from}) {
        for (int row = 0; row < 3; ++row) {
            matrix.push_back(column[row]);
        }
        matrix.push_back(matrix.size() == 15 ? 1.0 : 0.0);
    }
    return matrix;
}

}  // namespace

void SceneFile::declare(const std::string& extension) {
    Json& used = builder_.root["extensionsUsed"];
    if (std::find(used.begin(), used.end(), extension) == used.end()) {
        used.push_back(extension);
    }
}

int SceneFile::addMaterial(Json material) {
    if (material.contains("extensions")) {
        for (const auto& [name, value] : material["extensions"].items()) {
            declare(name);
        }
    }
    return builder_.append("materials", std::move(material));
}

void SceneFile::addMesh(int material, const std::vector<Vec3>& positions, const std::vector<Vec3>& normals,
                        const std::vector<Vec3>& colors, const std::vector<std::uint32_t>& indices) {
    const int position = builder_.addAccessor(flatten(positions), 3);
    Json primitive{
        {"material", material},
        {"attributes", {{"POSITION", position}, {"NORMAL", builder_.addAccessor(flatten(normals), 3)}}}};
    if (!colors.empty()) {
        primitive["attributes"]["COLOR_0"] = builder_.addAccessor(flatten(colors), 3);
    }
    primitive["indices"] = builder_.addAccessor(indices, 1);
    builder_.addMesh(std::move(primitive));
}

void SceneFile::addColoredQuad(int material, const Vec3& corner, const Vec3& right, const Vec3& up,
                               const std::vector<Vec3>& colors) {
    addMesh(material, {corner, corner + right, corner + right + up, corner + up},
            std::vector<Vec3>(4, glm::normalize(glm::cross(right, up))), colors, {0, 1, 2, 0, 2, 3});
}

void SceneFile::addQuad(int material, const Vec3& corner, const Vec3& right, const Vec3& up) {
    addColoredQuad(material, corner, right, up, {});
}

void SceneFile::addDisk(int material, const Vec3& center, const Vec3& axis, double radius, int corners) {
    const glm::dmat3 frame = frameAbout(glm::normalize(axis));
    const double angle = 2.0 * kPi / corners;
    const double outer = radius * std::sqrt(angle / std::sin(angle));
    std::vector<Vec3> positions{center};
    std::vector<std::uint32_t> indices;
    for (int i = 0; i < corners; ++i) {
        positions.push_back(center + frame * (outer * Vec3(std::cos(angle * i), std::sin(angle * i), 0.0)));
        const auto here = static_cast<std::uint32_t>(i + 1);
        indices.insert(indices.end(), {0, here, here % static_cast<std::uint32_t>(corners) + 1});
    }
    addMesh(material, positions, std::vector<Vec3>(positions.size(), frame[2]), {}, indices);
}

void SceneFile::addSphere(int material, const Vec3& center, double radius, int rings) {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    std::vector<std::uint32_t> indices;
    const int around = 2 * rings;
    for (int ring = 0; ring <= rings; ++ring) {
        const double theta = kPi * ring / rings;
        for (int step = 0; step <= around; ++step) {
            const double phi = 2.0 * kPi * (step % around) / around;
            normals.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                                 -std::sin(theta) * std::sin(phi));
            positions.push_back(center + radius * normals.back());
        }
    }
    for (int ring = 0; ring < rings; ++ring) {
        for (int step = 0; step < around; ++step) {
            const auto first = static_cast<std::uint32_t>(ring * (around + 1) + step);
            const auto below = first + static_cast<std::uint32_t>(around + 1);
            if (ring > 0) {
                indices.insert(indices.end(), {first, below, first + 1});
            }
            if (ring + 1 < rings) {
                indices.insert(indices.end(), {first + 1, below, below + 1});
            }
        }
    }
    addMesh(material, positions, normals, {}, indices);
}

void SceneFile::addBox(const std::vector<int>& materials, const Vec3& low, const Vec3& high, bool inwards) {
    const Vec3 size = high - low;
    const std::array<Vec3, 3> edges{Vec3(size.x, 0.0, 0.0), Vec3(0.0, size.y, 0.0), Vec3(0.0, 0.0, size.z)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool upper : {false, true}) {
            const Vec3 corner = upper ? low + edges[axis] : low;
            // first × second points along the axis.
            Vec3 first = edges[(axis + 1) % 3];
            Vec3 second = edges[(axis + 2) % 3];
            if (upper == inwards) {
                std::swap(first, second);
            }
            addQuad(materials[2 * axis + (upper ? 1 : 0)], corner, first, second);
        }
    }
}

void SceneFile::addCamera(const Vec3& from, const Vec3& to, double verticalDegrees) {
    const int camera = builder_.append(
        "cameras", {{"type", "perspective"},
                    {"perspective", {{"yfov", verticalDegrees * kPi / 180.0}, {"znear", 0.01}}}});
    builder_.append("nodes", {{"camera", camera}, {"matrix", lookingAt(from, to)}});
}

void SceneFile::addLight(Json light, const Vec3& from, const Vec3& to) {
    declare("KHR_lights_punctual");
    Json& lights = builder_.root["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(std::move(light));
    builder_.append("nodes", {{"matrix", lookingAt(from, to)},
                              {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}});
}

void SceneFile::addDarkness() {
    addLight({{"type", "directional"}, {"intensity", 0.0}}, {0, 1, 0}, {0, 0, 0});
}

gltf::Scene SceneFile::import() const {
    const gltf::Scene scene = must(test::import(builder_));
    for (const Diagnostic& warning : test::readingWarnings(scene)) {
        ADD_FAILURE() << toString(warning);
    }
    return scene;
}

Json diffuseMaterial(const Vec3& color, bool doubleSided) {
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {color.x, color.y, color.z, 1.0}},
              {"metallicFactor", 0.0},
              {"roughnessFactor", 1.0}}},
            {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0.0}}}}},
            {"doubleSided", doubleSided}};
}

Json unlitMaterial(const Vec3& color, bool doubleSided) {
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {color.x, color.y, color.z, 1.0}},
              {"metallicFactor", 0.0},
              {"roughnessFactor", 1.0}}},
            {"extensions", {{"KHR_materials_unlit", Json::object()}}},
            {"doubleSided", doubleSided}};
}

Json emissiveMaterial(const Vec3& radiance) {
    const double strength = std::max({radiance.x, radiance.y, radiance.z, 1.0});
    Json material = diffuseMaterial(Vec3(0.0));
    material["emissiveFactor"] = array(radiance / strength);
    material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
    return material;
}

Json glassMaterial(const Glass& glass) {
    Json material{{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.0}}},
                  {"extensions",
                   {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
                    {"KHR_materials_ior", {{"ior", glass.ior}}}}}};
    Json& extensions = material["extensions"];
    if (glass.thickness > 0.0) {
        extensions["KHR_materials_volume"] = {{"thicknessFactor", glass.thickness}};
        if (glass.attenuationDistance > 0.0) {
            extensions["KHR_materials_volume"]["attenuationDistance"] = glass.attenuationDistance;
            extensions["KHR_materials_volume"]["attenuationColor"] = array(glass.attenuationColor);
        }
    }
    if (glass.dispersion > 0.0) {
        extensions["KHR_materials_dispersion"] = {{"dispersion", glass.dispersion}};
    }
    return material;
}

}  // namespace glint::oracle
