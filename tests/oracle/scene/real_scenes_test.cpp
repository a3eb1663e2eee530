// Compares pictures of real scenes on the device with the scene renderer.
#include "image/tone.h"
#include "oracle/scene/difference.h"
#include "oracle/scene/input.h"
#include "oracle/scene/report.h"
#include "oracle/scene/texels.h"
#include "render/harness.h"
#include "support/effect_bits.h"
#include "support/models.h"
#include "support/must.h"
#include "support/nightly.h"
#include "support/temporary_folder.h"

#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <string>

namespace {

namespace fs = std::filesystem;

using namespace glint;
using namespace glint::oracle;
using namespace glint::testing;

constexpr std::uint32_t kWidth = 64;
constexpr std::uint32_t kHeight = 36;
constexpr std::uint32_t kSamples = 64;
constexpr float kMirrorRoughness = 0.05F;

// Bounds at the pixels' centres, for a truth that decodes texels as the device does.
struct Bounds {
    double median;        // relative error
    std::size_t differs;  // pixels off by more than kDiffers, without those of chance
    std::size_t other;    // of these without a cause
    double rms;           // of the mean over samples, besides what chance explains
    double mean;          // signed, of the mean over samples, besides four standard errors
};

struct RealScene {
    std::string name;
    fs::path path;
    Bounds bounds;
};

fs::path model(const std::string& name) {
    return test::modelsFolder() / name;
}

class Device {
public:
    explicit Device(const OracleInput& input, std::uint32_t width = kWidth, std::uint32_t height = kHeight)
        : loaded_(input.scene, settings()) {
        setup_.width = width;
        setup_.height = height;
        setup_.frame.camera = input.camera;
        setup_.frame.mirrorRoughness = kMirrorRoughness;
        setup_.frame.maxReflectionRoughness = kMirrorRoughness;
    }
    LinearImage render(std::uint32_t samples) {
        setup_.samples = samples;
        return loaded_.render(package::kStrategyVisibility, setup_);
    }

private:
    static compiler::CompileSettings settings() {
        compiler::CompileSettings settings;
        settings.effects = {false, package::kEffectShadow | package::kEffectReflection, kMirrorRoughness};
        settings.plan.keys.alpha = package::AlphaPolicy::Tested;
        settings.plan.merge = compiler::MergePolicy::All;
        settings.textureLod = compiler::TextureLod::Mip0;
        return settings;
    }

