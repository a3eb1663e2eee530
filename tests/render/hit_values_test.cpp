// Compares positions, normals and attributes of given hits with a computation in double precision.
#include "base/vectors.h"
#include "render/hit_query.h"
#include "render/scene_builder.h"

#include <glint/session/scene_view.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

glm::dvec3 blend(const std::array<gltf::Float3, 3>& corners, const gltf::Float2& barycentrics) {
    return base::toVector(corners[0]) * (1.0 - double{barycentrics[0]} - double{barycentrics[1]}) +
           base::toVector(corners[1]) * double{barycentrics[0]} +
           base::toVector(corners[2]) * double{barycentrics[1]};
}

// Transforms a normal by the inverse transpose.
glm::dvec3 transformNormal(const std::array<float, 12>& rows, const glm::dvec3& n) {
    const glm::dmat3 transposed(glm::make_mat3x4(rows.data()));
    return glm::normalize(glm::inverse(transposed) * n);
}

constexpr std::array<gltf::Float3, 3> kPositions{
    {{0.1F, 0.2F, 0.3F}, {1.0F, 0.3F, 0.1F}, {0.2F, 1.1F, 0.4F}}};
constexpr std::array<gltf::Float3, 3> kNormals{
    {{0.0F, 0.6F, 0.8F}, {0.48F, 0.64F, 0.6F}, {-0.36F, 0.48F, 0.8F}}};
constexpr std::array<gltf::Float2, 3> kTexCoords{{{0.1F, 0.7F}, {3.3F, -0.2F}, {1e-5F, 7.1F}}};
constexpr std::array<gltf::Float4, 3> kColors{
    {{0.1F, 0.2F, 0.7F, 1.0F}, {0.9F, 1e-6F, 0.3F, 1.0F}, {0.123F, 1.0F, 0.77F, 1.0F}}};

gltf::Scene triangleScene(const std::vector<gltf::Matrix4>& placements) {
    gltf::Scene scene = emptyScene();
    materials::Material material;
    material.texture("baseColorTexture").texture = addTexture(scene, 1, 1, {255, 255, 255, 255});
    gltf::Primitive triangle;
    triangle.pointer = "/meshes/0/primitives/0";
    triangle.material = addMaterial(scene, material);
    triangle.positions.assign(kPositions.begin(), kPositions.end());
    triangle.normals.assign(kNormals.begin(), kNormals.end());
    triangle.texCoords0.assign(kTexCoords.begin(), kTexCoords.end());
    triangle.colors.assign(kColors.begin(), kColors.end());
    triangle.colorContent = materials::ColorContent::Varying;
    triangle.indices = {0, 1, 2};
    const int mesh = addMesh(scene, triangle);
    for (const gltf::Matrix4& placement : placements) {
        addInstance(scene, mesh, placement);
    }
    return scene;
}

// Returns a column-major matrix from the rows of the linear part and a translation.
gltf::Matrix4 matrix(const std::array<std::array<double, 3>, 3>& linear,
                     const std::array<double, 3>& translation, double scale) {
    gltf::Matrix4 result{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            result[4 * column + row] = scale * linear[row][column];
        }
        result[12 + row] = translation[row];
    }
    result[15] = 1.0;
    return result;
}

constexpr std::array<std::array<double, 3>, 3> kRotated{
    {{0.8, -0.6, 0.0}, {0.48, 0.64, -0.6}, {0.36, 0.48, 0.8}}};
constexpr std::array<std::array<double, 3>, 3> kMirrored{
    {{-0.8, 0.6, 0.0}, {0.48, 0.64, -0.6}, {0.36, 0.48, 0.8}}};
constexpr std::array<std::array<double, 3>, 3> kSheared{{{1.0, 7.0, 0.0}, {0.0, 1.0, 3.0}, {0.5, 0.0, -1.0}}};
constexpr std::array<std::array<double, 3>, 3> kStretched{
    {{100.0, 0.0, 0.0}, {0.0, 0.8e-3, -0.6}, {0.0, 0.6e-3, 0.8}}};

// The rounding in and after the sums of a normal is a few units in the last place, and more where a shear
// cancels.
constexpr double kNormalError = 4e-6;

