// Compares textures of the oracle with values computed by hand.
#include "oracle/scene/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

namespace {

using namespace glint;
using namespace glint::oracle;

// The greys 0, 51, 102 and 255 are 0, 0.2, 0.4 and 1. The second row is below the first.
gltf::Scene sceneOf(const gltf::Sampler& sampler) {
    gltf::Scene scene;
    gltf::Image image;
    image.width = 2;
    image.height = 2;
    image.pixels = {0, 0, 0, 0, 51, 51, 51, 51, 102, 102, 102, 102, 255, 255, 255, 255};
    scene.images = {image};
    scene.samplers = {sampler};
    scene.textures = {{0, 0}};
    scene.materials.resize(1);
    scene.materials[0].texture("normalTexture").texture = 0;
    scene.materials[0].texture("baseColorTexture").texture = 0;
    return scene;
}

double sampleAt(const gltf::Scene& scene, double u, double v, std::string_view slot = "normalTexture") {
    SurfacePoint point;
    point.texCoords[0] = Vec2(u, v);
    return Textures(scene, exactSrgb()).sample(scene.materials[0], slot, point).value().r;
}

TEST(OracleTexture, MixesTheFourNearestTexels) {
    const gltf::Scene scene = sceneOf({});
    EXPECT_DOUBLE_EQ(sampleAt(scene, 0.25, 0.25), 0.0);
    EXPECT_DOUBLE_EQ(sampleAt(scene, 0.75, 0.25), 0.2);
    EXPECT_DOUBLE_EQ(sampleAt(scene, 0.25, 0.75), 0.4);
    EXPECT_NEAR(sampleAt(scene, 0.5, 0.5), 0.4, 1e-15);
    EXPECT_NEAR(sampleAt(scene, 0.35, 0.25), 0.04, 1e-15);
}

TEST(OracleTexture, DecodesColoursBeforeItMixesThem) {
    const gltf::Scene scene = sceneOf({});
    const double fifth = std::pow((0.2 + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(sampleAt(scene, 0.5, 0.25, "baseColorTexture"), 0.5 * fifth, 1e-15);
}

TEST(OracleTexture, WrapsAsItsSamplerSays) {
    EXPECT_NEAR(sampleAt(sceneOf({}), 1.0, 0.25), 0.1, 1e-15);
    EXPECT_NEAR(sampleAt(sceneOf({}), -7.25, 2.25), 0.2, 1e-15);
    gltf::Sampler clamped;
    clamped.wrapU = gltf::Wrap::ClampToEdge;
    EXPECT_NEAR(sampleAt(sceneOf(clamped), 1.0, 0.25), 0.2, 1e-15);
    EXPECT_NEAR(sampleAt(sceneOf(clamped), -3.0, 0.25), 0.0, 1e-15);
    gltf::Sampler mirrored;
    mirrored.wrapU = gltf::Wrap::MirroredRepeat;
    EXPECT_NEAR(sampleAt(sceneOf(mirrored), 1.0, 0.25), 0.2, 1e-15);
    EXPECT_NEAR(sampleAt(sceneOf(mirrored), 1.75, 0.25), 0.0, 1e-15);
    EXPECT_NEAR(sampleAt(sceneOf(mirrored), -0.25, 0.25), 0.0, 1e-15);
    gltf::Sampler nearest;
    nearest.magnification = gltf::Filter::Nearest;
    EXPECT_DOUBLE_EQ(sampleAt(sceneOf(nearest), 0.501, 0.499), 0.2);
}

// KHR_texture_transform, "Overview": offset, rotation and scale as in its example of a quarter turn, which
// rotates the image counter-clockwise.
TEST(OracleTexture, TransformsCoordinates) {
    gltf::Scene scene = sceneOf({});
    materials::TextureTransform& transform = scene.materials[0].texture("normalTexture").transform;
    transform.offset = {0.0F, 1.0F};
    transform.rotation = static_cast<float>(kPi / 2.0);
    // The surface's corner (0, 0), top left, shows the image's bottom left; (1, 0) shows its top left.
    SurfacePoint point;
    point.texCoords[0] = Vec2(0.0, 0.0);
    const materials::TextureInfo& info = scene.materials[0].texture("normalTexture");
    EXPECT_NEAR(glm::length(*textureCoordinates(info, point) - Vec2(0.0, 1.0)), 0.0, 1e-6);
    point.texCoords[0] = Vec2(1.0, 0.0);
    EXPECT_NEAR(glm::length(*textureCoordinates(info, point) - Vec2(0.0, 0.0)), 0.0, 1e-6);
    transform.scale = {0.5F, 2.0F};
    point.texCoords[0] = Vec2(0.0, 0.5);
    EXPECT_NEAR(glm::length(*textureCoordinates(info, point) - Vec2(1.0, 1.0)), 0.0, 1e-6);
}

TEST(OracleTexture, ReadsNothingWithoutCoordinates) {
    gltf::Scene scene = sceneOf({});
    scene.materials[0].texture("normalTexture").texCoord = 1;
    SurfacePoint point;
    point.texCoords[0] = Vec2(0.0);
    EXPECT_FALSE(Textures(scene, exactSrgb()).sample(scene.materials[0], "normalTexture", point));
}

}  // namespace
