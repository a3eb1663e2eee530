// Compares levels of detail of given hits with a computation in double precision.
#include "render/hit_query.h"
#include "render/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr float kEndless = std::numeric_limits<float>::infinity();

// A square metre has 1024 x 512 texels, so a footprint of w metres has w * sqrt(1024 * 512) texels a side.
constexpr std::array<double, 2> kTexels{1024.0, 512.0};

gltf::Scene squareScene(const std::vector<double>& scales) {
    gltf::Scene scene = emptyScene();
    materials::Material material;
    material.texture("baseColorTexture").texture = addTexture(scene, 1, 1, {255, 255, 255, 255});
    const gltf::Primitive quad = makeQuad(addMaterial(scene, material), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const int mesh = addMesh(scene, quad);
    for (const double scale : scales) {
        addInstance(scene, mesh, scaling(scale, scale, scale));
    }
    return scene;
}

double texelsAlong(const gltf::Float2& gradient) {
    return std::hypot(gradient[0] * kTexels[0], gradient[1] * kTexels[1]);
}

// Returns the level that a sampler without anisotropy reads: Vulkan 1.3, section "Scale Factor Operation, LOD
// Operation and Image Level(s) Selection".
double levelOf(const Values& values) {
    const double longest = std::max(texelsAlong(values.gradientAcross), texelsAlong(values.gradientAlong));
    return longest > 1.0 ? std::log2(longest) : 0.0;
}

bool isFinite(const Values& values) {
    return std::isfinite(texelsAlong(values.gradientAcross)) &&
           std::isfinite(texelsAlong(values.gradientAlong));
}

TEST(HitFootprint, LevelOfDetailOfAPlaneIsAnalytic) {
    const std::vector<double> scales{1.0, 1e6, 1e-6, 1e-12};
    const gltf::Scene scene = squareScene(scales);
    std::vector<Query> queries;
    std::vector<double> expected;
    for (std::uint32_t i = 0; i < scales.size(); ++i) {
        for (const double texels : {0.5, 1.0, 3.0, 1000.0, 1e9}) {
            // The rays go straight down, and under a cosine of 0.36. Without anisotropy the area of the
            // footprint counts, which is the square of its width over the cosine.
            for (const double cosine : {1.0, 0.36}) {
                const double width = texels * scales[i] / std::sqrt(kTexels[0] * kTexels[1]);
                const auto sine = static_cast<float>(std::sqrt(1.0 - cosine * cosine));
                queries.push_back({i,
                                   1,
                                   {0.3F, 0.3F},
                                   {sine, 0.0F, static_cast<float>(-cosine)},
                                   static_cast<float>(width)});
                expected.push_back(std::max(0.0, std::log2(texels / std::sqrt(cosine))));
            }
        }
    }
    const std::vector<Values> values = ask(scene, queries);
    ASSERT_EQ(values.size(), queries.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_NEAR(levelOf(values[i]), expected[i], 1e-5) << "query " << i;
    }
}

// A cone meets the square in an ellipse. Its axes as (Δu, Δv) are (x, -y) there, because V points down.
TEST(HitFootprint, GradientsAreTheAxesOfTheFootprint) {
    constexpr double kWidth = 0.01;
    constexpr float kAnisotropy = 16.0F;
    const gltf::Scene scene = squareScene({1.0});
    struct Expectation {
        double cosine;
        double turn;
        double elongation;  // of the axis along the ray
    };
    // The last one is below the smallest cosine.
    const Expectation expectations[] = {{0.8, 0.0, 1.25}, {0.5, 0.3, 2.0},  {0.25, 2.0, 4.0},
                                        {0.1, 4.0, 10.0}, {0.1, 1.5, 10.0}, {0.001, 0.7, 100.0}};
    std::vector<Query> queries;
    for (const Expectation& e : expectations) {
        const double sine = std::sqrt(1.0 - e.cosine * e.cosine);
        queries.push_back({0,
                           0,
                           {0.3F, 0.3F},
                           {static_cast<float>(sine * std::cos(e.turn)),
                            static_cast<float>(sine * std::sin(e.turn)), static_cast<float>(-e.cosine)},
                           static_cast<float>(kWidth),
                           kAnisotropy});
    }
    const std::vector<Values> values = ask(scene, queries);
    ASSERT_EQ(values.size(), queries.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Expectation& e = expectations[i];
        const std::array<double, 2> along{kWidth * e.elongation * std::cos(e.turn),
                                          -kWidth * e.elongation * std::sin(e.turn)};
        const std::array<double, 2> across{kWidth * std::sin(e.turn), kWidth * std::cos(e.turn)};
        // The part that the sampler does not cover is cut to the level of the ellipse's area over the
        // anisotropy.
        const double longest = std::max(std::hypot(along[0] * kTexels[0], along[1] * kTexels[1]),
                                        std::hypot(across[0] * kTexels[0], across[1] * kTexels[1]));
        const double area = kWidth * kWidth * e.elongation * kTexels[0] * kTexels[1];
        const double cut = std::min(1.0, std::sqrt(kAnisotropy * area) / longest);
        const double bound = 1e-5 * kWidth * e.elongation;
        // Both signs mean the same axis.
        const double sign =
            along[0] * values[i].gradientAlong[0] + along[1] * values[i].gradientAlong[1] < 0.0 ? -1.0 : 1.0;
        const double signAcross =
            across[0] * values[i].gradientAcross[0] + across[1] * values[i].gradientAcross[1] < 0.0 ? -1.0
                                                                                                    : 1.0;
        for (std::size_t k = 0; k < 2; ++k) {
            EXPECT_NEAR(sign * values[i].gradientAlong[k], cut * along[k], bound) << "query " << i;
            EXPECT_NEAR(signAcross * values[i].gradientAcross[k], cut * across[k], bound) << "query " << i;
        }
    }
}

TEST(HitFootprint, NoLevelOfDetailWithoutAnArea) {
    // After the square's two triangles come: one without texels, one whose texels are on a line, one without
    // an area in the world, and one without either.
    gltf::Scene scene = squareScene({1.0});
    gltf::Primitive& square = scene.meshes[0].primitives[0];
    for (const bool flat : {false, true}) {
        for (std::size_t k = 0; k < 3; ++k) {
            square.positions.push_back(square.positions[flat && k == 1 ? 0 : k]);
            square.normals.push_back(square.normals[k]);
            square.texCoords0.push_back(flat ? square.texCoords0[k] : gltf::Float2{0.5F, 0.5F});
        }
    }
    for (std::size_t k = 0; k < 3; ++k) {
        square.positions.push_back(square.positions[k]);
        square.normals.push_back(square.normals[k]);
        square.texCoords0.push_back({static_cast<float>(k), 0.5F * static_cast<float>(k)});
    }
    for (const std::uint32_t index : {4U, 5U, 6U, 10U, 11U, 12U, 7U, 8U, 9U, 0U, 0U, 1U}) {
        square.indices.push_back(index);
    }
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    struct Expectation {
        const char* what;
        std::uint32_t triangle;
        float coneWidth;
        bool level;
    };
    const Expectation expectations[] = {
        {"a footprint", 0, 1.0F, true},
        {"no footprint", 0, 0.0F, false},
        {"endless footprint", 0, kEndless, false},
        {"a footprint that is no number", 0, kNaN, false},
        {"a footprint whose area is no float", 0, 1e30F, false},
        {"no texels", 2, 1.0F, false},
        {"texels on a line", 3, 1.0F, false},
        {"no area in the world", 4, 1.0F, false},
        {"neither", 5, 1.0F, false},
        {"neither, endless", 5, kEndless, false},
    };
    std::vector<Query> queries;
    for (const Expectation& expectation : expectations) {
        for (const gltf::Float3 direction :
             {gltf::Float3{0.0F, 0.0F, -1.0F}, gltf::Float3{0.6F, 0.0F, -0.8F}}) {
            for (const float anisotropy : {1.0F, 16.0F}) {
                queries.push_back(
                    {0, expectation.triangle, {0.3F, 0.3F}, direction, expectation.coneWidth, anisotropy});
            }
        }
    }
    const std::vector<Values> values = ask(scene, queries);
    ASSERT_EQ(values.size(), queries.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_TRUE(isFinite(values[i])) << expectations[i / 4].what;
        EXPECT_EQ(levelOf(values[i]) > 0.0, expectations[i / 4].level) << expectations[i / 4].what;
    }
}

}  // namespace
