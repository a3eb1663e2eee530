// A scene gives the same picture wherever it is and however large it is: one that is moved by up to a
// thousand million times its size, or scaled by up to a million, against the one at the origin. Intensities
// of lights scale with the square of lengths. The packages, scenes and pipelines are the same for all places,
// because places are data.
#include "base/vectors.h"
#include "gltf/motion/transform.h"
#include "render/harness.h"
#include "render/light_pictures.h"
#include "render/scene_builder.h"
#include "render/ways.h"
#include "support/must.h"
#include "support/nightly.h"

#include <glint/session/camera.h>
#include <glint/session/scene_view.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr std::uint32_t kWidth = 40;
constexpr std::uint32_t kHeight = 24;
constexpr std::uint32_t kSamples = 2;
// A pixel differs if a channel does by more than this. Rounding moves edges and decides a few choices of
// random numbers otherwise, so some may.
constexpr double kDifferent = 0.02;
constexpr double kMostDifferent = 0.01;  // share of the pixels

struct Place {
    double scale = 1.0;
    double distance = 0.0;  // from the world's origin, in units of the scale
};

std::string nameOf(const Place& place) {
    return fmt::format("scaled by {:g}, moved by {:g} times that", place.scale, place.distance);
}

// A tiled floor with a mirror and a lamp of triangles, under a spherical lamp and a spot with a range. All
// lengths that a file may give are there.
gltf::Scene tiledRoom() {
    gltf::Scene scene = emptyScene();
    materials::Material tiles;
    tiles["metallicFactor"] = 0.0F;
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 64; ++i) {
        const auto tile = static_cast<std::uint8_t>((i + i / 8) % 2 == 0 ? 230 : 60);
        texels.insert(texels.end(), {tile, tile, 200, 255});
    }
    tiles.texture("baseColorTexture").texture = addTexture(scene, 8, 8, texels);
    scene.samplers.back() = gltf::Sampler{};
    addQuad(scene, tiles, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
    addQuad(scene, mirrorMaterial(), {-1, 0, -2}, {3, 0, 0}, {0, 2, 0.25F});
    materials::Material red = tiles;
    red.texture("baseColorTexture").texture = -1;
    red["baseColorFactor"] = {0.8F, 0.1F, 0.1F, 1.0F};
    addQuad(scene, red, {-2, 0, -1}, {0.75F, 0, 0.5F}, {0, 1, 0});
    materials::Material lamp = red;
    lamp["emissiveFactor"] = {1.0F, 0.7F, 0.3F};
    lamp["emissiveStrength"] = 4.0F;
    addQuad(scene, lamp, {-2.5F, 0.5F, 1}, {0, 0, -1}, {0, 1, 0});
    gltf::Light point;
    point.type = gltf::LightType::Point;
    point.position = {1.0, 2.5, 1.0};
    point.intensity = 12.0F;
    scene.lights.push_back(point);
    gltf::Light spot = point;
    spot.type = gltf::LightType::Spot;
    spot.position = {-0.5, 3.0, 2.0};
    spot.direction = {0.0F, -0.8F, -0.6F};
    spot.range = 8.0F;
    spot.intensity = 20.0F;
    scene.lights.push_back(spot);
    gltf::Camera camera;
    camera.yfov = 0.9;
    camera.world = {1, 0, 0, 0, 0, 0.96, -0.28, 0, 0, 0.28, 0.96, 0, 0.25, 2, 5.5, 1};
    scene.cameras.push_back(camera);
    return scene;
}

constexpr double kRoomLampRadius = 0.25;

glm::dvec3 offsetOf(const Place& place) {
    return place.scale * place.distance * glm::dvec3(1.0, 0.125, -0.75);
}

gltf::Matrix4 placed(const Place& place, const gltf::Matrix4& world) {
    gltf::Matrix4 moved = gltf::multiply(scaling(place.scale, place.scale, place.scale), world);
    for (int axis = 0; axis < 3; ++axis) {
        moved[12 + static_cast<std::size_t>(axis)] += offsetOf(place)[axis];
    }
    return moved;
}

gltf::Scene placed(const Place& place, gltf::Scene scene) {
    for (gltf::Node& node : scene.nodes) {
        node.world = placed(place, node.world);
    }
    for (gltf::Light& light : scene.lights) {
        light.position = base::toArray(place.scale * base::toVector(light.position) + offsetOf(place));
        light.range *= static_cast<float>(place.scale);
        light.intensity *= static_cast<float>(place.scale * place.scale);
    }
    for (gltf::Camera& camera : scene.cameras) {
        gltf::Matrix4 world = camera.world;
        for (std::size_t axis = 12; axis < 15; ++axis) {
            world[axis] *= place.scale;
        }
        camera.world = placed({1.0, place.scale * place.distance}, world);
        camera.znear *= place.scale;
    }
    return scene;
}