    LoadedScene loaded_;
    RenderSetup setup_;
};

// Returns the table of the device. If that fails, the test fails and the exact table is returned.
SrgbTable deviceTexels() {
    const test::TemporaryFolder folder;
    if (!writeTexelScene(folder.path())) {
        ADD_FAILURE() << "can't write the scene of texels";
        return exactSrgb();
    }
    const OracleInput input = must(readOracleInput({folder.path() / "texels.gltf", "", ""}, 16, 16));
    return must(texelsOf(Device(input, 16, 16).render(1), "the device's picture"));
}

const SrgbTable& sharedTexels() {
    static const SrgbTable table = deviceTexels();
    return table;
}

// Each value is nearer to its own number than to any other, so that encoding it again gives the same number.
TEST(RealScenes, TheDeviceDecodesTexelsWithinHalfAStep) {
    for (std::size_t i = 0; i < sharedTexels().size(); ++i) {
        EXPECT_NEAR(255.0 * image::linearToSrgb(static_cast<float>(sharedTexels()[i])),
                    static_cast<double>(i), 0.5);
    }
}

// llvmpipe filters 8-bit textures in 8 bits unless this is set before the device is created. Other drivers
// ignore it. tests/support/test_main.cpp gives the reason for the other word.
const int kFiltersInFloats =
    ::setenv("GALLIVM_PERF", test::nightly() ? "no_aos_sampling" : "no_aos_sampling,nopt", 1);

class RealScenes : public ::testing::TestWithParam<RealScene> {};

TEST_P(RealScenes, AgreeWithTheOracle) {
    ASSERT_EQ(kFiltersInFloats, 0);
    const RealScene& subject = GetParam();
    if (!fs::exists(subject.path)) {
        GTEST_SKIP() << test::noModels(subject.path);
    }
    const OracleInput input = must(readOracleInput({subject.path, "", ""}, kWidth, kHeight));
    const SceneRenderer renderer(
        input.scene, {.sky = defaultSky(), .mirrorRoughness = kMirrorRoughness, .srgb = sharedTexels()});
    Device device(input);

    const LinearImage first = device.render(1);
    const Difference centres =
        centreDifference(first, centrePicture(renderer, input.view), renderer, input.view);
    SCOPED_TRACE(toText(centres, 20));
    EXPECT_EQ(centres.notFinite, 0U);
    EXPECT_LE(centres.median, subject.bounds.median);
    EXPECT_LE(centres.different.size() - centres.count(Cause::Chance), subject.bounds.differs);
    EXPECT_LE(centres.count(Cause::Other), subject.bounds.other);

    const LinearImage converged = device.render(kSamples);
    // At the same points as the device's samples, only chance and arithmetic differ.
    const Difference samples =
        meanDifference(converged, samplePicture(renderer, input.view, kSamples), kSamples);
    SCOPED_TRACE(toText(samples, 10));
    EXPECT_LE(samples.rootMeanSquare, 1.2 * samples.expected + subject.bounds.rms);
    EXPECT_LE(std::abs(samples.signedMean), 4.0 * samples.signedError + subject.bounds.mean);
    // This compares means over the whole pixels.
    const Difference means = meanDifference(converged, meanPicture(renderer, input.view, {4, 4}), kSamples);
    SCOPED_TRACE(toText(means, 10));
    EXPECT_LE(std::abs(means.signedMean), 4.0 * means.signedError + subject.bounds.mean);
}

// A device that is off by 1 % somewhere, or by 0.1 % everywhere, is detected.
TEST(RealScenes, SeeWhatIsOff) {
    const OracleInput input = must(readOracleInput({GLINT_GALLERY_SCENE, "", ""}, kWidth, kHeight));
    const SceneRenderer renderer(input.scene, {.sky = defaultSky(), .mirrorRoughness = kMirrorRoughness});
    const Picture truth = centrePicture(renderer, input.view);
    LinearImage image = toImage(truth);
    EXPECT_EQ(centreDifference(image, truth, renderer, input.view).different.size(), 0U);
    for (float& channel : image.pixels[1000]) {
        channel *= 1.01F;
    }
    const Difference one = centreDifference(image, truth, renderer, input.view);
    ASSERT_EQ(one.different.size(), 1U);
    EXPECT_EQ(one.different[0].x, 1000U % kWidth);
    EXPECT_EQ(one.different[0].y, 1000U / kWidth);
    EXPECT_NEAR(one.largest, 0.01, 1e-4);
    for (auto& pixel : image.pixels) {
        pixel[1] *= 1.001F;
    }
    const Difference all = meanDifference(image, truth, 1);
    EXPECT_GT(all.signedMean, 5.0 * all.signedError);
}

// For GoogleTest's messages.
std::ostream& operator<<(std::ostream& out, const RealScene& scene) {
    return out << scene.name;
}

std::string testName(const ::testing::TestParamInfo<RealScene>& scene) {
    return scene.param.name;
}

// The bounds are about three times what llvmpipe of Mesa 25.0.7 gave: medians of 2e-6 in the gallery and 8e-8
// elsewhere, 9 pixels and 2 to 4, RMS errors of 2e-3 and 6e-4, where a few samples fall beside an edge.
constexpr Bounds kGallery{6e-6, 27, 0, 3e-3, 3e-4};
constexpr Bounds kModel{3e-7, 12, 0, 3e-3, 3e-4};

INSTANTIATE_TEST_SUITE_P(
    Scenes, RealScenes,
    ::testing::Values(
        RealScene{"Gallery", GLINT_GALLERY_SCENE, kGallery},
        RealScene{"AlphaBlendModeTest", model("features/AlphaBlendModeTest/AlphaBlendModeTest.gltf"), kModel},
        RealScene{"ClearCoatTest", model("features/ClearCoatTest/ClearCoatTest.gltf"), kModel},
        RealScene{"NormalTangentMirrorTest",
                  model("features/NormalTangentMirrorTest/NormalTangentMirrorTest.gltf"), kModel},
        RealScene{"SheenChair", model("features/SheenChair/SheenChair.gltf"), kModel}),
    testName);

}  // namespace
