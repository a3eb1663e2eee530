// Tests textures on the device: block formats against the same blocks unpacked on the CPU, levels that arrive
// while frames are drawn, and the report of the levels that a frame reads.
#include "gltf/codecs/codecs.h"
#include "gltf/texels/fit.h"
#include "gltf/texels/levels.h"
#include "render/edited_scene.h"
#include "render/pixel_test.h"
#include "scene/texture_stream.h"
#include "support/must.h"
#include "unit/gltf/block_files.h"

#include <glint/scene.h>
#include <glint/session/session.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

constexpr std::uint32_t kCells = 6;        // of the picture, each way
constexpr std::uint32_t kCellTexels = 10;  // no multiple of most block sizes
constexpr std::uint32_t kSide = kCells * kCellTexels;

// A scene of unlit squares, of which each shows an image of its own, texel by pixel.
gltf::Scene squares(std::size_t count) {
    gltf::Scene scene = sceneWithCamera();
    for (std::size_t i = 0; i < count; ++i) {
        materials::Material material = unlitMaterial({1.0F, 1.0F, 1.0F});
        material.texture("baseColorTexture").texture = addTexture(
            scene, kCellTexels, kCellTexels, std::vector<std::uint8_t>(4 * kCellTexels * kCellTexels, 255));
        const float size = 2.0F / kCells;
        const float left = -1.0F + size * static_cast<float>(i % kCells);
        const std::size_t row = i / kCells;
        const float bottom = -1.0F + size * static_cast<float>(row);
        addQuad(scene, material, {left, bottom, -1.0F}, {size, 0, 0}, {0, size, 0});
    }
    return scene;
}

// The images of the squares: one for each format, in blocks or unpacked.
struct FormatImages {
    std::vector<TexelFormat> formats;
    std::vector<std::vector<std::uint8_t>> blocks;
    std::vector<std::vector<std::uint8_t>> pixels;
};

FormatImages imagesOf(const TexelFormats& known) {
    FormatImages images;
    for (std::uint32_t i = 0; i < kTexelFormatCount; ++i) {
        const auto format = static_cast<TexelFormat>(i);
        const bool needsBasisu = format == TexelFormat::Bc7 || format >= TexelFormat::Astc4x4;
        if (!isBlockFormat(format) || !known.has(format, true) || (needsBasisu && !gltf::hasBasisu())) {
            continue;
        }
        base::Bytes blocks = test::randomBlocks(format, kCellTexels, kCellTexels, 1, i);
        const auto pixels = gltf::decodeBlocks(format, true, kCellTexels, kCellTexels, blocks);
        EXPECT_TRUE(pixels);
        images.formats.push_back(format);
        images.pixels.push_back(pixels ? *pixels : base::Bytes());
        images.blocks.push_back(std::move(blocks));
    }
    return images;
}

double toSrgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

compiler::CompileSettings settingsForDevice() {
    compiler::CompileSettings settings;
    settings.tracers = tracerOfDevice();
    return settings;
}

// By how many steps of 8 bits a device may differ from the CPU in a colour. How devices interpolate the
// colours of BC1 to BC3 is specified loosely (F. Giesen 2021, "GPU BCn decoding"): an NVIDIA H100 differs by
// up to 5.0. The other formats leave rounding.
double mostSteps(TexelFormat format) {
    const bool isLoose =
        format == TexelFormat::Bc1 || format == TexelFormat::Bc2 || format == TexelFormat::Bc3;
    return isLoose ? 6.0 : 2.5;
}

