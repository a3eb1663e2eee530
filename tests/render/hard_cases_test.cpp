// Tests what breaks renderers: NaN and infinity, degenerate geometry, extreme transforms, very bright
// surfaces. Each test holds for both strategies.
#include "image/image_file.h"
#include "render/pixel_test.h"
#include "support/must.h"
#include "support/temporary_folder.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

class HardCases : public PixelTest {};

INSTANTIATE_TEST_SUITE_P(Strategies, HardCases,
                         ::testing::Values(package::kStrategyUber, package::kStrategyVisibility),
                         strategyName);

bool allFinite(const LinearImage& image) {
    for (const Pixel& pixel : image.pixels) {
        for (const float value : pixel) {
            if (!std::isfinite(value)) {
                return false;
            }
        }
    }
    return !image.pixels.empty();
}

// Two quads are side by side in front of the camera, and the left one has a NaN among its vertex colours. The
// importer repairs such a file, but a host application may upload it.
TEST_P(HardCases, ASampleThatIsNoNumberIsBlackAndCounted) {
    gltf::Scene scene = sceneWithCamera();
    const int material = addMaterial(scene, unlitMaterial(kGreen));
    gltf::Primitive left = makeQuad(material, {-1, -1, -1}, {1, 0, 0}, {0, 2, 0});
    left.colors.assign(4, {1, 1, 1, 1});
    left.colorContent = materials::ColorContent::Varying;
    gltf::Primitive right = left;
    for (gltf::Float3& position : right.positions) {
        position[0] += 1.0F;
    }
    left.colors[0][1] = std::numeric_limits<float>::quiet_NaN();  // a corner of both triangles
    addInstance(scene, addMesh(scene, left));
    addInstance(scene, addMesh(scene, right));
    RenderSetup setup = squareSetup(scene);
    setup.samples = 3;
    Renderer::Counters counters;
    const LinearImage image = render(scene, setup, package::AlphaPolicy::Opaque, &counters);
    ASSERT_TRUE(allFinite(image));
    // Jitter moves samples of the middle columns to either side, and those of the border off the quads.
    for (std::uint32_t y = 1; y < 31; ++y) {
        for (std::uint32_t x = 1; x < 31; ++x) {
            if (x < 15) {
                expectColor(at(image, x, y), {0, 0, 0}, 0.0F, "no number");
            } else if (x > 16) {
                expectColor(at(image, x, y), kGreen, 1e-5F, "beside");
            }
        }
    }
    const std::uint32_t half = 16U * 32U * setup.samples;
    EXPECT_NEAR(counters.nonFinite, half, 32U * setup.samples);

    // A new accumulation starts to count again, and a scene without NaN counts nothing.
    scene.meshes[0].primitives[0].colors[0][1] = 1.0F;
    const LinearImage sound = render(scene, setup, package::AlphaPolicy::Opaque, &counters);
    EXPECT_EQ(counters.nonFinite, 0U);
    expectColor(at(sound, 8, 16), kGreen, 1e-5F, "repaired");
}