void sizeRoomLamps(double scale, session::SceneViewData& data) {
    for (LightView& light : data.lights) {
        light.size = static_cast<float>(kRoomLampRadius * scale);
    }
}

compiler::CompileSettings roomSettings() {
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.effects = {false, compiler::builtinEffects({"shadow", "reflection", "indirect-diffuse"})};
    settings.effects.maxReflectionRoughness = 1.0F;
    settings.emissiveLights = compiler::EmissiveLights::On;
    settings.lightSamples = 2;
    settings.maxBounces = 2;
    settings.sampleRecord = package::SampleRecordFormat::Packed;  // has lengths in few bits
    return settings;
}

FrameOptions frameOf(const gltf::Scene& scene) {
    FrameOptions frame;
    frame.maxReflectionRoughness = 1.0F;
    frame.bounces = 2;
    frame.screenSteps = 8;
    if (const Result<CameraView> camera =
            session::sceneCamera(scene, 0, static_cast<double>(kWidth) / kHeight)) {
        frame.camera = *camera;
    }
    return frame;
}

struct Difference {
    double worst = 0.0;
    double share = 0.0;  // of pixels that differ
};

Difference differenceOf(const LinearImage& image, const LinearImage& reference) {
    Difference difference;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        double most = 0.0;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double error = std::abs(double{image.pixels[i][channel]} - reference.pixels[i][channel]);
            EXPECT_TRUE(std::isfinite(error));
            most = std::max(most, error / std::max(1.0F, reference.pixels[i][channel]));
        }
        difference.worst = std::max(difference.worst, most);
        difference.share += most > kDifferent ? 1.0 / static_cast<double>(reference.pixels.size()) : 0.0;
    }
    return difference;
}

// A renderer of the room, whose scene is moved from place to place.
class MovedRoom {
public:
    MovedRoom(const LoadedScene& loaded, const Way& way)
        : loaded_(&loaded), room_(tiledRoom()), data_(session::makeSceneView(room_)) {
        RendererOptions options = optionsOf(way);
        options.width = kWidth;
        options.height = kHeight;
        options.bounces = 2;
        options.screenMarch = true;
        renderer_ = loaded.makeRenderer(options);
    }

    LinearImage at(const Place& place) {
        const gltf::Scene moved = placed(place, room_);
        session::poseSceneView(moved, data_);
        sizeRoomLamps(place.scale, data_);
        must(loaded_->gpuScene().updateAndWait(data_.motion()));
        return drawn(*renderer_, frameOf(moved), kSamples);
    }

private:
    const LoadedScene* loaded_;
    gltf::Scene room_;
    session::SceneViewData data_;
    std::unique_ptr<Renderer> renderer_;
};

std::vector<Place> places() {
    std::vector<Place> places{{1.0, 1e3}, {1.0, 1e6}, {1e5, 0.0}, {1e-4, 1e9}};
    if (test::nightly()) {
        places.clear();
        for (int scale = -6; scale <= 6; ++scale) {
            places.push_back({std::pow(10.0, scale), 0.0});
            for (int distance = 0; distance <= 9; ++distance) {
                places.push_back({std::pow(10.0, scale), std::pow(10.0, distance)});
            }
        }
    }
    return places;
}

// Each row of the nightly table: the worst of a decade, over all of the other kind, in all ways.
void note(std::vector<std::pair<std::string, Difference>>& rows, const std::string& name,
          const Difference& difference) {
    const auto known = std::ranges::find(rows, name, &std::pair<std::string, Difference>::first);
    if (known == rows.end()) {
        rows.emplace_back(name, difference);
        return;
    }
    known->second.worst = std::max(known->second.worst, difference.worst);
    known->second.share = std::max(known->second.share, difference.share);
}

TEST(SceneOrigin, PictureIsTheSameAtEachPlaceAndScale) {
    std::vector<std::pair<std::string, Difference>> rows;
    const auto visit = [&](const LoadedScene& loaded, const Way& way) {
        MovedRoom moved(loaded, way);
        const LinearImage reference = moved.at({});
        EXPECT_GT(meanOf(reference), 0.05) << "there is light to compare";
        for (const Place& place : places()) {
            const Difference difference = differenceOf(moved.at(place), reference);
            EXPECT_LE(difference.share, kMostDifferent) << nameOf(place) << ": worst " << difference.worst;
            note(rows, fmt::format("scale {:g}", place.scale), difference);
            note(rows, fmt::format("distance {:g}", place.distance), difference);
        }
    };
    forEachWay(tiledRoom(), roomSettings(), visit, [](session::SceneViewData& data) {
        data.moves = true;
        sizeRoomLamps(1.0, data);
    });
    for (const auto& [name, difference] : rows) {
        std::cout << fmt::format("{}: worst {:.2g}, {:.2f} % of pixels differ\n", name, difference.worst,
                                 100.0 * difference.share);
    }
}

}  // namespace
