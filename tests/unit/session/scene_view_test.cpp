#include <glint/session/camera.h>
#include <glint/session/scene_view.h>
#include <glint/session/session.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace glint::session {
namespace {

constexpr gltf::Matrix4 kNoTransform{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

gltf::Primitive triangle() {
    gltf::Primitive primitive;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    primitive.indices = {0, 1, 2};
    return primitive;
}

gltf::Node placing(int mesh) {
    gltf::Node node;
    node.mesh = mesh;
    node.world = kNoTransform;
    return node;
}

TEST(SceneView, NumbersStayAsInTheScene) {
    gltf::Scene scene;
    scene.meshes.resize(4);
    scene.meshes[0].primitives = {triangle()};                     // not placed
    scene.meshes[1].primitives = {gltf::Primitive{}, triangle()};  // its first has no triangle
    scene.meshes[2].primitives = {gltf::Primitive{}};              // nothing to see
    scene.meshes[3].primitives = {triangle(), triangle()};
    scene.nodes = {placing(3), placing(1), placing(-1), placing(2), placing(3)};

    const session::SceneViewData data = makeSceneView(scene);
    ASSERT_EQ(data.primitives.size(), 3U);
    EXPECT_EQ(data.primitives[0].mesh, 1U);
    EXPECT_EQ(data.primitives[0].primitive, 1U);
    EXPECT_EQ(data.primitives[1].mesh, 3U);
    EXPECT_EQ(data.primitives[1].primitive, 0U);
    EXPECT_EQ(data.primitives[2].primitive, 1U);
    ASSERT_EQ(data.instances.size(), 3U);
    EXPECT_EQ(data.instances[0].mesh, 3U);
    EXPECT_EQ(data.instances[1].mesh, 1U);
    EXPECT_EQ(data.instances[2].mesh, 3U);
}

// Each placement is an instance, placed before its node; nodes that are never shown are none.
TEST(SceneView, PlacementsAreInstances) {
    gltf::Scene scene;
    scene.meshes.resize(1);
    scene.meshes[0].primitives = {triangle()};
    scene.nodes = {placing(0), placing(0), placing(0)};
    scene.nodes[0].world[0] = 2.0;
    scene.nodes[0].instancing = 0;
    scene.instancings.resize(1);
    scene.instancings[0].count = 3;
    scene.instancings[0].translations = {{0, 0, 0}, {1, 0, 0}, {5, 0, 7}};
    scene.nodes[1].shown = scene.nodes[1].canShow = false;
    scene.nodes[2].shown = false;
    const session::SceneViewData data = makeSceneView(scene);
    ASSERT_EQ(data.instances.size(), 4U);
    EXPECT_EQ(data.primitives.size(), 1U) << "geometry is there once";
    EXPECT_EQ(data.instances[2].objectToWorld[3], 10.0F);
    EXPECT_EQ(data.instances[2].objectToWorld[11], 7.0F);
    EXPECT_TRUE(data.instances[2].visible);
    EXPECT_FALSE(data.instances[3].visible) << "an animation can show it";
}

TEST(SceneView, AttributesAreViewsOfTheScene) {
    gltf::Scene scene;
    scene.meshes.resize(1);
    scene.meshes[0].primitives = {triangle()};
    scene.meshes[0].primitives[0].texCoords1 = {{0, 0}, {1, 0}, {0, 1}};
    scene.nodes = {placing(0)};
    const session::SceneViewData data = makeSceneView(scene);
    const PrimitiveView& view = data.primitives[0];
    EXPECT_EQ(view.positions.data(), scene.meshes[0].primitives[0].positions.data());
    EXPECT_EQ(view.texCoords1.size(), 3U);
    EXPECT_EQ(view.indices.size(), 3U);
    EXPECT_TRUE(view.normals.empty());
    EXPECT_TRUE(view.colors.empty());
}

TEST(SceneView, MatricesBecomeRows) {
    const gltf::Matrix4 matrix{1, 5, 9, 0, 2, 6, 10, 0, 3, 7, 11, 0, 4, 8, 12, 1};
    const std::array<float, 12> rows{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    EXPECT_EQ(toRows(matrix), rows);
}

TEST(SceneView, ImagesKeepTheirNumbers) {
    gltf::Scene scene;
    scene.images.resize(2);
    scene.images[1].width = 1;
    scene.images[1].height = 1;
    scene.images[1].pixels = {1, 2, 3, 4};
    const session::SceneViewData data = makeSceneView(scene);
    ASSERT_EQ(data.images.size(), 2U);
    EXPECT_TRUE(data.images[0].pixels.empty());
    EXPECT_EQ(data.images[1].pixels[3], 4);
    EXPECT_EQ(data.images[1].format, ImageView::Format::Rgba8);
    scene.images[1].format = gltf::PixelFormat::Rgba16;
    EXPECT_EQ(makeSceneView(scene).images[1].format, ImageView::Format::Rgba16);
}

TEST(SceneView, LightsCarryTheirIntensity) {
    gltf::Scene scene;
    gltf::Light light;
    light.type = gltf::LightType::Spot;
    light.color = {1.0F, 0.5F, 0.25F};
    light.intensity = 8.0F;
    light.range = 3.0F;
    light.position = {1, 2, 3};
    light.outerConeAngle = 0.3F;
    scene.lights = {light};
    const session::SceneViewData data = makeSceneView(scene);
    ASSERT_EQ(data.lights.size(), 1U);
    EXPECT_EQ(data.lights[0].type, LightView::Type::Spot);
    EXPECT_EQ(data.lights[0].intensity, (gltf::Float3{8.0F, 4.0F, 2.0F}));
    EXPECT_EQ(data.lights[0].position, (gltf::Float3{1, 2, 3}));
    EXPECT_EQ(data.lights[0].range, 3.0F);
    EXPECT_EQ(data.lights[0].outerConeAngle, 0.3F);
}

using Place = std::array<double, 3>;

// Returns where an instance has a vertex in the world, in double precision.
Place worldPlace(const SceneViewData& data, std::size_t instance, std::size_t vertex) {
    const gltf::Float3& p = data.primitives[0].positions[vertex];
    const std::array<float, 12>& rows = data.instances[instance].objectToWorld;
    Place place{};
    for (std::size_t row = 0; row < 3; ++row) {
        place[row] = double{rows[4 * row]} * p[0] + double{rows[4 * row + 1]} * p[1] +
                     double{rows[4 * row + 2]} * p[2] + double{rows[4 * row + 3]} + data.origin[row];
    }
    return place;
}

void expectPlace(const Place& place, const Place& expected, double tolerance) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(place[axis], expected[axis], tolerance) << "axis " << axis;
    }
}

gltf::Scene oneTriangle() {
    gltf::Scene scene;
    scene.meshes.resize(1);
    scene.meshes[0].primitives = {triangle()};
    scene.nodes = {placing(0)};
    return scene;
}

TEST(SceneOrigin, IsZeroNearZero) {
    gltf::Scene scene = oneTriangle();
    scene.nodes[0].world[12] = 7.0;
    scene.meshes[0].primitives[0].positions[0] = {-4, 5, 6};
    const SceneViewData data = makeSceneView(scene);
    EXPECT_EQ(data.origin, Place{});
    EXPECT_EQ(data.view().origin, Place{});
    EXPECT_EQ(data.instances[0].objectToWorld[3], 7.0F);
    EXPECT_EQ(data.primitives[0].positions.data(), scene.meshes[0].primitives[0].positions.data())
        << "nothing is copied";
    EXPECT_EQ(makeSceneView(gltf::Scene{}).origin, Place{});
}

// A float near 1e9 has steps of 64 m.
TEST(SceneOrigin, FarNodesKeepTheirDigits) {
    gltf::Scene scene = oneTriangle();
    scene.nodes[0].world[12] = 1e9 + 0.125;
    scene.nodes[0].world[14] = -3e9 + 0.25;
    gltf::Light lamp;
    lamp.type = gltf::LightType::Point;
    lamp.position = {1e9 + 0.5, 2.0, -3e9};
    scene.lights = {lamp};
    SceneViewData data = makeSceneView(scene);
    EXPECT_NE(data.origin, Place{});
    EXPECT_EQ(data.motion().origin, data.origin);
    expectPlace(worldPlace(data, 0, 1), {1e9 + 1.125, 0.0, -3e9 + 0.25}, 1e-6);
    Place light{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        light[axis] = data.origin[axis] + data.lights[0].position[axis];
    }
    expectPlace(light, lamp.position, 1e-6);
    // A pose elsewhere has an origin there.
    scene.nodes[0].world[12] = -5e8;
    poseSceneView(scene, data);
    expectPlace(worldPlace(data, 0, 1), {-5e8 + 1.0, 0.0, -3e9 + 0.25}, 1e-6);
    scene.nodes[0].world = kNoTransform;
    scene.lights[0].position = {};
    poseSceneView(scene, data);
    EXPECT_EQ(data.origin, Place{});
}

// Vertices far from their mesh's own origin are rebased without rounding, whichever way the node turns them.
TEST(SceneOrigin, FarVerticesAreRebasedExactly) {
    gltf::Scene scene = oneTriangle();
    gltf::Primitive& far = scene.meshes[0].primitives[0];
    far.positions = {
        {1000000.5F, 0.25F, -8000000.0F}, {1000001.0F, 0.75F, -8000000.5F}, {1000000.0F, 1, -8e6F}};
    scene.nodes[0].world = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, -1000000, 8e6, 1};
    const SceneViewData data = makeSceneView(scene);
    EXPECT_NE(data.meshOrigins[0], Place{});
    EXPECT_EQ(data.meshOrigins[0][1], 0.0) << "this coordinate is near 0";
    for (std::size_t vertex = 0; vertex < 3; ++vertex) {
        const gltf::Float3& p = far.positions[vertex];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(data.meshOrigins[0][axis] + data.primitives[0].positions[vertex][axis], p[axis]);
        }
        expectPlace(worldPlace(data, 0, vertex), {-double{p[1]}, p[0] - 1e6, p[2] + 8e6}, 1e-6);
    }
    EXPECT_EQ(data.origin, Place{}) << "the node brings the mesh back";
    const Bounds bounds = worldBounds(data);
    expectPlace(bounds.min, {-1, 0, -0.5}, 1e-6);
    expectPlace(bounds.max, {-0.25, 1, 0}, 1e-6);
}

