#include "oracle/spec/device.h"

#include "support/effect_bits.h"
#include "support/must.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::spec {
namespace {

// Half the width of a view. At the most grazing one it covers half of a plane, which is 2 metres wide.
constexpr float kHalfWidth = 0.05F;

std::array<float, 3> toFloats(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

Json matrixOf(const glm::dmat3& frame, const Vec3& origin) {
    Json matrix = Json::array();
    for (int column = 0; column < 4; ++column) {
        const Vec3& v = column < 3 ? frame[column] : origin;
        for (int i = 0; i < 3; ++i) {
            matrix.push_back(v[i]);
        }
        matrix.push_back(column < 3 ? 0.0 : 1.0);
    }
    return matrix;
}

void declareExtensions(const Json& object, Json& used) {
    if (!object.contains("extensions")) {
        return;
    }
    for (const auto& [name, value] : object["extensions"].items()) {
        if (std::find(used.begin(), used.end(), name) == used.end()) {
            used.push_back(name);
        }
    }
}

// Adds a closed sphere of radius 1 with smooth normals.
class SphereShape {
public:
    explicit SphereShape(test::GltfBuilder& file) {
        constexpr int kRings = 48;
        std::vector<float> points;
        std::vector<std::uint32_t> indices;
        for (int ring = 0; ring <= kRings; ++ring) {
            for (int step = 0; step <= 2 * kRings; ++step) {
                const double polar = kPi * ring / kRings;
                const double azimuth = kPi * (step % (2 * kRings)) / kRings;
                points.push_back(static_cast<float>(std::sin(polar) * std::cos(azimuth)));
                points.push_back(static_cast<float>(std::cos(polar)));
                points.push_back(static_cast<float>(-std::sin(polar) * std::sin(azimuth)));
            }
        }
        for (int ring = 0; ring < kRings; ++ring) {
            for (int step = 0; step < 2 * kRings; ++step) {
                const auto first = static_cast<std::uint32_t>(ring * (2 * kRings + 1) + step);
                const auto below = first + static_cast<std::uint32_t>(2 * kRings + 1);
                if (ring > 0) {
                    indices.insert(indices.end(), {first, below, first + 1});
                }
                if (ring + 1 < kRings) {
                    indices.insert(indices.end(), {first + 1, below, below + 1});
                }
            }
        }
        positions_ = file.addAccessor(points, 3);
        file.root["accessors"][static_cast<std::size_t>(positions_)]["min"] = {-1, -1, -1};
        file.root["accessors"][static_cast<std::size_t>(positions_)]["max"] = {1, 1, 1};
        normals_ = file.addAccessor(points, 3);
        indices_ = file.addAccessor(indices, 1);
    }
    void add(test::GltfBuilder& file, int material, const Vec3& center) const {
        file.addMesh({{"material", material},
                      {"indices", indices_},
                      {"attributes", {{"POSITION", positions_}, {"NORMAL", normals_}}}});
        file.root["nodes"].back()["matrix"] = matrixOf(glm::dmat3(1.0), center);
    }

private:
    int positions_ = 0;
    int normals_ = 0;
    int indices_ = 0;
};

void addLights(test::GltfBuilder& file) {
    file.root["extensionsUsed"].push_back("KHR_lights_punctual");
    for (const Light& light : lightsOfScene()) {
        const double intensity = largest(light.irradiance);
        const Vec3 color = light.irradiance / intensity;
        Json& lights = file.root["extensions"]["KHR_lights_punctual"]["lights"];
        lights.push_back(
            {{"type", "directional"}, {"color", {color.x, color.y, color.z}}, {"intensity", intensity}});
        // A light shines along its node's -Z.
        file.append("nodes", {{"matrix", matrixOf(oracle::frameAbout(light.direction), Vec3(0.0))},
                              {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}});
    }
}

// Returns the file as Glint imports it. The pixels of textures are put in afterwards, because no file format
// has to be read to compare what they mean.
Result<gltf::Scene> sceneOf(const Rows& rows) {
    test::GltfBuilder file;
    file.root["extensionsUsed"] = Json::array();
    const int positions = file.addAccessor<float>({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, 3);
    file.root["accessors"][static_cast<std::size_t>(positions)]["min"] = {-1, -1, 0};
    file.root["accessors"][static_cast<std::size_t>(positions)]["max"] = {1, 1, 0};
    const int normals = file.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    const int tangents = file.addAccessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, 4);
    const int coordinates = file.addAccessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, 2);
    const int indices = file.addAccessor<std::uint32_t>({0, 1, 2, 0, 2, 3}, 1);
    const SphereShape sphere(file);
    for (std::size_t i = 0; i < rows.texels.size(); ++i) {
        file.append("images", {{"name", std::to_string(i)},
                               {"uri", std::string("data:image/png;base64,") + test::kPng8}});
        file.append("textures", {{"source", i}});
    }
    for (std::size_t i = 0; i < rows.rows.size(); ++i) {
        const Row& row = rows.rows[i];
        declareExtensions(row.material, file.root["extensionsUsed"]);
        const int material = file.append("materials", row.material);
        if (row.sphere) {
            sphere.add(file, material, planeOf(rows.rows.size() + i).center);
        }
        file.addMesh({{"material", material},
                      {"indices", indices},
                      {"attributes",
                       {{"POSITION", positions},
                        {"NORMAL", normals},
                        {"TANGENT", tangents},
                        {"TEXCOORD_0", coordinates}}}});
        const Plane plane = planeOf(i);
        file.root["nodes"].back()["matrix"] = matrixOf(plane.frame, plane.center);
    }
    addLights(file);
    Result<gltf::Scene> scene = test::import(file);
    if (scene) {
        // Images that no material uses are left out.
        for (gltf::Image& image : scene->images) {
            const Texel& texel = rows.texels.at(std::stoul(image.name));
            image.width = image.height = 1;
            image.pixels.assign(texel.begin(), texel.end());
        }
    }
    return scene;
}

Measured average(const LinearImage& image) {
    Measured result;
    Vec3 squares(0.0);
    const auto count = static_cast<double>(image.pixels.size());
    for (const auto& pixel : image.pixels) {
        const Vec3 value(pixel[0], pixel[1], pixel[2]);
        result.mean += value / count;
        squares += value * value / count;
    }
    result.error =
        glm::sqrt(glm::max(squares - result.mean * result.mean, Vec3(0.0)) / std::max(count - 1.0, 1.0));
    return result;
}

}  // namespace

