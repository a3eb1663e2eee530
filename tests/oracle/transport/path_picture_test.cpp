// Tests pictures of the path tracer, and the comparison with them.
#include "oracle/transport/path_scene.h"

namespace {

using namespace glint;
using namespace glint::oracle;

gltf::Scene room() {
    SceneFile file;
    const int white = file.addMaterial(diffuseMaterial(Vec3(0.7)));
    const int bright = file.addMaterial(emissiveMaterial(Vec3(3.0)));
    file.addBox({white, white, white, bright, white, white}, {-1, 0, -1}, {1, 2, 1}, true);
    file.addCamera({0.3, 1.2, 0.95}, {-0.2, 0.5, -1}, 70);
    return file.import();
}

TEST(PathPicture, IsTheSameForAnyNumberOfThreads) {
    const gltf::Scene scene = room();
    const PathTracer tracer(scene, PathSky(GradientSky{}), {});
    const View view(scene.cameras.at(0), 12, 7);
    const PathPicture one = pathPicture(tracer, view, {8, 5, 1});
    const PathPicture three = pathPicture(tracer, view, {8, 5, 3});
    const PathPicture other = pathPicture(tracer, view, {8, 6, 3});
    std::size_t changed = 0;
    for (std::size_t i = 0; i < one.picture.pixels.size(); ++i) {
        EXPECT_EQ(one.picture.pixels[i].mean, three.picture.pixels[i].mean);
        EXPECT_EQ(one.picture.pixels[i].error, three.picture.pixels[i].error);
        changed += one.picture.pixels[i].mean != other.picture.pixels[i].mean ? 1 : 0;
    }
    EXPECT_GT(changed, 60U) << "another seed gives other samples";
}

// Two pictures with other seeds are apart by their standard errors.
TEST(PathPicture, StatesItsErrors) {
    const gltf::Scene scene = room();
    const PathTracer tracer(scene, PathSky(GradientSky{}), {});
    const View view(scene.cameras.at(0), 16, 9);
    const PathPicture truth = pathPicture(tracer, view, {64, 1, 0});
    const PathPicture other = pathPicture(tracer, view, {64, 2, 0});
    LinearImage device = toImage(other.picture);
    const PathDifference same = pathDifference(device, truth, nullptr, scene, 64);
    EXPECT_NEAR(same.rootMeanSquare / same.expected, 1.0, 0.2);
    EXPECT_LE(std::abs(same.bias), 4.0 * same.biasError);
    for (const PathDifferentPixel& pixel : same.different) {
        EXPECT_TRUE(pixel.cause == PathCause::Noise || pixel.cause == PathCause::Uneven);
    }
    // A device that is 10 % too bright, and wrong in one pixel.
    for (auto& pixel : device.pixels) {
        pixel[0] *= 1.1F;
        pixel[1] *= 1.1F;
        pixel[2] *= 1.1F;
    }
    device.pixels[20] = {90.0F, 90.0F, 90.0F, 1.0F};
    device.pixels[21][1] = std::numeric_limits<float>::quiet_NaN();
    const PathDifference brighter = pathDifference(device, truth, nullptr, scene, 64);
    EXPECT_GT(brighter.bias, 4.0 * brighter.biasError);
    EXPECT_EQ(brighter.notFinite, 1U);
    ASSERT_FALSE(brighter.different.empty());
    EXPECT_EQ(brighter.different.front().x, 4U);
    EXPECT_EQ(brighter.different.front().y, 1U);
    EXPECT_EQ(brighter.different.front().cause, PathCause::Other);
}

// A device that reflects light below a surface once more is explained by the truth that does.
TEST(PathPicture, ExplainsLightBelowASurface) {
    const gltf::Scene scene = room();
    const PathTracer tracer(scene, PathSky(GradientSky{}), {});
    const View view(scene.cameras.at(0), 8, 5);
    const PathPicture truth = pathPicture(tracer, view, {64, 1, 0});
    PathPicture reflecting = truth;
    reflecting.picture.pixels[9].mean *= 4.0;
    reflecting.picture.pixels[10].mean *= 4.0;
    LinearImage device = toImage(truth.picture);
    for (const std::size_t pixel : {9, 10, 11}) {
        for (int channel = 0; channel < 3; ++channel) {
            device.pixels[pixel][channel] *= pixel == 10 ? 9.0F : 4.0F;
        }
    }
    const PathDifference difference = pathDifference(device, truth, &reflecting, scene, 64);
    ASSERT_EQ(difference.different.size(), 3U);
    for (const PathDifferentPixel& pixel : difference.different) {
        EXPECT_EQ(pixel.cause == PathCause::Below, pixel.y == 1 && pixel.x == 1) << pixel.x;
    }
}

}  // namespace