// Random blocks have every mode.
TEST(TextureFormats, DevicesReadWhatTheCpuUnpacks) {
    const FormatImages images = imagesOf(sharedContext().texelFormats());
    ASSERT_LE(images.formats.size(), std::size_t{kCells} * kCells);
    ASSERT_TRUE(sharedContext().texelFormats().has(TexelFormat::Bc1, true));
    const gltf::Scene scene = squares(images.formats.size());
    RenderSetup setup = defaultSetup(scene, kSide, kSide);
    const auto picture = [&](bool inBlocks) {
        const LoadedScene loaded(scene, settingsForDevice(), [&](session::SceneViewData& data) {
            for (std::size_t i = 0; i < images.formats.size(); ++i) {
                data.images[i].format = inBlocks ? images.formats[i] : TexelFormat::Rgba8;
                data.images[i].pixels = inBlocks ? images.blocks[i] : images.pixels[i];
            }
        });
        return loaded.render(package::kStrategyUber, setup);
    };
    const LinearImage blocks = picture(true);
    const LinearImage pixels = picture(false);
    ASSERT_EQ(blocks.pixels.size(), std::size_t{kSide} * kSide);
    ASSERT_EQ(pixels.pixels.size(), blocks.pixels.size());
    for (std::size_t i = 0; i < images.formats.size(); ++i) {
        double worst = 0.0;
        double sum = 0.0;
        const std::size_t left = i % kCells * kCellTexels;
        const std::size_t bottom = kSide - i / kCells * kCellTexels;
        for (std::size_t y = bottom - kCellTexels; y < bottom; ++y) {
            for (std::size_t x = left; x < left + kCellTexels; ++x) {
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    const double error = 255.0 * std::abs(toSrgb(blocks.pixels[y * kSide + x][channel]) -
                                                          toSrgb(pixels.pixels[y * kSide + x][channel]));
                    worst = std::max(worst, error);
                    sum += error;
                }
            }
        }
        const double mean = sum / (3.0 * kCellTexels * kCellTexels);
        RecordProperty(infoOf(images.formats[i]).name, std::to_string(worst));
        EXPECT_LE(worst, mostSteps(images.formats[i])) << infoOf(images.formats[i]).name;
        EXPECT_LE(mean, 1.0) << infoOf(images.formats[i]).name;
    }
}