TEST_P(HardCases, NumbersThatAreNoneDoNotSpreadFromAMirror) {
    gltf::Scene scene = sceneWithCamera();
    gltf::Primitive behind =
        makeQuad(addMaterial(scene, unlitMaterial(kRed)), {9, 0, 3}, {-18, 0, 0}, {0, 9, 0});
    behind.colors.assign(4, {std::numeric_limits<float>::infinity(), 1, 1, 1});
    behind.colorContent = materials::ColorContent::Varying;
    addInstance(scene, addMesh(scene, behind));
    addQuad(scene, mirrorMaterial(), {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    RenderSetup setup = squareSetup(scene);
    Renderer::Counters counters;
    const LinearImage image = render(scene, setup, package::AlphaPolicy::Opaque, &counters);
    ASSERT_TRUE(allFinite(image));
    expectColor(at(image, 16, 4), {0, 0, 0}, 0.0F, "sees the infinite wall");
    expectColor(at(image, 16, 28), {1, 1, 1}, 1e-4F, "sees the sky");
    EXPECT_EQ(counters.nonFinite, 16U * 32U);
}

TEST_P(HardCases, AVeryBrightSurfaceKeepsItsValueInTheFile) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material lamp;
    lamp["baseColorFactor"] = {0, 0, 0, 1};
    lamp["emissiveFactor"] = {1.0F, 0.5F, 0.25F};
    lamp["emissiveStrength"] = 1e5F;
    lamp.give("KHR_materials_emissive_strength");
    addQuad(scene, lamp, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    const RenderSetup setup = darkSetup(scene);
    const LinearImage image = render(scene, setup);
    ASSERT_TRUE(allFinite(image));
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "lamp.exr";
    ASSERT_TRUE(image::writeImage(file, image, 0.0));
    const LinearImage read = must(image::readImage(file));
    // The value is above 65504, where half floats end.
    const Pixel pixel = at(read, 16, 16);
    EXPECT_NEAR(pixel[0], 1e5F, 1.0F);
    EXPECT_NEAR(pixel[1], 0.5e5F, 1.0F);
    EXPECT_NEAR(pixel[2], 0.25e5F, 1.0F);
    EXPECT_TRUE(allFinite(read));
    EXPECT_EQ(read.pixels, image.pixels);
}

// Returns a lit quad that fills the view and, on the right, a mirror of one behind the camera.
gltf::Scene litScene(gltf::Primitive quad, const gltf::Matrix4& world) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material material;
    material["metallicFactor"] = 0.0F;
    material["roughnessFactor"] = 0.6F;
    material["baseColorFactor"] = {0.8F, 0.5F, 0.2F, 1.0F};
    quad.material = addMaterial(scene, material);
    addInstance(scene, addMesh(scene, std::move(quad)), world);
    addQuad(scene, mirrorMaterial(), {0, -1, -1}, {1, 0, 0}, {0, 2, 0});
    addDirectionalLight(scene, {-0.6F, 0.0F, -0.8F}, 2.0F);
    addDirectionalLight(scene, {0.0F, -0.6F, 0.8F}, 3.0F);
    return scene;
}

// Returns walls that face the camera: in front of it on the left, and behind it on all sides.
gltf::Primitive roomWalls() {
    gltf::Primitive walls = makeQuad(0, {-3, -3, -2}, {3, 0, 0}, {0, 6, 0});
    const gltf::Primitive behind = makeQuad(0, {9, -9, 3}, {-18, 0, 0}, {0, 18, 0});
    for (std::size_t i = 0; i < 4; ++i) {
        walls.positions.push_back(behind.positions[i]);
        walls.normals.push_back(behind.normals[i]);
        walls.texCoords0.push_back(behind.texCoords0[i]);
    }
    for (const std::uint32_t index : behind.indices) {
        walls.indices.push_back(4 + index);
    }
    return walls;
}

// Moves the walls into the space of an instance: positions by the inverse of its linear part, normals by its
// transpose.
struct Space {
    const char* name;
    bool mirrors;
    std::array<std::array<double, 3>, 3> linear;
    std::array<std::array<double, 3>, 3> inverse;
};

gltf::Primitive intoSpace(gltf::Primitive walls, const Space& space) {
    for (gltf::Float3& position : walls.positions) {
        const gltf::Float3 p = position;
        for (std::size_t row = 0; row < 3; ++row) {
            position[row] = static_cast<float>(space.inverse[row][0] * p[0] + space.inverse[row][1] * p[1] +
                                               space.inverse[row][2] * p[2]);
        }
    }
    for (std::size_t i = 0; space.mirrors && i < walls.indices.size(); i += 3) {
        std::swap(walls.indices[i], walls.indices[i + 1]);
    }
    for (gltf::Float3& normal : walls.normals) {
        const gltf::Float3 n = normal;
        std::array<double, 3> moved{};
        for (std::size_t row = 0; row < 3; ++row) {
            moved[row] =
                space.linear[0][row] * n[0] + space.linear[1][row] * n[1] + space.linear[2][row] * n[2];
        }
        const double length = std::hypot(moved[0], moved[1], moved[2]);
        for (std::size_t row = 0; row < 3; ++row) {
            normal[row] = static_cast<float>(moved[row] / length);
        }
    }
    return walls;
}

gltf::Matrix4 matrixOf(const Space& space) {
    gltf::Matrix4 matrix{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            matrix[4 * column + row] = space.linear[row][column];
        }
    }
    matrix[15] = 1.0;
    return matrix;
}

