// Tests pictures whose pixels can be computed by hand: orientation, colour, reflection, facing, samples. Each
// test holds for both strategies.
#include "context/context.h"
#include "render/pixel_test.h"
#include "support/effect_bits.h"

#include <cmath>

namespace {

using namespace glint;
using namespace glint::testing;

class Pixels : public PixelTest {};

INSTANTIATE_TEST_SUITE_P(Strategies, Pixels,
                         ::testing::Values(package::kStrategyUber, package::kStrategyVisibility),
                         strategyName);

TEST_P(Pixels, AnEmptySceneShowsTheSkyUpright) {
    gltf::Scene scene = sceneWithCamera();
    RenderSetup setup = squareSetup(scene);
    setup.frame.sky = {{0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}};
    Renderer::Counters counters;
    const LinearImage image = render(scene, setup, package::AlphaPolicy::Opaque, &counters);
    EXPECT_EQ(counters.rays, 0U);
    EXPECT_EQ(counters.of(package::kEffectReflection).skippedSky, 32U * 32U);
    // Row 0 looks up by atan(31/32), and the sky is linear in the sine.
    const float sine =
        (31.0F / 32.0F) / std::sqrt(1.0F + std::pow(31.0F / 32.0F, 2.0F) + std::pow(1.0F / 32.0F, 2.0F));
    expectColor(at(image, 16, 0), {0.0F, 0.0F, sine}, 1e-4F, "top");
    expectColor(at(image, 16, 31), {sine, 0.0F, 0.0F}, 1e-4F, "bottom");
}

TEST_P(Pixels, TextureStandsUpright) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material material = unlitMaterial({1.0F, 1.0F, 1.0F});
    // The first row is red and green, the second blue and white.
    material.texture("baseColorTexture").texture =
        addTexture(scene, 2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255});
    addQuad(scene, material, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    const LinearImage image = render(scene, squareSetup(scene));
    expectColor(at(image, 8, 8), {1, 0, 0}, 1e-5F, "top left");
    expectColor(at(image, 24, 8), {0, 1, 0}, 1e-5F, "top right");
    expectColor(at(image, 8, 24), {0, 0, 1}, 1e-5F, "bottom left");
    expectColor(at(image, 24, 24), {1, 1, 1}, 1e-5F, "bottom right");
}

TEST_P(Pixels, ColourTexturesAreSrgbAndBoundTexturesTransform) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material material = unlitMaterial({1.0F, 1.0F, 1.0F});
    materials::TextureInfo& info = material.texture("baseColorTexture");
    info.texture = addTexture(scene, 2, 1, {128, 128, 128, 255, 0, 0, 0, 255});
    // The offset is half of the image, so the black texel comes first.
    info.transform.offset = {0.5F, 0.0F};
    info.hasTransform = true;
    addQuad(scene, material, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    const LinearImage image = render(scene, squareSetup(scene));
    expectColor(at(image, 8, 16), {0, 0, 0}, 1e-5F, "left");
    expectColor(at(image, 24, 16), {0.2158605F, 0.2158605F, 0.2158605F}, 1e-3F,
                "right: sRGB 128 in linear light");
}