// A lamp or an object that was left at 0 does not hold the origin there.
TEST(SceneOrigin, FollowsMostOfTheScene) {
    gltf::Scene scene = oneTriangle();
    for (const double place : {1e7, 1e7 + 3.0, 1e7 - 2.0, 1e7 + 1.0}) {
        scene.nodes.push_back(placing(0));
        scene.nodes.back().world[13] = place;
    }
    const SceneViewData data = makeSceneView(scene);
    EXPECT_NEAR(data.origin[1], 1e7, 16.0);
    expectPlace(worldPlace(data, 2, 2), {0.0, 1e7 + 4.0, 0.0}, 1e-6);
    EXPECT_EQ(worldBounds(data).max[1], 1e7 + 4.0);
    EXPECT_EQ(worldBounds(data).min[1], 0.0);
}

TEST(SceneOrigin, SkinsAndPlacementsAreRebased) {
    gltf::Scene scene = oneTriangle();
    gltf::Primitive& skinned = scene.meshes[0].primitives[0];
    skinned.influences.count = 1;
    skinned.influences.joints = {0, 0, 0};
    skinned.influences.weights = {1, 1, 1};
    scene.skins.resize(1);
    scene.skins[0].joints = {1};
    scene.skins[0].inverseBinds = {kNoTransform};
    scene.nodes[0].skin = 0;
    scene.nodes.push_back(placing(-1));
    scene.nodes[1].world[12] = 2e8 + 0.5;
    const SceneViewData data = makeSceneView(scene);
    ASSERT_EQ(data.joints[0].size(), 1U);
    EXPECT_EQ(data.origin[0] + data.joints[0][0][3], 2e8 + 0.5);
    const Bounds bounds = posedBounds(scene, data);
    EXPECT_EQ(bounds.max[0], 2e8 + 1.5);

    gltf::Scene placed = oneTriangle();
    placed.nodes[0].world[12] = -4e8;
    placed.nodes[0].instancing = 0;
    placed.instancings.resize(1);
    placed.instancings[0].count = 2;
    placed.instancings[0].translations = {{4e8F, 0, 0}, {4e8F + 32.0F, 0, 0}};
    const SceneViewData near = makeSceneView(placed);
    EXPECT_EQ(near.origin, Place{});
    expectPlace(worldPlace(near, 1, 0), {32.0, 0, 0}, 1e-6);
}

TEST(SceneView, PosesKeepTheSizesOfLights) {
    gltf::Scene scene;
    scene.lights.resize(2);
    scene.lights[0].type = gltf::LightType::Directional;
    scene.lights[1].type = gltf::LightType::Spot;
    compiler::Settings settings;
    settings.sunAngle = 2.0;
    settings.lightRadius = 0.5;
    SceneViewData data = sceneView(settings, scene);
    for (int pose = 0; pose < 2; ++pose) {
        EXPECT_NEAR(data.lights[0].size, std::numbers::pi / 180.0, 1e-6);
        EXPECT_EQ(data.lights[1].size, 0.5F);
        poseSceneView(scene, data);
    }
}

TEST(SceneView, SunIsAUnitVectorThatTravelsDown) {
    const gltf::Float3 way = sunLight().direction;
    EXPECT_NEAR(std::hypot(way[0], way[1], way[2]), 1.0F, 1e-6F);
    EXPECT_LT(way[1], 0.0F);
}

}  // namespace
}  // namespace glint::session