constexpr Space kSpaces[] = {
    {"huge", false, {{{1e6, 0, 0}, {0, 1e6, 0}, {0, 0, 1e6}}}, {{{1e-6, 0, 0}, {0, 1e-6, 0}, {0, 0, 1e-6}}}},
    {"tiny", false, {{{1e-6, 0, 0}, {0, 1e-6, 0}, {0, 0, 1e-6}}}, {{{1e6, 0, 0}, {0, 1e6, 0}, {0, 0, 1e6}}}},
    {"uneven", false, {{{1e-3, 0, 0}, {0, 50, 0}, {0, 0, 1}}}, {{{1e3, 0, 0}, {0, 0.02, 0}, {0, 0, 1}}}},
    {"sheared", false, {{{1, 4, 0}, {0, 1, 2}, {0, 0, 1}}}, {{{1, -4, 8}, {0, 1, -2}, {0, 0, 1}}}},
    {"mirrored", true, {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
};

TEST_P(HardCases, TransformsOfEveryKindShowTheSamePicture) {
    const gltf::Scene plain = litScene(roomWalls(), scaling(1, 1, 1));
    const RenderSetup setup = squareSetup(plain);
    const LinearImage expected = render(plain, setup);
    ASSERT_TRUE(allFinite(expected));
    EXPECT_GT(at(expected, 8, 16)[0], 0.3F) << "the wall is lit";
    for (const Space& space : kSpaces) {
        SCOPED_TRACE(space.name);
        gltf::Primitive walls = intoSpace(roomWalls(), space);
        Renderer::Counters counters;
        const LinearImage image = render(litScene(std::move(walls), matrixOf(space)), setup,
                                         package::AlphaPolicy::Opaque, &counters);
        expectSameImage(image, expected, space.name);
        EXPECT_EQ(counters.nonFinite, 0U);
    }
}

TEST_P(HardCases, FlattenedInstancesAreNotThere) {
    const gltf::Scene plain = litScene(roomWalls(), scaling(1, 1, 1));
    const RenderSetup setup = squareSetup(plain);
    const LinearImage expected = render(plain, setup);
    gltf::Scene scene = plain;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const gltf::Matrix4& flat :
         {scaling(0, 0, 0), scaling(1, 1, 0), scaling(1, 1, 1e-40), scaling(1, nan, 1)}) {
        addInstance(scene, scene.nodes[0].mesh, flat);
    }
    Renderer::Counters counters;
    const LinearImage image = render(scene, setup, package::AlphaPolicy::Opaque, &counters);
    EXPECT_EQ(image.pixels, expected.pixels);
    EXPECT_EQ(counters.nonFinite, 0U);
}

// The triangles are a point, a line with a repeated vertex, a line of three vertices, and every vertex twice.
TEST_P(HardCases, DegenerateTrianglesChangeNothing) {
    const gltf::Scene plain = litScene(roomWalls(), scaling(1, 1, 1));
    const RenderSetup setup = squareSetup(plain);
    const LinearImage expected = render(plain, setup);
    gltf::Primitive walls = roomWalls();
    walls.positions.push_back({-1.5F, 0.0F, -2.0F});
    walls.normals.push_back({0.0F, 0.0F, 1.0F});
    walls.texCoords0.push_back({0.5F, 0.5F});
    const std::vector<std::uint32_t> degenerate{0, 0, 0, 0, 1, 0, 2, 1, 1, 0, 8, 2};
    walls.indices.insert(walls.indices.begin(), degenerate.begin(), degenerate.end());
    const auto vertices = static_cast<std::uint32_t>(walls.positions.size());
    for (std::uint32_t i = 0; i < vertices; ++i) {
        walls.positions.push_back(walls.positions[i]);
        walls.normals.push_back(walls.normals[i]);
        walls.texCoords0.push_back(walls.texCoords0[i]);
    }
    for (std::size_t i = 0; i < walls.indices.size(); i += 2) {
        walls.indices[i] += vertices;
    }
    Renderer::Counters counters;
    const LinearImage image =
        render(litScene(std::move(walls), scaling(1, 1, 1)), setup, package::AlphaPolicy::Opaque, &counters);
    expectSameImage(image, expected, "with degenerate triangles");
    EXPECT_EQ(counters.nonFinite, 0U);
}

// A flat normal texture gives the same wall as no texture, whatever happens to the texture's frame.
TEST_P(HardCases, FlatNormalTexturesNeedNoFrame) {
    const gltf::Scene plain = litScene(roomWalls(), scaling(1, 1, 1));
    const RenderSetup setup = squareSetup(plain);
    const LinearImage expected = render(plain, setup);
    ASSERT_TRUE(allFinite(expected));
    const std::vector<std::vector<gltf::Float2>> layouts{
        std::vector<gltf::Float2>(8, {0.5F, 0.5F}),                            // a point
        {{0, 0}, {1, 1}, {2, 2}, {1, 1}, {0, 0}, {1, 1}, {2, 2}, {1, 1}},      // a line
        {{0, 0}, {-1, 0}, {-1, 1}, {0, 1}, {0, 0}, {-1, 0}, {-1, 1}, {0, 1}},  // mirrored
        {{0, 0}, {1e6F, 0}, {1e6F, 1e6F}, {0, 1e6F}, {0, 0}, {1e-20F, 0}, {1, 1}, {0, 1e-20F}}};
    for (std::size_t i = 0; i < layouts.size(); ++i) {
        SCOPED_TRACE("layout " + std::to_string(i));
        gltf::Primitive walls = roomWalls();
        walls.texCoords0 = layouts[i];
        gltf::Scene scene = litScene(std::move(walls), scaling(1, 1, 1));
        // The texel has 16 bits, so that it is flat up to 1 / 65535; an 8-bit texel would be off by half a
        // level.
        const int texture = addTexture(scene, 1, 1, {0x00, 0x80, 0x00, 0x80, 0xFF, 0xFF, 0xFF, 0xFF});
        scene.images.back().format = gltf::PixelFormat::Rgba16;
        scene.materials[0].texture("normalTexture").texture = texture;
        Renderer::Counters counters;
        const LinearImage image = render(scene, setup, package::AlphaPolicy::Opaque, &counters);
        ASSERT_TRUE(allFinite(image));
        EXPECT_EQ(counters.nonFinite, 0U);
        expectSameImage(image, expected, "flat normals");
    }
}

// A quad of 8 x 8 pixels that shows this texture, 8 x 8 texels a pixel, unlit; whole squares of a
// checkerboard.
gltf::Scene checkeredScene(bool masked) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material material = unlitMaterial({1, 1, 1});
    std::vector<std::uint8_t> texels;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const std::uint8_t level = (x + y) % 2 == 0 ? 255 : 0;
            const std::uint8_t color = masked ? 255 : level;
            texels.insert(texels.end(), {color, color, color, masked ? level : std::uint8_t{255}});
        }
    }
    if (masked) {
        material.alphaMode = materials::AlphaMode::Mask;
        material["alphaCutoff"] = 0.6F;
    }
    material.texture("baseColorTexture").texture = addTexture(scene, 64, 64, texels);
    scene.samplers.back().mipmapped = true;
    addQuad(scene, material, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    return scene;
}