// A lit square with data textures: vectors with two channels, roughness and metal in two, occlusion in one.
TEST(TextureFormats, DataInOneAndTwoChannels) {
    if (!gltf::hasBasisu()) {
        GTEST_SKIP() << "this build does not pack blocks";
    }
    gltf::Scene scene = sceneWithCamera();
    addDirectionalLight(scene, {0.3F, -0.5F, -0.8F}, 3.0F);
    constexpr std::uint32_t kSize = 16;
    std::vector<std::uint8_t> normals;
    std::vector<std::uint8_t> data;
    for (std::uint32_t i = 0; i < kSize * kSize; ++i) {
        const std::uint32_t row = i / kSize;
        const double x = 0.4 * std::sin(0.7 * (i % kSize));
        const double y = 0.4 * std::cos(0.5 * row);
        const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(255.0 * value)); };
        normals.insert(normals.end(), {byte(0.5 + 0.5 * x), byte(0.5 + 0.5 * y),
                                       byte(0.5 + 0.5 * std::sqrt(1.0 - x * x - y * y)), 255});
        data.insert(data.end(),
                    {byte(0.2 + 0.05 * (i % kSize)), byte(0.3 + 0.04 * row), byte(0.05 * (i % kSize)), 255});
    }
    materials::Material material;
    material.texture("normalTexture").texture = addTexture(scene, kSize, kSize, normals);
    material.texture("metallicRoughnessTexture").texture = addTexture(scene, kSize, kSize, data);
    material.texture("occlusionTexture").texture = addTexture(scene, kSize, kSize, data);
    addQuad(scene, material, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    const auto packed = [&](TexelFormat format, const std::vector<std::uint8_t>& pixels,
                            const std::array<int, 2>& channels) {
        std::vector<std::uint8_t> blocks;
        for (std::uint32_t block = 0; block < 16; ++block) {
            gltf::BlockTexels texels;
            for (std::uint32_t i = 0; i < 16; ++i) {
                const std::size_t x = block % 4 * 4 + i % 4;
                const std::size_t y = block / 4 * 4 + i / 4;
                std::copy_n(&pixels[4 * (y * kSize + x)], 4, texels[i].begin());
            }
            std::array<std::uint8_t, 16> bytes{};
            gltf::packBlock(format, texels, channels, bytes.data());
            blocks.insert(blocks.end(), bytes.begin(), bytes.begin() + infoOf(format).blockBytes);
        }
        return blocks;
    };
    const std::vector<std::uint8_t> blocks[] = {packed(TexelFormat::Bc5, normals, {0, 1}),
                                                packed(TexelFormat::Bc5, data, {1, 2}),
                                                packed(TexelFormat::Bc4, data, {0, 0})};
    RenderSetup setup = defaultSetup(scene, 32, 32);
    const compiler::CompileSettings settings = settingsForDevice();
    const LoadedScene plain(scene, settings);
    const LoadedScene compressed(scene, settings, [&](session::SceneViewData& view) {
        using enum TexelChannel;
        ASSERT_EQ(view.images.size(), 3U);
        constexpr TexelFormat kFormats[] = {TexelFormat::Bc5, TexelFormat::Bc5, TexelFormat::Bc4};
        constexpr TexelChannels kChannels[] = {{R, G, Zero, One}, {Zero, R, G, One}, {R, Zero, Zero, One}};
        for (std::size_t i = 0; i < 3; ++i) {
            view.images[i].format = kFormats[i];
            view.images[i].pixels = blocks[i];
            view.images[i].channels = kChannels[i];
        }
    });
    const LinearImage expected = plain.render(package::kStrategyUber, setup);
    const LinearImage image = compressed.render(package::kStrategyUber, setup);
    double sum = 0.0;
    double light = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            sum += std::abs(image.pixels[i][channel] - expected.pixels[i][channel]);
            light += expected.pixels[i][channel];
        }
    }
    EXPECT_GT(light, 0.0);
    EXPECT_LT(sum / light, 0.03);
}

TEST(TextureFormats, WhatADeviceCantReadIsRefused) {
    const gltf::Scene scene = squares(1);
    Context& context = sharedContext();
    const LoadedScene loaded(scene, settingsForDevice());
    session::SceneViewData data = session::makeSceneView(scene);
    const auto errorOf = [&](TexelFormat format, std::uint32_t levels, std::size_t bytes) {
        const std::vector<std::uint8_t> blocks(bytes);
        data.images[0].format = format;
        data.images[0].levels = levels;
        data.images[0].pixels = blocks;
        const auto uploaded = GpuScene::upload(context, loaded.package(), data.view());
        return uploaded ? std::string() : uploaded.error().id + ": " + uploaded.error().message;
    };
    // BC4 has no sRGB, which a base colour is in.
    EXPECT_NE(errorOf(TexelFormat::Bc4, 1, 72).find("scene-image: the device does not read BC4"),
              std::string::npos);
    EXPECT_NE(errorOf(TexelFormat::Bc1, 1, 71).find("scene-image: 71 bytes"), std::string::npos);
    EXPECT_NE(errorOf(TexelFormat::Bc1, 5, 72).find("takes 1 to 4"), std::string::npos);
    EXPECT_EQ(errorOf(TexelFormat::Bc1, 1, 72), "");
}

// --- Levels ---

constexpr int kTextureSize = 64;

// An image with all levels, with colours at random.
gltf::Texels noise(std::uint32_t seed) {
    std::mt19937 random(seed);
    gltf::Texels texels{{kTextureSize, kTextureSize}, gltf::PixelFormat::Rgba8, {}};
    texels.bytes.resize(std::size_t{4} * kTextureSize * kTextureSize);
    for (std::uint8_t& byte : texels.bytes) {
        byte = static_cast<std::uint8_t>(random());
    }
    completeLevels(texels, gltf::filtersOf(gltf::LevelFilter::Color));
    return texels;
}