// A mirror in front of the camera shows the colour of what is behind the camera.
TEST_P(Pixels, AMirrorShowsWhatIsBehindTheCamera) {
    gltf::Scene scene = sceneWithCamera();
    const int mirror = addMaterial(scene, mirrorMaterial());
    const int red = addMaterial(scene, unlitMaterial(kRed));
    const int blue = addMaterial(scene, unlitMaterial(kBlue));
    addQuad(scene, mirror, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    // Both quads are behind the camera and face it: red above, blue below; right × up points to -Z.
    addQuad(scene, red, {9, 0, 3}, {-18, 0, 0}, {0, 9, 0});
    addQuad(scene, blue, {9, -9, 3}, {-18, 0, 0}, {0, 9, 0});
    addDirectionalLight(scene, {0, -1, 0}, 1.0F);
    Renderer::Counters counters;
    const LinearImage image = render(scene, squareSetup(scene), package::AlphaPolicy::Opaque, &counters);
    EXPECT_EQ(counters.rays, 32U * 32U);
    expectColor(at(image, 16, 4), kRed, 1e-4F, "above");
    expectColor(at(image, 16, 28), kBlue, 1e-4F, "below");
    if (GetParam() == package::kStrategyVisibility) {
        std::uint32_t sum = 0;
        for (const std::uint32_t count : counters.bucketCounts) {
            sum += count;
        }
        EXPECT_EQ(sum, counters.rays);
        EXPECT_EQ(counters.bucketCounts[0], 0U) << "no ray misses";
    }
}

TEST_P(Pixels, AMirrorThatSeesNothingShowsTheSky) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, mirrorMaterial(), {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    RenderSetup setup = squareSetup(scene);
    setup.frame.sky = {kGreen, kGreen, kGreen};
    const LinearImage image = render(scene, setup);
    expectColor(at(image, 16, 16), kGreen, 1e-4F, "centre");
}

// A wall that faces away is invisible if single-sided, in the picture and in the mirror, and visible if
// double-sided. The same holds under a mirroring transform, which must not turn it round.
class Facing : public ::testing::TestWithParam<std::tuple<package::Strategy, bool, bool>> {};

TEST_P(Facing, FollowsTheWindingInObjectSpace) {
    const auto [strategy, doubleSided, mirrored] = GetParam();
    for (const bool facesCamera : {false, true}) {
        gltf::Scene scene = sceneWithCamera();
        materials::Material red = unlitMaterial(kRed);
        red.doubleSided = doubleSided;
        const int wallMaterial = addMaterial(scene, red);
        const int mirror = addMaterial(scene, mirrorMaterial());
        // The left half of the view shows the wall itself. The right half shows a mirror that sees the wall
        // behind the camera.
        const gltf::Float3 right = facesCamera ? gltf::Float3{8, 0, 0} : gltf::Float3{-8, 0, 0};
        const float x = facesCamera ? -8.0F : 0.0F;
        const float mirroredX = mirrored ? -x - right[0] : x;
        // The corners are mirrored in x beforehand, so under a mirroring transform they return with the
        // winding reversed. By definition the front is the same as in object space.
        const gltf::Float3 objectRight = right;
        addInstance(scene,
                    addMesh(scene, makeQuad(wallMaterial, {mirroredX, -4, -2}, objectRight, {0, 8, 0})),
                    scaling(mirrored ? -1.0 : 1.0, 1.0, 1.0));
        addQuad(scene, mirror, {0, -1, -1}, {1, 0, 0}, {0, 2, 0});
        const gltf::Float3 behindRight = facesCamera ? gltf::Float3{-18, 0, 0} : gltf::Float3{18, 0, 0};
        const float behindX = facesCamera ? 9.0F : -9.0F;
        addInstance(scene, addMesh(scene, makeQuad(wallMaterial, {behindX, -9, 3}, behindRight, {0, 18, 0})),
                    scaling(mirrored ? -1.0 : 1.0, 1.0, 1.0));
        compiler::PlanOptions plan;
        const LoadedScene loaded(scene, plan);
        RenderSetup setup = squareSetup(scene);
        const LinearImage image = loaded.render(strategy, setup);
        const bool visible = facesCamera || doubleSided;
        const gltf::Float3 expected = visible ? kRed : gltf::Float3{1, 1, 1};
        expectColor(at(image, 8, 16), expected, 1e-4F, facesCamera ? "seen, front" : "seen, back");
        expectColor(at(image, 24, 16), expected, 1e-4F, facesCamera ? "mirrored, front" : "mirrored, back");
    }
}

INSTANTIATE_TEST_SUITE_P(All, Facing,
                         ::testing::Combine(::testing::Values(package::kStrategyUber,
                                                              package::kStrategyVisibility),
                                            ::testing::Bool(), ::testing::Bool()));

TEST_P(Pixels, ALimitOfZeroStillLetsMirrorsReflect) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, mirrorMaterial(), {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    RenderSetup setup = squareSetup(scene);
    setup.frame.sky = {kGreen, kGreen, kGreen};
    setup.frame.maxReflectionRoughness = 0.0F;
    Renderer::Counters counters;
    const LinearImage image = render(scene, setup, package::AlphaPolicy::Opaque, &counters);
    EXPECT_EQ(counters.rays, 32U * 32U);
    expectColor(at(image, 16, 16), kGreen, 1e-4F, "centre");
}

// A mesh that is split over several acceleration structures stays the same: triangles keep their vertices and
// materials.
TEST_P(Pixels, SplittingAMeshChangesNothing) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material textured = unlitMaterial({1.0F, 1.0F, 1.0F});
    textured.texture("baseColorTexture").texture =
        addTexture(scene, 2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255});
    const int picture = addMaterial(scene, textured);
    gltf::Mesh mesh;
    mesh.primitives = {
        makeQuad(addMaterial(scene, mirrorMaterial()), {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}),
        makeQuad(picture, {9, 0, 3}, {-18, 0, 0}, {0, 9, 0}),
        makeQuad(addMaterial(scene, unlitMaterial(kBlue)), {9, -9, 3}, {-18, 0, 0}, {0, 9, 0})};
    scene.meshes.push_back(mesh);
    addInstance(scene, 0);
    const RenderSetup setup = squareSetup(scene);
    const LinearImage whole = render(scene, setup);
    auto& limits = sharedContext().state().limits.accelerationStructure;
    const auto before = limits.maxPrimitiveCount;
    limits.maxPrimitiveCount = 1;
    const LinearImage split = render(scene, setup);
    limits.maxPrimitiveCount = before;
    EXPECT_EQ(whole.pixels, split.pixels);
}

// How a texture's coordinates are turned: by the transform of the material, by the UVs of the vertices, or
// not.
enum class Turned : std::uint8_t { ByTransform, ByVertices, Not };