void expectSameDirection(const gltf::Float3& got, const glm::dvec3& expected, const std::string& where) {
    EXPECT_NEAR(glm::dot(base::toVector(got), base::toVector(got)), 1.0, 1e-6) << where;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(base::toVector(got)[axis], expected[axis], kNormalError) << where << ", axis " << axis;
    }
}

TEST(HitValues, TransformsOfEverySizeKeepNormalsAndSides) {
    std::vector<gltf::Matrix4> placements;
    for (const auto& linear : {kRotated, kMirrored, kSheared, kStretched}) {
        for (const double scale : {1.0, 1e6, 1e-6, 1e10, 1e-10}) {
            placements.push_back(matrix(linear, {3.0, -5.0, 7.0}, scale));
        }
    }
    const gltf::Scene scene = triangleScene(placements);
    const session::SceneViewData data = session::makeSceneView(scene);
    std::vector<Query> queries;
    for (std::uint32_t i = 0; i < placements.size(); ++i) {
        for (const gltf::Float2 barycentrics :
             {gltf::Float2{0.0F, 0.0F}, gltf::Float2{0.25F, 0.5F}, gltf::Float2{0.01F, 0.98F}}) {
            queries.push_back({i, 0, barycentrics, {0.48F, -0.6F, -0.64F}, 0.0F});
            queries.push_back({i, 0, barycentrics, {-0.48F, 0.6F, 0.64F}, 0.0F});
        }
    }
    const std::vector<Values> values = ask(scene, queries);
    ASSERT_EQ(values.size(), queries.size());
    const glm::dvec3 winding = glm::cross(base::toVector(kPositions[1]) - base::toVector(kPositions[0]),
                                          (base::toVector(kPositions[2]) - base::toVector(kPositions[0])));
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const Query& query = queries[i];
        const std::string where =
            "placement " + std::to_string(query.geometry) + ", query " + std::to_string(i);
        const auto& rows = data.instances[query.geometry].objectToWorld;
        const glm::dvec3 front = transformNormal(rows, winding);
        const double facing = -glm::dot(front, base::toVector(query.direction));
        ASSERT_GT(std::abs(facing), 1e-3) << where << ": rounding decides the side";
        EXPECT_EQ(values[i].frontFace, facing >= 0.0 ? 1.0F : 0.0F) << where;
        const double side = facing >= 0.0 ? 1.0 : -1.0;
        expectSameDirection(values[i].geometricNormal, {side * front[0], side * front[1], side * front[2]},
                            where);
        expectSameDirection(values[i].normal, transformNormal(rows, blend(kNormals, query.barycentrics)),
                            where);
        const glm::dvec3 off = (base::toVector(values[i].position) -
                                (base::transformed(rows, blend(kPositions, query.barycentrics))));
        EXPECT_LE(std::abs(glm::dot(off, front)), double{values[i].clearance}) << where;
        EXPECT_GT(values[i].clearance, 0.0F) << where;
    }
}

TEST(HitValues, AttributesAtVerticesAreThoseOfTheVertices) {
    const gltf::Scene scene = triangleScene({scaling(1.0, 1.0, 1.0)});
    const std::vector<Values> values =
        ask(scene,
            {{.barycentrics = {0.0F, 0.0F}}, {.barycentrics = {1.0F, 0.0F}}, {.barycentrics = {0.0F, 1.0F}}});
    ASSERT_EQ(values.size(), 3U);
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(values[k].texCoord, kTexCoords[k]) << "vertex " << k;
        EXPECT_EQ(values[k].color, (gltf::Float3{kColors[k][0], kColors[k][1], kColors[k][2]}))
            << "vertex " << k;
        expectSameDirection(values[k].normal, glm::normalize(base::toVector(kNormals[k])),
                            "vertex " + std::to_string(k));
    }
}