constexpr float kBetweenFloors = 100.0F;

// Metal floors far below each other, which a low sun lights. The first has squares of two roughnesses, and
// the others one of them each.
gltf::Scene roughFloors(std::uint8_t smooth, std::uint8_t rough) {
    gltf::Scene scene = sceneWithCamera();
    addDirectionalLight(scene, {0.0F, -0.5F, 0.866F}, 3.0F);
    const std::array<std::array<std::uint8_t, 2>, 3> pairs{
        {{smooth, rough}, {smooth, smooth}, {rough, rough}}};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        constexpr int kTexels = 16;
        std::vector<std::uint8_t> texels;
        for (int texel = 0; texel < kTexels * kTexels; ++texel) {
            const std::uint8_t code = pairs[i][static_cast<std::size_t>((texel + texel / kTexels) % 2)];
            texels.insert(texels.end(), {255, code, 255, 255});
        }
        materials::Material material;
        materials::TextureInfo& slot = material.texture("metallicRoughnessTexture");
        slot.texture = addTexture(scene, kTexels, kTexels, std::move(texels));
        slot.transform.scale = {400.0F, 400.0F};
        scene.samplers.back() = gltf::Sampler();
        scene.samplers.back().magnification = gltf::Filter::Nearest;
        const float height = -1.0F - kBetweenFloors * static_cast<float>(i);
        addQuad(scene, material, {-40.0F, height, 5.0F}, {80, 0, 0}, {0, 0, -80});
    }
    return scene;
}

// Returns the luminance of a floor's pixels, from a camera 1 m above it.
std::vector<double> pictureOf(const LoadedScene& loaded, const gltf::Scene& scene, std::size_t floor) {
    constexpr std::uint32_t kPixels = 24;
    RenderSetup setup = defaultSetup(scene, kPixels, kPixels);
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    setup.frame.camera.position = {0, -kBetweenFloors * static_cast<float>(floor), 0};
    setup.frame.camera.forward = {0, -0.5F, -0.8660254F};
    setup.frame.camera.up = {0, 0.8660254F, -0.5F};
    const LinearImage image = loaded.render(package::kStrategyUber, setup);
    std::vector<double> light;
    for (const auto& pixel : image.pixels) {
        light.push_back(pixel[1]);
    }
    return light;
}

// Where a pixel covers many squares, the picture that is supersampled on the finest level is the mean of
// those of the two roughnesses.
TEST(TextureLevels, LevelsOfRoughnessAreNearerToTheFinestLevelThanPlainMeans) {
    for (const auto& [smooth, rough] : {std::pair<std::uint8_t, std::uint8_t>{26, 230}, {20, 64}}) {
        const gltf::Scene scene = roughFloors(smooth, rough);
        const gltf::Image& image = scene.images[0];
        const auto errorOf = [&](const std::vector<std::uint8_t>& texels, int levels) {
            const LoadedScene loaded(scene, settingsForDevice(), [&](session::SceneViewData& data) {
                data.images[0].pixels = texels;
                data.images[0].levels = static_cast<std::uint32_t>(levels);
            });
            const std::vector<double> picture = pictureOf(loaded, scene, 0);
            const std::vector<double> ofSmooth = pictureOf(loaded, scene, 1);
            const std::vector<double> ofRough = pictureOf(loaded, scene, 2);
            double sum = 0.0;
            for (std::size_t i = 0; i < picture.size(); ++i) {
                const double expected = 0.5 * (ofSmooth[i] + ofRough[i]);
                sum += std::pow(picture[i] - expected, 2.0) / (std::pow(expected, 2.0) + 0.01);
            }
            return sum / static_cast<double>(picture.size());
        };
        gltf::Texels plain{{image.width, image.height}, image.format, image.pixels};
        completeLevels(plain, gltf::filtersOf(gltf::LevelFilter::Data));
        const auto fitted =
            fitImage(scene, image, imageUses(scene)[0], {.formats = sharedContext().texelFormats()});
        ASSERT_TRUE(fitted.ok());
        EXPECT_LT(errorOf(fitted->texels, fitted->levels), 0.5 * errorOf(plain.bytes, plain.levels));
    }
}

