// Tests frames of passes that show their inputs: the raster pass and the rays must see the same.
#include "device_fixture.h"
#include "support/must.h"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

using package::kStrategyUber;
using package::kStrategyVisibility;
using test::TestScene;

constexpr std::uint32_t kWidth = 40;
constexpr std::uint32_t kHeight = 24;

// Counts the pixels in which the raster pass (channel 0) or the rays (channel 1) see `value`, which is
// geometry + 1.
std::size_t countPixels(const LinearImage& image, std::size_t channel, float value) {
    return static_cast<std::size_t>(
        std::ranges::count_if(image.pixels, [&](const auto& pixel) { return pixel[channel] == value; }));
}

class RendererTest : public test::DeviceTest, public testing::WithParamInterface<package::Strategy> {
protected:
    LinearImage render(const Package& package, TestScene& scene, const FrameOptions& frame,
                       std::uint32_t sampleCount = 1) {
        gpuScene_ = upload(package, scene);
        renderer_ = makeRenderer(package, *gpuScene_, GetParam(), kWidth, kHeight);
        return must(renderer_->render(frame, sampleCount));
    }
    void TearDown() override {
        renderer_.reset();
        gpuScene_.reset();
        DeviceTest::TearDown();
    }

    std::unique_ptr<GpuScene> gpuScene_;
    std::unique_ptr<Renderer> renderer_;
};

FrameOptions makeFrame(float cameraZ) {
    FrameOptions frame;
    frame.camera = test::makeCamera(cameraZ);
    frame.camera.halfHeight = 0.3F;
    frame.camera.halfWidth = 0.5F;
    return frame;
}

// Which side of a square is visible under a transform. The facing of rays must match that of the raster pass,
// and both must match glTF, where counter-clockwise in object space is the front.
struct FacingCase {
    const char* name;
    test::Rows transform;
    bool doubleSided;
    bool seenFromFront;  // from +z
    bool seenFromBack;
};

constexpr FacingCase kFacingCases[] = {
    {"as it is", test::kIdentity, false, true, false},
    {"turned about y", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0}, false, false, true},
    {"mirrored in x", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, false, true, false},
    {"mirrored in z", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0}, false, false, true},
    {"mirrored in all", {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0}, false, false, true},
    {"double-sided", test::kIdentity, true, true, true},
    {"double-sided, mirrored", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, true, true, true},
};

TEST_P(RendererTest, FacingIsThatOfGltf) {
    for (const FacingCase& facing : kFacingCases) {
        test::PackageSpec spec = test::makeDeviceSpec();
        spec.primitives = {test::makePrimitive(0, 0, facing.doubleSided ? gpu::kGeometryDoubleSided : 0)};
        const Package package = load(spec);
        TestScene scene;
        scene.meshes = {test::makeSquare(0, 0)};
        scene.instances = {{0, facing.transform}};
        for (const float z : {4.0F, -4.0F}) {
            const LinearImage image = render(package, scene, makeFrame(z));
            const bool seen = z > 0 ? facing.seenFromFront : facing.seenFromBack;
            // The square covers 2 x 2 of the 4 x 2.4 metres in view.
            const std::size_t expected = seen ? kWidth / 2 * kHeight * 10 / 12 : 0;
            EXPECT_EQ(countPixels(image, 0, 1.0F), expected) << facing.name << " from " << z;
            EXPECT_EQ(countPixels(image, 1, 1.0F), expected) << facing.name << " from " << z;
        }
    }
}