// A fine checkerboard far off: cones blend it to grey; mip 0, read at level 0, keeps black and white.
TEST_P(HardCases, Mip0ReadsTheFinestLevel) {
    const gltf::Scene scene = checkeredScene(false);
    RenderSetup setup = squareSetup(scene);
    setup.width = setup.height = 8;
    for (const compiler::TextureLod lod : {compiler::TextureLod::Cones, compiler::TextureLod::Mip0}) {
        compiler::CompileSettings settings;
        settings.textureLod = lod;
        const LoadedScene loaded(scene, settings);
        const LinearImage image = loaded.render(GetParam(), setup);
        for (const Pixel& pixel : image.pixels) {
            if (lod == compiler::TextureLod::Mip0) {
                EXPECT_TRUE(pixel[0] == 0.0F || pixel[0] == 1.0F) << pixel[0];
            } else {
                // The value is half of the texels' light, in 8 bits of sRGB.
                EXPECT_NEAR(pixel[0], 0.5F, 0.01F);
            }
        }
    }
}

// A picture that averages 1024 samples has cones a quarter of a texel wide here: each sample reads the finest
// level, and the mean of samples is the grey that one wide cone reads.
TEST_P(HardCases, ConesShrinkWithTheSamplesThatAPixelAverages) {
    const gltf::Scene scene = checkeredScene(false);
    RenderSetup setup = squareSetup(scene);
    setup.width = setup.height = 8;
    const LoadedScene loaded(scene, compiler::CompileSettings{});
    for (const Pixel& pixel : loaded.render(GetParam(), setup).pixels) {
        EXPECT_NEAR(pixel[0], 0.5F, 0.01F) << "one sample, as wide as the pixel";
    }
    setup.frame.averagedSamples = 1024;
    for (const Pixel& pixel : loaded.render(GetParam(), setup).pixels) {
        EXPECT_TRUE(pixel[0] < 0.01F || pixel[0] > 0.99F) << "one of many samples: " << pixel[0];
    }
    setup.samples = 64;
    setup.frame.averagedSamples = 64;
    const LinearImage asked = loaded.render(GetParam(), setup);
    for (const Pixel& pixel : asked.pixels) {
        EXPECT_NEAR(pixel[0], 0.5F, 0.15F) << "their mean";
    }
    setup.frame.averagedSamples = 0;
    EXPECT_EQ(loaded.render(GetParam(), setup).pixels, asked.pixels) << "render() takes its own count";
}

// The alpha test of the raster pass chooses its level by derivatives of the screen, with the same bias.
TEST_P(HardCases, MasksShrinkWithTheSamplesThatAPixelAverages) {
    const gltf::Scene scene = checkeredScene(true);
    RenderSetup setup = darkSetup(scene, 8);
    const LoadedScene loaded(scene, compiler::CompileSettings{});
    const auto mean = [](const LinearImage& image) {
        float sum = 0.0F;
        for (const Pixel& pixel : image.pixels) {
            sum += pixel[0] / static_cast<float>(image.pixels.size());
        }
        return sum;
    };
    EXPECT_EQ(mean(loaded.render(GetParam(), setup)), 0.0F) << "half of the texels is less than the cutoff";
    setup.samples = 64;
    EXPECT_NEAR(mean(loaded.render(GetParam(), setup)), 0.5F, 0.1F) << "half of the samples meet a texel";
}

}  // namespace