// Two unlit squares side by side, with textures of 64 x 64 texels, and one behind the camera.
gltf::Scene texturedPair() {
    gltf::Scene scene = sceneWithCamera();
    for (int i = 0; i < 3; ++i) {
        const gltf::Texels texels = noise(static_cast<std::uint32_t>(i));
        materials::Material material = unlitMaterial({1.0F, 1.0F, 1.0F});
        material.texture("baseColorTexture").texture =
            addTexture(scene, kTextureSize, kTextureSize, texels.bytes);
        scene.images.back().levels = texels.levels;
        scene.samplers.back() = gltf::Sampler();
        const float z = i == 2 ? 1.0F : -1.0F;
        addQuad(scene, material, {i == 1 ? 0.0F : -1.0F, -1.0F, z}, {1, 0, 0}, {0, 2, 0});
    }
    return scene;
}

// At 32 x 32 pixels a square shows 4 texels a pixel across and 2 down, so that the geometric mean is
// level 1.5.
TEST(TextureLevels, TheFinestLevelThatWasReadIsNoted) {
    gltf::Scene scene = texturedPair();
    for (gltf::Sampler& sampler : scene.samplers) {
        sampler.mip = gltf::Filter::Nearest;  // such samplers have no anisotropy on any device
    }
    compiler::CompileSettings settings = settingsForDevice();
    settings.textureLevels = true;
    const LoadedScene loaded(scene, settings);
    EXPECT_TRUE(loaded.package().textureLevels());
    for (const auto& [size, level] : {std::pair(32U, 1U), std::pair(16U, 2U), std::pair(8U, 3U)}) {
        Renderer::Counters counters;
        const RenderSetup setup = defaultSetup(scene, size, size);
        for (const package::Strategy strategy : {package::kStrategyUber, package::kStrategyVisibility}) {
            loaded.render(strategy, setup, &counters);
            ASSERT_EQ(counters.textureLevels.size(), 3U);
            EXPECT_EQ(counters.textureLevels[0], level) << size;
            EXPECT_EQ(counters.textureLevels[1], level) << size;
            EXPECT_EQ(counters.textureLevels[2], Renderer::Counters::kLevelNotRead) << size;
        }
    }
}

TEST(TextureLevels, WithoutTheSettingThereIsNeitherCodeNorCounter) {
    const gltf::Scene scene = texturedPair();
    compiler::CompileSettings noting = settingsForDevice();
    noting.textureLevels = true;
    const auto withLevels = compilePackage(scene, noting);
    const auto without = compilePackage(scene, settingsForDevice());
    ASSERT_TRUE(withLevels.ok() && without.ok());
    const LoadedScene loaded(scene, settingsForDevice());
    EXPECT_FALSE(loaded.package().textureLevels());
    Renderer::Counters counters;
    loaded.render(package::kStrategyUber, defaultSetup(scene, 8, 8), &counters);
    EXPECT_TRUE(counters.textureLevels.empty());
    const auto atomicsOf = [](const compiler::CompiledPackage& package) {
        std::size_t count = 0;
        for (const compiler::CompiledModule& module : package.modules) {
            for (std::size_t word = 5; word < module.spirv.size(); word += module.spirv[word] >> 16U) {
                constexpr std::uint32_t kOpAtomicUMax = 239;
                count += (module.spirv[word] & 0xFFFFU) == kOpAtomicUMax ? 1 : 0;
            }
        }
        return count;
    };
    EXPECT_GT(atomicsOf(*withLevels), 0U);
    EXPECT_EQ(atomicsOf(*without), 0U);
}