// Slanted squares and an orthographic or perspective camera, with many jitters: the ray of a pixel hits what
// the raster pass saw there, except for a few pixels on edges.
TEST_P(RendererTest, RaysAgreeWithTheRaster) {
    test::PackageSpec spec = test::makeDeviceSpec();
    spec.primitives = {test::makePrimitive(0, 0), test::makePrimitive(0, 1, gpu::kGeometryDoubleSided)};
    const Package package = load(spec);
    TestScene scene;
    scene.meshes = {test::makeSquare(0, 0), test::makeSquare(0, 1, -0.5F)};
    scene.instances = {{0, {0.8F, 0.1F, -0.4F, 0.3F, 0.2F, 0.9F, 0.1F, 0.1F, 0.5F, 0.0F, 0.7F, -0.5F}},
                       {0, {-0.8F, 0.1F, -0.4F, -0.6F, 0.2F, 0.9F, 0.1F, 0.1F, 0.5F, 0.0F, 0.7F, 0.5F}}};
    gpuScene_ = upload(package, scene);
    renderer_ = makeRenderer(package, *gpuScene_, GetParam(), kWidth, kHeight);
    for (const bool orthographic : {false, true}) {
        FrameOptions frame = makeFrame(4.0F);
        frame.camera.position = {0.0137F, 0.0071F, 4.0F};
        frame.camera.orthographic = orthographic;
        if (orthographic) {
            frame.camera.halfWidth = 2.0F;
            frame.camera.halfHeight = 1.2F;
            frame.camera.far = 100.0F;
        }
        const LinearImage image = must(renderer_->render(frame, 1));
        std::size_t seen = 0;
        std::size_t different = 0;
        for (const std::array<float, 4>& pixel : image.pixels) {
            seen += pixel[0] > 0.0F ? 1 : 0;
            different += pixel[0] != pixel[1] ? 1 : 0;
        }
        EXPECT_GT(seen, kWidth * kHeight / 4);
        EXPECT_LE(different, 1U) << (orthographic ? "orthographic" : "perspective");
    }
}

TEST_P(RendererTest, SamplesAccumulateWithoutDrift) {
    const Package package = load(test::makeDeviceSpec());
    TestScene scene = test::squareScene();
    const LinearImage image = render(package, scene, makeFrame(4.0F), 64);
    // The mean over jittered samples is the coverage: 2 x 2 metres of 4 x 2.4 in both channels.
    for (const std::size_t channel : {0, 1}) {
        double sum = 0.0;
        for (const std::array<float, 4>& pixel : image.pixels) {
            sum += pixel[channel];
        }
        EXPECT_NEAR(sum / (kWidth * kHeight), 4.0 / 9.6, 2e-3);
    }
    EXPECT_EQ(image.pixels[0][0], 0.0F);
    EXPECT_NEAR(image.pixels[kWidth * kHeight / 2 + kWidth / 2][0], 1.0F, 1e-6F);
}

TEST_P(RendererTest, NearHidesFar) {
    test::PackageSpec spec = test::makeDeviceSpec();
    spec.primitives = {test::makePrimitive(0, 0), test::makePrimitive(1, 0)};
    const Package package = load(spec);
    TestScene scene;
    scene.meshes = {test::makeSquare(0, 0, 1.0F), test::makeSquare(1, 0, 0.0F)};
    // The nearer square is drawn first, then last.
    for (const std::uint32_t first : {0U, 1U}) {
        scene.instances = {{first, test::kIdentity}, {1 - first, test::kIdentity}};
        for (const float far : {0.0F, 10.0F}) {
            FrameOptions frame = makeFrame(4.0F);
            frame.camera.far = far;
            const LinearImage image = render(package, scene, frame);
            const std::array<float, 4>& centre = image.pixels[kWidth * (kHeight / 2) + kWidth / 2];
            EXPECT_EQ(centre[0], static_cast<float>(first) + 1.0F);
            EXPECT_EQ(centre[1], centre[0]);
            EXPECT_NEAR(centre[3], 3.0F, 0.01F);
        }
    }
}

