#include "base/vectors.h"
#include "support/must.h"

#include <glint/session/camera.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glint::session {
namespace {

struct Extents {
    double left = INFINITY;
    double right = -INFINITY;
    double bottom = INFINITY;
    double top = -INFINITY;

    double reach() const {
        return std::max({-left, right, -bottom, top});
    }
};

// Returns the box's corners in the image, whose edges are at -1 and 1. The result is infinite if a corner is
// behind the camera.
Extents project(const CameraView& camera, const session::Bounds& box) {
    const glm::dvec3 forward = base::toVector(camera.forward);
    const glm::dvec3 up = base::toVector(camera.up);
    const glm::dvec3 right = glm::cross(forward, up);
    Extents extents;
    for (unsigned number = 0; number < 8; ++number) {
        std::array<double, 3> offset{};
        for (std::size_t i = 0; i < 3; ++i) {
            offset[i] = (((number >> i) & 1U) != 0 ? box.max[i] : box.min[i]) - camera.position[i];
        }
        const double depth = glm::dot(base::toVector(offset), forward);
        if (depth <= camera.near) {
            return {-INFINITY, INFINITY, -INFINITY, INFINITY};
        }
        const double x = glm::dot(base::toVector(offset), right) / depth / camera.halfWidth;
        const double y = glm::dot(base::toVector(offset), up) / depth / camera.halfHeight;
        extents = {std::min(extents.left, x), std::max(extents.right, x), std::min(extents.bottom, y),
                   std::max(extents.top, y)};
    }
    return extents;
}

void expectFrame(const CameraView& camera) {
    const glm::dvec3 forward = base::toVector(camera.forward);
    const glm::dvec3 up = base::toVector(camera.up);
    EXPECT_NEAR(glm::dot(forward, forward), 1.0, 1e-5);
    EXPECT_NEAR(glm::dot(up, up), 1.0, 1e-5);
    EXPECT_NEAR(glm::dot(forward, up), 0.0, 1e-5);
    EXPECT_GT(camera.near, 0.0F);
}

TEST(FramingCamera, FillsTheImageWithTheBox) {
    const session::Bounds boxes[] = {{{-1, -1, -1}, {1, 1, 1}},        {{100, 200, 300}, {101, 200.1, 330}},
                                     {{-1e-3, 0, 0}, {0, 1e-3, 2e-3}}, {{-5000, 0, -5000}, {5000, 10, 5000}},
                                     {{0, 0, 0}, {3, 4, 0}},           {{0, 0, 0}, {0, 4, 0}}};
    for (const session::Bounds& box : boxes) {
        for (const double aspect : {16.0 / 9.0, 1.0, 0.25}) {
            const CameraView camera = framingCamera(box, aspect);
            expectFrame(camera);
            EXPECT_FALSE(camera.orthographic);
            EXPECT_NEAR(camera.halfWidth / camera.halfHeight, aspect, 1e-5);
            // The margin is kept from both edges of one direction, and at least as much from those of the
            // other.
            constexpr double kInside = 1.0 / 1.05;
            const Extents seen = project(camera, box);
            EXPECT_NEAR(seen.reach(), kInside, 2e-3);
            const bool wide = std::min(-seen.left, seen.right) > kInside - 2e-3;
            const bool high = std::min(-seen.bottom, seen.top) > kInside - 2e-3;
            EXPECT_TRUE(wide || high);
        }
    }
}

TEST(FramingCamera, LooksFromTheFrontAndAtTheFaceOfWhatIsFlat) {
    const auto towards = [](const std::array<double, 3>& extent) {
        return base::toVector(framingCamera({{0, 0, 0}, extent}, 1.5).forward);
    };
    EXPECT_LT(towards({1, 1, 1})[2], -0.8);
    EXPECT_LT(towards({1, 1, 1})[1], -0.1);
    // A tall post is not flat.
    EXPECT_LT(towards({0.1, 2, 0.1})[2], -0.8);
    EXPECT_LT(towards({3, 2, 0.1})[2], -0.98);
    EXPECT_LT(towards({0.1, 2, 3})[0], -0.98);
    EXPECT_LT(towards({3, 0.1, 2})[1], -0.8);
}

TEST(FramingCamera, EmptySceneAndSinglePointHaveOne) {
    const CameraView empty = framingCamera(worldBounds({}), 1.5);
    expectFrame(empty);
    EXPECT_LE(project(empty, {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}).reach(), 1.0);
    const CameraView point = framingCamera({{7, 7, 7}, {7, 7, 7}}, 1.5);
    expectFrame(point);
    EXPECT_LE(project(point, {{7, 7, 7}, {7, 7, 7}}).reach(), 1.0);
}

TEST(WorldBounds, CoverEveryInstance) {
    gltf::Primitive primitive;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
    primitive.indices = {0, 1, 2};
    gltf::Scene scene;
    scene.meshes.resize(1);
    scene.meshes[0].primitives = {primitive};
    gltf::Node plain;
    plain.mesh = 0;
    plain.world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    gltf::Node moved = plain;
    moved.world = {-2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 5, 1};
    gltf::Node infinite = plain;
    infinite.world[12] = INFINITY;
    scene.nodes = {plain, moved, infinite};
    const session::Bounds bounds = worldBounds(makeSceneView(scene));
    EXPECT_EQ(bounds.min, (std::array<double, 3>{0, 0, 0}));
    EXPECT_EQ(bounds.max, (std::array<double, 3>{10, 2, 5}));
    EXPECT_TRUE(worldBounds({}).empty());
}

gltf::Scene sceneWithCameras() {
    gltf::Scene scene;
    gltf::Camera perspective;
    perspective.name = "Wide";
    perspective.yfov = 1.0;
    perspective.znear = 0.1;
    perspective.zfar = 50.0;
    // The node is turned by 90° about Y, so that -Z becomes -X, scaled by 2, at (1, 2, 3).
    perspective.world = {0, 0, -2, 0, 0, 2, 0, 0, 2, 0, 0, 0, 1, 2, 3, 1};
    gltf::Camera orthographic;
    orthographic.orthographic = true;
    orthographic.ymag = 3.0;
    orthographic.world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    gltf::Camera flat = perspective;
    flat.name = "Flat";
    flat.world = {};
    scene.cameras = {perspective, orthographic, flat};
    return scene;
}

TEST(SceneCamera, KeepsTheVerticalFieldOfView) {
    const CameraView camera = must(sceneCamera(sceneWithCameras(), 0, 2.0));
    expectFrame(camera);
    EXPECT_EQ(camera.position, (std::array<double, 3>{1, 2, 3}));
    EXPECT_NEAR(camera.forward[0], -1.0F, 1e-6F);
    EXPECT_NEAR(camera.up[1], 1.0F, 1e-6F);
    EXPECT_NEAR(camera.halfHeight, std::tan(0.5), 1e-6);
    EXPECT_NEAR(camera.halfWidth, 2.0 * std::tan(0.5), 1e-6);
    EXPECT_FLOAT_EQ(camera.near, 0.1F);
    EXPECT_FLOAT_EQ(camera.far, 50.0F);
}

TEST(SceneCamera, OrthographicKeepsItsHeight) {
    const CameraView camera = must(sceneCamera(sceneWithCameras(), 1, 2.0));
    EXPECT_TRUE(camera.orthographic);
    EXPECT_FLOAT_EQ(camera.halfHeight, 3.0F);
    EXPECT_FLOAT_EQ(camera.halfWidth, 6.0F);
}

TEST(SceneCamera, FlatNodeIsAnError) {
    EXPECT_EQ(mustFail(sceneCamera(sceneWithCameras(), 2, 1.0)).id, "camera-matrix");
}

TEST(ChooseCamera, ByNameNumberAutoOrDefault) {
    const gltf::Scene scene = sceneWithCameras();
    const auto name = [&](const std::string& wanted) {
        const Result<session::CameraChoice> choice = chooseCamera(scene, {}, wanted, 1.0);
        return choice ? choice->name : choice.error().id;
    };
    EXPECT_EQ(name("Wide"), "Wide");
    EXPECT_EQ(name("0"), "Wide");
    EXPECT_EQ(name("1"), "1");
    EXPECT_EQ(name("auto"), "auto");
    EXPECT_EQ(name(""), "Wide");
    EXPECT_EQ(name("3"), "camera-unknown");
    EXPECT_EQ(name("Wyde"), "camera-unknown");
    const session::CameraChoice none = must(chooseCamera(gltf::Scene{}, {}, "", 1.0));
    EXPECT_EQ(none.name, "auto");
}

}  // namespace
}  // namespace glint::session