// --- Streaming ---

class Streaming {
public:
    Streaming(const gltf::Scene& scene, bool editable, std::uint32_t firstTexels = 8)
        : scene_(scene), frames_(sharedContext()) {
        compiler::CompileSettings settings;
        settings.plan.fallback = editable;
        settings.strategies = package::kStrategyUber;
        settings.tracers = tracerOfDevice();
        loaded_.emplace(scene_, settings);
        data_ = session::makeSceneView(scene_);
        SceneView view = data_.view();
        whole_ = uploadScene(loaded_->package(), view);
        view.editable = editable;
        view.streamsTextures = true;
        view.firstTexels = firstTexels;
        streamed_ = uploadScene(loaded_->package(), view);
        setup_ = defaultSetup(scene_, 32, 32);
        setup_.frame.averagedSamples = 1;
        renderer_ = rendererOf(*streamed_);
    }
    ~Streaming() {
        frames_.drain();
    }

    TextureStream& stream() {
        return *streamed_->textureStream();
    }
    GpuScene& scene() {
        return *streamed_;
    }

    // Submits a frame; returns how many levels were completed.
    std::uint32_t frame(std::uint64_t bytes) {
        VkCommandBuffer commands = frames_.begin();
        stream().complete(frames_.completed());
        if (streamed_->editor() != nullptr) {
            streamed_->editor()->complete(frames_.completed());
        }
        const std::uint32_t levels = must(stream().record(commands, frames_.frame(), bytes));
        if (streamed_->editor() != nullptr) {
            EXPECT_TRUE(streamed_->editor()->record(commands, frames_.frame()));
        }
        EXPECT_TRUE(renderer_->record(commands, setup_.frame));
        frames_.submit();
        return levels;
    }
    void drain() {
        frames_.drain();
        stream().complete(frames_.completed());
        if (streamed_->editor() != nullptr) {
            streamed_->editor()->complete(frames_.completed());
        }
    }
    LinearImage picture() {
        drain();
        return *renderer_->render(setup_.frame);
    }
    LinearImage wholePicture() {
        return *rendererOf(*whole_)->render(setup_.frame);
    }

private:
    std::unique_ptr<Renderer> rendererOf(GpuScene& scene) {
        RendererOptions options;
        options.strategy = package::kStrategyUber;
        options.width = 32;
        options.height = 32;
        return makeRenderer(loaded_->package(), scene, options);
    }

    gltf::Scene scene_;
    std::optional<LoadedScene> loaded_;
    session::SceneViewData data_;
    std::unique_ptr<GpuScene> whole_;
    std::unique_ptr<GpuScene> streamed_;
    std::unique_ptr<Renderer> renderer_;
    RenderSetup setup_;
    TwoFrames frames_;
};

class TextureStreaming : public ::testing::TestWithParam<bool> {};

// Small steps, so that levels arrive in parts, with two frames in flight.
TEST_P(TextureStreaming, LevelsArriveUntilThePictureIsThatOfTheWholeScene) {
    Streaming streaming(texturedPair(), GetParam());
    const LinearImage whole = streaming.wholePicture();
    const LinearImage coarse = streaming.picture();
    EXPECT_NE(coarse.pixels, whole.pixels);
    EXPECT_EQ(streaming.stream().finest(0), 3U);
    // Levels 0 to 2 of three textures.
    EXPECT_EQ(streaming.stream().progress().textures, 3U);
    EXPECT_EQ(streaming.stream().progress().bytes, 3U * 4 * (64 * 64 + 32 * 32 + 16 * 16));
    std::uint32_t completed = 0;
    std::uint32_t finest = 3;
    int frames = 0;
    for (; streaming.stream().progress().textures > 0 && frames < 100; ++frames) {
        completed += streaming.frame(3000);
        EXPECT_LE(streaming.stream().finest(1), finest);
        finest = streaming.stream().finest(1);
    }
    EXPECT_EQ(completed, 9U);
    EXPECT_GT(frames, 15);
    EXPECT_LT(frames, 60);
    const LinearImage fine = streaming.picture();
    EXPECT_EQ(fine.pixels, whole.pixels);
    EXPECT_EQ(streaming.stream().retiredBytes(), 0U);
    EXPECT_EQ(streaming.frame(1U << 20), 0U);
    streaming.drain();
}