TEST_P(RendererTest, CountersAndTimingsNameThePasses) {
    const Package package = load(test::makeDeviceSpec());
    TestScene scene = test::squareScene();
    gpuScene_ = upload(package, scene);
    renderer_ = makeRenderer(package, *gpuScene_, GetParam(), kWidth, kHeight);
    EXPECT_FALSE(renderer_->timings());
    EXPECT_FALSE(renderer_->counters());
    EXPECT_GT(renderer_->pipelineMaking().milliseconds, 0.0);
    FrameOptions frame = makeFrame(4.0F);
    ASSERT_TRUE(renderer_->render(frame));
    const std::vector<PassTiming> stretches = must(renderer_->timings());
    ASSERT_EQ(stretches.size(), 2U);
    EXPECT_EQ(stretches[0].name, "frame");
    EXPECT_EQ(stretches[1].name, "hits");
    EXPECT_GE(stretches[0].milliseconds, stretches[1].milliseconds);
    frame.timing = Timing::Passes;
    std::vector<std::size_t> timed;  // of each sample: only the last has its passes measured
    ASSERT_TRUE(renderer_->render(frame, 2, [&] {
        timed.push_back(renderer_->timings()->size());
        return okStatus();
    }));
    ASSERT_EQ(timed.size(), 2U);
    EXPECT_EQ(timed[0], 2U);
    EXPECT_GT(timed[1], 2U);

    const Renderer::Counters counters = must(renderer_->counters());
    EXPECT_EQ(counters.rays, kWidth * kHeight);
    EXPECT_EQ(counters.unknownShader, 0U);
    EXPECT_EQ(counters.pixelCounts, (std::vector<std::uint32_t>{560, 400}));
    const std::vector<PassTiming> timings = must(renderer_->timings());
    std::vector<std::string> names;
    for (const PassTiming& timing : timings) {
        names.push_back(timing.name);
        EXPECT_GE(timing.milliseconds, 0.0);
        EXPECT_LT(timing.milliseconds, 60000.0);
    }
    std::vector<std::string> expected{"gbuffer",    "first count", "first offset",    "first copy",
                                      "first miss", "first Plain", "reflection rays", "ray dispatch"};
    if (GetParam() == kStrategyUber) {
        expected.insert(expected.end(), {"uber", "compose"});
        EXPECT_TRUE(counters.bucketCounts.empty());
    } else {
        expected.insert(expected.end(),
                        {"trace", "count", "offset", "copy", "shade miss", "shade Plain", "compose"});
        EXPECT_EQ(counters.bucketCounts, (std::vector<std::uint32_t>{560, 400}));
    }
    EXPECT_EQ(names, expected);
}

TEST_P(RendererTest, WithoutReflectionsThereAreNone) {
    const Package package = load(test::makeDeviceSpec());
    TestScene scene = test::squareScene();
    FrameOptions frame = makeFrame(4.0F);
    render(package, scene, frame);
    frame.effects = 0;
    const LinearImage image = must(renderer_->render(frame));
    EXPECT_EQ(countPixels(image, 0, 1.0F), 400U);
    EXPECT_EQ(countPixels(image, 1, 0.0F), kWidth * kHeight);
    EXPECT_EQ(renderer_->timings()->size(), 1U);
    EXPECT_EQ(renderer_->counters()->rays, 0U);
    frame.timing = Timing::Passes;
    ASSERT_TRUE(renderer_->render(frame));
    EXPECT_EQ(renderer_->timings()->size(), 7U);  // G-buffer, order and shading of first hits, composition
}

TEST_P(RendererTest, SceneWithoutAnything) {
    const Package package = load(test::makeDeviceSpec());
    TestScene scene;
    const LinearImage image = render(package, scene, makeFrame(4.0F));
    EXPECT_EQ(countPixels(image, 0, 0.0F), kWidth * kHeight);
    EXPECT_EQ(countPixels(image, 1, 0.0F), kWidth * kHeight);
}