// Tiles whose frames come from UVs: a column for each turn, and a row for each reader of a frame. The mirror
// below them shows the same tiles again, so that hits of rays are compared, too.
gltf::Scene framesScene(Turned turned) {
    constexpr struct {
        float rotation;
        gltf::Float2 scale;
        int set;
    } kTurns[] = {{1.5707963F, {1, 1}, 0},
                  {3.1415927F, {1, 1}, 1},
                  {0, {-1, 1}, 0},
                  {0, {1, -1}, 1},
                  {0.6F, {2, -0.5F}, 0}};
    gltf::Scene scene = sceneWithCamera();
    const int tilted = addTexture(scene, 1, 1, {200, 150, 228, 255});
    const int grooves = addTexture(scene, 1, 1, {230, 200, 230, 255});
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 5; ++column) {
            const auto& turn = kTurns[column];
            materials::Material material;
            material["roughnessFactor"] = 0.5F;
            material["metallicFactor"] = row < 2 ? 0.0F : 1.0F;
            material.give(row == 1 ? "KHR_materials_clearcoat" : "KHR_materials_anisotropy");
            material["clearcoatFactor"] = row == 1 ? 1.0F : 0.0F;
            material["clearcoatRoughnessFactor"] = 0.4F;
            material["anisotropyStrength"] = row < 2 ? 0.0F : 0.8F;
            material["anisotropyRotation"] = 0.5F;
            // The last row's grooves have no texture. Their frame is that of the normal texture.
            const char* const slots[] = {"normalTexture", "clearcoatNormalTexture", "anisotropyTexture",
                                         "normalTexture"};
            materials::TextureInfo& info = material.texture(slots[row]);
            info.texture = row == 2 ? grooves : tilted;
            info.texCoord = turn.set;
            if (turned == Turned::ByTransform) {
                info.transform = {{0.25F, 0.5F}, turn.rotation, turn.scale};
                info.hasTransform = true;
            }
            gltf::Primitive tile =
                makeQuad(addMaterial(scene, material),
                         {-2.0F + 0.8F * static_cast<float>(column), 0.5F * static_cast<float>(row), -2},
                         {0.8F, 0, 0}, {0, 0.5F, 0});
            tile.texCoords1 = tile.texCoords0;
            for (gltf::Float2& uv : turn.set == 0 ? tile.texCoords0 : tile.texCoords1) {
                const float u = turn.scale[0] * uv[0];
                const float v = turn.scale[1] * uv[1];
                if (turned == Turned::ByVertices) {
                    uv = {std::cos(turn.rotation) * u + std::sin(turn.rotation) * v,
                          std::cos(turn.rotation) * v - std::sin(turn.rotation) * u};
                }
            }
            const int mesh = addMesh(scene, std::move(tile));
            addInstance(scene, mesh);
            gltf::Matrix4 behind = scaling(-3.0, -3.0, -1.0);
            addInstance(scene, mesh, behind);
        }
    }
    materials::Material mirror = mirrorMaterial();
    addQuad(scene, mirror, {-2, -2, -2}, {4, 0, 0}, {0, 2, 0});
    addDirectionalLight(scene, {0.5F, -0.4F, -0.75F}, 3.0F);
    addDirectionalLight(scene, {0.4F, 0.5F, 0.75F}, 3.0F);
    return scene;
}

TEST(TangentFrames, TurnWithTheTransformsOfTextures) {
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.strategies = package::kStrategyUber | package::kStrategyVisibility;
    const gltf::Scene scene = framesScene(Turned::ByTransform);
    const RenderSetup setup = darkSetup(scene, 40);
    const LoadedScene transformed(scene, settings);
    settings.strategies = package::kStrategyUber;
    const LoadedScene turned(framesScene(Turned::ByVertices), settings);
    const LinearImage expected = turned.render(package::kStrategyUber, setup);
    for (const package::Strategy strategy : {package::kStrategyUber, package::kStrategyVisibility}) {
        expectSameImage(transformed.render(strategy, setup), expected,
                        "transforms as if the vertices had them");
    }
    EXPECT_GT(at(expected, 20, 17)[0], 0.0F);
    EXPECT_GT(at(expected, 20, 22)[0], 0.0F);
}

TEST_P(Pixels, SamplesAverageAndSeedsRepeat) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, unlitMaterial(kRed), {-0.5F, -0.5F, -1}, {1, 0, 0}, {0, 1, 0});
    RenderSetup setup = squareSetup(scene);
    setup.width = setup.height = 31;  // the quad's edge crosses pixels
    setup.samples = 16;
    const LinearImage once = render(scene, setup);
    const LinearImage again = render(scene, setup);
    EXPECT_EQ(once.pixels, again.pixels);
    // An edge pixel holds a mixture of quad and sky.
    const float edge = at(once, 7, 15)[1];
    EXPECT_GT(edge, kRed[1] + 0.05F);
    EXPECT_LT(edge, 0.95F);
    expectColor(at(once, 15, 15), kRed, 1e-5F, "inside");
}

}  // namespace