TEST_P(TextureStreaming, CoarserLevelsComeFirstAndLimitsHold) {
    Streaming streaming(texturedPair(), GetParam());
    TextureStream& stream = streaming.stream();
    stream.setFinest(0, 2);
    stream.setFinest(99, 0);
    // The level of 16 x 16 texels of every texture comes before any of 32 x 32.
    EXPECT_EQ(streaming.frame(std::uint64_t{3} * 4 * 16 * 16), 3U);
    for (const std::uint32_t texture : {0U, 1U, 2U}) {
        EXPECT_EQ(stream.finest(texture), 2U);
    }
    while (stream.progress().textures > 0) {
        streaming.frame(1U << 20);
    }
    EXPECT_EQ(stream.finest(0), 2U);
    EXPECT_EQ(stream.finest(1), 0U);
    stream.setFinest(0, 0);
    EXPECT_EQ(stream.progress().textures, 1U);
    streaming.frame(1U << 20);
    EXPECT_EQ(stream.finest(0), 0U);
    EXPECT_EQ(streaming.picture().pixels, streaming.wholePicture().pixels);
    VkCommandBuffer none = VK_NULL_HANDLE;
    EXPECT_EQ(mustFail(stream.record(none, 0)).id, "stream-frame");
}

INSTANTIATE_TEST_SUITE_P(Scenes, TextureStreaming, ::testing::Bool(), [](const auto& editable) {
    return editable.param ? std::string("Editable") : std::string("Still");
});

// A texture that is replaced while its levels arrive, by one that streams in turn, and one that is removed.
TEST(TextureStreamingEdits, ReplacedTexturesStreamAnew) {
    Streaming streaming(texturedPair(), true);
    streaming.frame(3000);
    SceneEditor& editor = *streaming.scene().editor();
    const gltf::Texels other = noise(7);
    ImageView view{kTextureSize, kTextureSize, other.bytes};
    view.levels = static_cast<std::uint32_t>(other.levels);
    ASSERT_TRUE(editor.replaceTexture(editor.texture(0), view));
    EXPECT_EQ(streaming.stream().finest(0), 3U);
    const TextureHandle added = must(editor.addTexture(view, true));
    EXPECT_EQ(streaming.stream().finest(added.index), 3U);
    streaming.frame(3000);
    ASSERT_TRUE(editor.removeTexture(added));
    // One without levels does not stream.
    const std::vector<std::uint8_t> gray(std::size_t{4} * 32 * 32, 128);
    ASSERT_TRUE(editor.replaceTexture(editor.texture(1), {32, 32, gray}));
    EXPECT_EQ(streaming.stream().finest(1), 0U);
    for (int i = 0; streaming.stream().progress().textures > 0 && i < 100; ++i) {
        streaming.frame(3000);
    }
    EXPECT_EQ(streaming.stream().progress().textures, 0U);
    const LinearImage streamed = streaming.picture();
    // The same content without streaming.
    gltf::Scene scene = texturedPair();
    scene.images[0].pixels = other.bytes;
    scene.images[1].pixels = gray;
    scene.images[1].width = 32;
    scene.images[1].height = 32;
    scene.images[1].levels = 1;
    Streaming whole(scene, true);
    EXPECT_EQ(streamed.pixels, whole.wholePicture().pixels);
}

}  // namespace
}  // namespace glint::testing