TEST_P(RendererTest, MipsAreMeansInLinearLight) {
    test::PackageSpec spec = test::makeDeviceSpec();
    spec.textures = {{0, 1, {}}, {0, 0, {}}};
    spec.samplers = {{0, 0, 0, 0, 0, 1}};
    TestScene scene = test::squareScene();
    scene.images = {{2, 2, {0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 255}}};
    // For sRGB, half of the light, 0.5, is rounded to 188 of 255 in the format. Linear gives 127 or 128 of
    // 255.
    for (const std::uint32_t texture : {0U, 1U}) {
        spec.materials[0].textures[0].textureIndex = texture;
        const Package package = load(spec);
        const LinearImage image = render(package, scene, makeFrame(4.0F));
        EXPECT_NEAR(image.pixels[kWidth * (kHeight / 2) + kWidth / 2][2], 0.5F, 5e-3F) << texture;
    }
}

// The shader reads mip 1, where each image has another value than its mip 0 would make. The validation layers
// see how the mips that are missing are made.
TEST_P(RendererTest, MipsOfAnImageAreKept) {
    test::PackageSpec spec = test::makeDeviceSpec();
    spec.textures = {{0, 0, {}}, {1, 0, {}}, {2, 0, {}}};
    spec.samplers = {{0, 0, 0, 0, 0, 1}};
    TestScene scene = test::squareScene();
    const auto addLevels = [&](std::uint32_t size, const std::vector<std::uint8_t>& values,
                               ImageView::Format format) {
        const bool wide = format == ImageView::Format::Rgba16;
        TestScene::Pixels image{size, size, {}, format, static_cast<std::uint32_t>(values.size())};
        for (std::size_t level = 0; level < values.size(); ++level) {
            const std::size_t edge = std::max<std::size_t>(size >> level, 1);
            image.bytes.insert(image.bytes.end(), (wide ? 8 : 4) * edge * edge, values[level]);
        }
        scene.images.push_back(image);
    };
    addLevels(2, {255, 51}, ImageView::Format::Rgba8);
    addLevels(5, {255, 51}, ImageView::Format::Rgba8);  // two levels of three
    addLevels(5, {255, 51, 0}, ImageView::Format::Rgba16);
    for (const std::uint32_t texture : {0U, 1U, 2U}) {
        spec.materials[0].textures[0].textureIndex = texture;
        const Package package = load(spec);
        const LinearImage image = render(package, scene, makeFrame(4.0F));
        EXPECT_NEAR(image.pixels[kWidth * (kHeight / 2) + kWidth / 2][2], 0.2F, 5e-3F) << texture;
    }
}

TEST_P(RendererTest, BadRequestsAreErrors) {
    const Package package = load(test::makeDeviceSpec());
    TestScene scene;
    gpuScene_ = upload(package, scene);
    for (const auto& [width, height] : {std::pair(0U, 8U), std::pair(8U, 0U), std::pair(1U << 20, 8U)}) {
        EXPECT_EQ(mustFail(Renderer::create(context(), package, *gpuScene_, {GetParam(), width, height})).id,
                  "render-size");
    }
    EXPECT_EQ(mustFail(Renderer::create(context(), package, *gpuScene_, {package::Strategy{3}, 8, 8})).id,
              "renderer-options");
    renderer_ = makeRenderer(package, *gpuScene_, GetParam(), 8, 8);
    EXPECT_FALSE(renderer_->render(makeFrame(4.0F), 0));
    FrameOptions frame = makeFrame(4.0F);
    frame.camera.near = 0.0F;
    EXPECT_FALSE(renderer_->render(frame));
    frame = makeFrame(4.0F);
    frame.sky.zenith[1] = std::nanf("");
    EXPECT_FALSE(renderer_->render(frame));
}

INSTANTIATE_TEST_SUITE_P(Strategies, RendererTest, testing::Values(kStrategyUber, kStrategyVisibility),
                         [](const auto& strategy) {
                             return strategy.param == kStrategyUber ? std::string("Uber")
                                                                    : std::string("Visibility");
                         });

}  // namespace
}  // namespace glint