// Along edges and inside, a value that is the same at all vertices stays the same, because the weights sum to
// 1.
TEST(HitValues, WeightsSumToOne) {
    gltf::Scene scene = triangleScene({scaling(1.0, 1.0, 1.0)});
    scene.meshes[0].primitives[0].texCoords0.assign(3, {0.7F, 1234.5F});
    std::vector<Query> queries;
    for (int i = 0; i <= 32; ++i) {
        for (int j = 0; i + j <= 32; ++j) {
            const float u = static_cast<float>(i) / 32.0F * 0.999999F;
            const float v = static_cast<float>(j) / 32.0F;
            queries.push_back({.barycentrics = {u, std::min(v, 1.0F - u)}});
        }
    }
    for (const Values& value : ask(scene, queries)) {
        // The bound is one rounding for each product and sum.
        EXPECT_NEAR(value.texCoord[0], 0.7F, 4 * 0x1p-24F);
        EXPECT_NEAR(value.texCoord[1], 1234.5F, 4 * 1234.5F * 0x1p-24F);
    }
}

bool hasFiniteGradients(const Values& values) {
    const auto isFinite = [](float component) { return std::isfinite(component); };
    return std::ranges::all_of(values.gradientAcross, isFinite) &&
           std::ranges::all_of(values.gradientAlong, isFinite);
}

TEST(HitValues, DegenerateTrianglesGiveFiniteHits) {
    gltf::Scene scene = triangleScene({scaling(1.0, 1.0, 1.0)});
    // The triangles are a point, a line with a repeated vertex, a line of three vertices, and one whose area
    // underflows a float.
    gltf::Primitive& primitive = scene.meshes[0].primitives[0];
    primitive.positions.push_back({0.55F, 0.25F, 0.2F});
    primitive.positions.push_back({0.1F, 0.2F, 0.3F});
    for (const gltf::Float3 tiny : {gltf::Float3{0.0F, 0.0F, 0.0F}, gltf::Float3{1e-25F, 0.0F, 0.0F},
                                    gltf::Float3{0.0F, 1e-25F, 0.0F}}) {
        primitive.positions.push_back(tiny);
    }
    primitive.normals.assign(8, {0.0F, 0.0F, 0.0F});
    primitive.texCoords0.resize(8);
    primitive.colors.resize(8);
    primitive.indices = {0, 0, 0, 0, 4, 1, 0, 1, 3, 5, 6, 7};
    std::vector<Query> queries;
    for (std::uint32_t triangle = 0; triangle < 4; ++triangle) {
        queries.push_back({0, triangle, {0.3F, 0.3F}, {0.48F, -0.6F, -0.64F}, 1.0F});
    }
    const std::vector<Values> values = ask(scene, queries);
    ASSERT_EQ(values.size(), 4U);
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (const gltf::Float3& vector : {values[i].geometricNormal, values[i].normal}) {
            EXPECT_NEAR(glm::dot(base::toVector(vector), base::toVector(vector)), 1.0, 1e-6)
                << "triangle " << i;
        }
        EXPECT_TRUE(std::isfinite(values[i].clearance) && hasFiniteGradients(values[i])) << "triangle " << i;
        EXPECT_TRUE(std::isfinite(glm::dot(base::toVector(values[i].position), glm::dvec3{1, 1, 1})))
            << "triangle " << i;
    }
    EXPECT_NEAR(values[0].normal[2], 0.64F, 1e-6F) << "without a side, it faces the viewer";
}

// A ray that leaves a wall must still hit what is close to it.
TEST(HitValues, NoLightLeaksThroughThinGaps) {
    for (const float gap : {1e-3F, 5e-5F}) {
        gltf::Scene scene = emptyScene();
        const int material = addMaterial(scene, unlitMaterial({1, 1, 1}));
        addQuad(scene, material, {-1, -1, 0.5F}, {2, 0, 0}, {0, 2, 0});
        addQuad(scene, material, {-1, -1, 0.5F + gap}, {2, 0, 0}, {0, 2, 0});
        const std::vector<Values> values =
            ask(scene, {{0, 0, {0.4F, 0.4F}, {0, 0, -1}, 0.0F}, {1, 1, {0.4F, 0.4F}, {0, 0, -1}, 0.0F}});
        ASSERT_EQ(values.size(), 2U);
        EXPECT_EQ(values[0].freeAbove, 0U) << gap << ": the other quad shades this one";
        EXPECT_EQ(values[0].freeBelow, 1U) << gap << ": nothing is below";
        EXPECT_EQ(values[1].freeAbove, 1U) << gap << ": nothing is above";
        EXPECT_EQ(values[1].freeBelow, 0U) << gap << ": the first quad stands there";
    }
}

}  // namespace