Device::Device(const Rows& rows, const DeviceOptions& options)
    : options_(options), rowCount_(rows.rows.size()) {
    const gltf::Scene scene = must(sceneOf(rows));
    for (const Diagnostic& warning : scene.warnings) {
        ADD_FAILURE() << toString(warning);
    }
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.environmentMap = true;
    settings.energyCompensation = options.compensation;
    settings.effects = {
        false, package::kEffectReflection | package::kEffectRefraction | package::kEffectIndirectDiffuse,
        1.0F};
    loaded_ = std::make_unique<testing::LoadedScene>(scene, settings);
    RendererOptions wanted;
    wanted.strategy = package::kStrategyUber;
    wanted.width = wanted.height = options.size;
    renderer_ = loaded_->makeRenderer(wanted);
}

Device::~Device() {}

std::unique_ptr<Environment> Device::makeEnvironment(const Map& map) {
    LinearImage image{static_cast<std::uint32_t>(map.width()), static_cast<std::uint32_t>(map.height()), {}};
    for (const Vec3& texel : map.texels()) {
        const auto color = toFloats(texel);
        image.pixels.push_back({color[0], color[1], color[2], 1.0F});
    }
    return must(Environment::create(testing::sharedContext(), image, {.sampled = true}));
}

LinearImage Device::picture(const Vec3& center, const Vec3& direction, float halfWidth, FrameOptions frame,
                            std::uint32_t samples) {
    const glm::dmat3 camera = oracle::frameAbout(direction);
    const Vec3 eye = center + 2.0 * camera[2];
    frame.camera.position = {eye.x, eye.y, eye.z};
    frame.camera.forward = toFloats(-camera[2]);
    frame.camera.up = toFloats(camera[1]);
    frame.camera.orthographic = true;
    frame.camera.halfWidth = frame.camera.halfHeight = halfWidth;
    frame.camera.far = 4.0F;
    frame.maxReflectionRoughness = 1.0F;
    return must(renderer_->render(frame, samples));
}

Measured Device::render(std::size_t row, const View& view, FrameOptions frame, std::uint32_t samples) {
    const Plane plane = planeOf(row);
    return average(picture(plane.center, plane.frame * view.local, kHalfWidth, frame, samples));
}

std::array<Measured, 3> Device::onSphere(std::size_t row, const Environment& map, Transport transport) {
    constexpr float kSphereHalfWidth = 1.05F;
    const Vec3 center = planeOf(rowCount_ + row).center;
    const Vec3 direction = glm::normalize(Vec3(0.3, 0.4, 0.8));
    FrameOptions lit;
    lit.environment = &map;
    if (transport == Transport::Untraced) {
        lit.effects = 0;
    }
    FrameOptions dark = lit;
    dark.environmentIntensity = 0.0F;
    dark.effects = 0;
    const LinearImage all = picture(center, direction, kSphereHalfWidth, lit, options_.samples);
    const LinearImage lights = picture(center, direction, kSphereHalfWidth, dark, options_.samples);
    std::array<LinearImage, 3> zones;
    for (std::size_t i = 0; i < all.pixels.size() && i < lights.pixels.size(); ++i) {
        const double scale = 2.0 * kSphereHalfWidth / all.width;
        const double x = (static_cast<double>(i % all.width) + 0.5) * scale - kSphereHalfWidth;
        const double y = (static_cast<double>(i / all.width) + 0.5) * scale - kSphereHalfWidth;
        const double cosine = std::sqrt(std::max(1.0 - x * x - y * y, 0.0));
        if (cosine > 0.1) {
            std::array<float, 4> pixel = all.pixels[i];
            for (std::size_t channel = 0; channel < 3; ++channel) {
                pixel[channel] -= lights.pixels[i][channel];
            }
            zones[cosine > 0.7 ? 0 : cosine > 0.3 ? 1 : 2].pixels.push_back(pixel);
        }
    }
    return {average(zones[0]), average(zones[1]), average(zones[2])};
}

Measured Device::underLights(std::size_t row, const View& view, const Environment& any) {
    const auto [found, isNew] = lit_.try_emplace({row, view.local.x, view.local.y});
    if (isNew) {
        FrameOptions frame;
        frame.environment = &any;
        frame.environmentIntensity = 0.0F;
        frame.effects = 0;
        found->second = render(row, view, frame, 1);
    }
    return found->second;
}

Measured Device::underMap(std::size_t row, const View& view, const Environment& map, Transport transport) {
    FrameOptions frame;
    frame.environment = &map;
    const bool traced = transport == Transport::Traced;
    if (!traced) {
        frame.effects = 0;
    }
    Measured result = render(row, view, frame, traced ? options_.samples : 1);
    // The lights are part of the scene, so what they bring is taken away. Emission is then taken away too.
    result.mean -= underLights(row, view, map).mean;
    return result;
}

}  // namespace glint::spec
