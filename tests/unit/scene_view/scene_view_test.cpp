#include <glint/scene_view/scene_view.h>

#include <gtest/gtest.h>

#include <cmath>

namespace glint::scene_view {
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

    const scene_view::SceneViewData data = makeSceneView(scene);
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
    const scene_view::SceneViewData data = makeSceneView(scene);
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
    const scene_view::SceneViewData data = makeSceneView(scene);
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
    const scene_view::SceneViewData data = makeSceneView(scene);
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
    const scene_view::SceneViewData data = makeSceneView(scene);
    ASSERT_EQ(data.lights.size(), 1U);
    EXPECT_EQ(data.lights[0].type, LightView::Type::Spot);
    EXPECT_EQ(data.lights[0].intensity, (gltf::Float3{8.0F, 4.0F, 2.0F}));
    EXPECT_EQ(data.lights[0].position, light.position);
    EXPECT_EQ(data.lights[0].range, 3.0F);
    EXPECT_EQ(data.lights[0].outerConeAngle, 0.3F);
}

TEST(SceneView, SunIsAUnitVectorThatTravelsDown) {
    const gltf::Float3 way = sunLight().direction;
    EXPECT_NEAR(std::hypot(way[0], way[1], way[2]), 1.0F, 1e-6F);
    EXPECT_LT(way[1], 0.0F);
}

}  // namespace
}  // namespace glint::scene_view
