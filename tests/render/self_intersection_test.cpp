// Rays that leave a surface must not hit it again. This is counted over many rays, meshes and transforms,
// with the geometry that hits have in the product.
#include "base/files.h"
#include "render/hit_kernel.h"
#include "render/scene_builder.h"
#include "support/must.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

using Double3 = std::array<double, 3>;

constexpr std::uint32_t kSeed = 1;
constexpr std::uint32_t kTrianglesPerMesh = 256;

// Triangles strewn around a point.
struct MeshKind {
    const char* name;
    Double3 centre;
    double spread;
    double edge1;
    double edge2;
    bool flat = false;  // all in the plane z = 0, which has no coordinate to tell the size of errors by
};

// A float near 1e5 has a unit in the last place of 2^-7. A triangle of edge 1e-4 is a point there; one of
// edge 2^-4 is the smallest that has a shape.
constexpr MeshKind kMeshes[] = {
    {"edge 1, at 1e5", {1e5, -1e5, 1e5}, 20.0, 1.0, 1.0},
    {"edge 2^-4, at 1e5", {-1e5, 1e5, 1e5}, 2.0, 0.0625, 0.0625},
    {"edge 1e-4, at 0", {0.0, 0.0, 0.0}, 0.005, 1e-4, 1e-4},
    {"edge 1e-4, at 1", {1.0, -1.0, 1.0}, 0.005, 1e-4, 1e-4},
    {"edge 1000, at 0", {0.0, 0.0, 0.0}, 10000.0, 1000.0, 1000.0},
    {"edges 10 and 0.01, at 3", {3.0, 3.0, -3.0}, 40.0, 10.0, 0.01},
    {"edge 1, in the plane z = 0", {0.0, 0.0, 0.0}, 20.0, 1.0, 1.0, true},
};

// A transform of the mesh's space: three rows of the linear part, and the new place of the mesh's centre.
struct Placement {
    const char* name;
    std::array<Double3, 3> linear;
    Double3 centre;
    bool identity;
};

constexpr double kCos = 0.8;
constexpr double kSin = 0.6;

constexpr Placement kPlacements[] = {
    {"none", {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}, true},
    {"rotated, to 0",
     {{{kCos, -kSin, 0}, {kSin * kCos, kCos* kCos, -kSin}, {kSin * kSin, kCos* kSin, kCos}}},
     {0, 0, 0},
     false},
    {"rotated and scaled by 37, to 1e5",
     {{{37 * kCos, -37 * kSin, 0}, {37 * kSin, 37 * kCos, 0}, {0, 0, 37}}},
     {1e5, 1e5, -1e5},
     false},
    {"scaled by 0.01, 1 and 30",
     {{{0.01 * kCos, -kSin, 0}, {0.01 * kSin, kCos, 0}, {0, 0, 30}}},
     {10, -20, 30},
     false},
    {"sheared and mirrored", {{{-1, 5, 0}, {0, 1, 3}, {0.5, 0, 1}}}, {-5, 7, 11}, false},
};
constexpr std::size_t kPlacementCount = std::size(kPlacements);

double unit(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11U) * 0x1p-53;
}

// The direction is uniform over the sphere (Archimedes).
Double3 randomDirection(std::mt19937_64& random) {
    const double z = 2.0 * unit(random) - 1.0;
    const double angle = 6.283185307179586 * unit(random);
    const double radius = std::sqrt(1.0 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

Double3 along(const Double3& from, const Double3& direction, double length) {
    return {from[0] + length * direction[0], from[1] + length * direction[1],
            from[2] + length * direction[2]};
}

gltf::Float3 toFloat(const Double3& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

gltf::Primitive strewnTriangles(const MeshKind& kind, std::mt19937_64& random) {
    gltf::Primitive primitive;
    primitive.pointer = "/meshes/0/primitives/0";
    for (std::uint32_t i = 0; i < kTrianglesPerMesh; ++i) {
        Double3 corner = kind.centre;
        for (double& value : corner) {
            value += kind.spread * (2.0 * unit(random) - 1.0);
        }
        primitive.positions.push_back(toFloat(corner));
        primitive.positions.push_back(toFloat(along(corner, randomDirection(random), kind.edge1)));
        primitive.positions.push_back(toFloat(along(corner, randomDirection(random), kind.edge2)));
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (kind.flat) {
                primitive.positions[3 * i + k][2] = 0.0F;
            }
            primitive.indices.push_back(3 * i + k);
        }
    }
    return primitive;
}

// Returns a column-major matrix that moves the mesh's centre to where the placement wants it.
gltf::Matrix4 matrixOf(const MeshKind& kind, const Placement& placement) {
    gltf::Matrix4 matrix{};
    for (std::size_t row = 0; row < 3; ++row) {
        double moved = placement.identity ? 0.0 : placement.centre[row];
        for (std::size_t column = 0; column < 3; ++column) {
            matrix[4 * column + row] = placement.linear[row][column];
            moved -= placement.identity ? 0.0 : placement.linear[row][column] * kind.centre[column];
        }
        matrix[12 + row] = moved;
    }
    matrix[15] = 1.0;
    return matrix;
}

Double3 transform(const gltf::Matrix4& m, const Double3& p) {
    Double3 result{};
    for (std::size_t row = 0; row < 3; ++row) {
        result[row] = m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row];
    }
    return result;
}

// Returns a ray towards a random point of a random triangle.
gpu::RayRecord aim(const gltf::Primitive& primitive, const gltf::Matrix4& matrix, std::mt19937_64& random) {
    const std::size_t triangle = random() % kTrianglesPerMesh;
    std::array<Double3, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
        const gltf::Float3& p = primitive.positions[3 * triangle + k];
        corners[k] = transform(matrix, {p[0], p[1], p[2]});
    }
    double u = unit(random);
    double v = unit(random);
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    Double3 target{};
    double size = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        target[k] = corners[0][k] + u * (corners[1][k] - corners[0][k]) + v * (corners[2][k] - corners[0][k]);
        size = std::max(
            {size, std::abs(corners[1][k] - corners[0][k]), std::abs(corners[2][k] - corners[0][k])});
    }
    const Double3 direction = randomDirection(random);
    const gltf::Float3 from = toFloat(along(target, direction, -3.0 * size));
    const gltf::Float3 towards = toFloat(direction);
    gpu::RayRecord ray{};
    ray.origin = {from[0], from[1], from[2]};
    ray.direction = {towards[0], towards[1], towards[2]};
    return ray;
}

// Returns the largest of the terms that make up a coordinate of the world, to which rounding is relative.
double magnitude(const gltf::Primitive& primitive, const gltf::Matrix4& m) {
    double largest = 0.0;
    for (const gltf::Float3& p : primitive.positions) {
        for (std::size_t row = 0; row < 3; ++row) {
            largest = std::max(largest, std::abs(m[row] * p[0]) + std::abs(m[4 + row] * p[1]) +
                                            std::abs(m[8 + row] * p[2]) + std::abs(m[12 + row]));
        }
    }
    return largest;
}

// The counts that the kernel writes for each instance.
struct Counts {
    std::uint32_t leaving;
    std::uint32_t fromHit;
    std::uint32_t fromUnits;
    std::uint32_t fromRayOrigin;
    std::uint32_t largestClearance;  // bits of a float
    std::uint32_t largestUnits;
};
constexpr std::size_t kWords = sizeof(Counts) / sizeof(std::uint32_t);

std::uint64_t wantedRays() {
    // The default is one million rays; sanitizers and slow devices set fewer in the environment.
    const char* text = std::getenv("GLINT_TEST_RAYS");
    return text == nullptr ? 1'000'000 : std::max<std::uint64_t>(1000, std::strtoull(text, nullptr, 10));
}

// Sends the rays, and appends a row for each placement to `table`.
void shoot(const MeshKind& kind, std::uint64_t rays, std::string& table,
           std::array<std::uint64_t, 4>& totals) {
    std::mt19937_64 random(kSeed);
    gltf::Scene scene = emptyScene();
    materials::Material material = unlitMaterial({1.0F, 1.0F, 1.0F});
    material.doubleSided = true;
    addMaterial(scene, material);
    const int mesh = addMesh(scene, strewnTriangles(kind, random));
    for (const Placement& placement : kPlacements) {
        addInstance(scene, mesh, matrixOf(kind, placement));
    }
    const LoadedScene loaded(scene, compiler::PlanOptions{});
    const std::unique_ptr<HitKernel> kernel =
        must(HitKernel::create(scene, loaded, "self_intersection.comp"));

    // Two rays leave each hit. Some rays of the first generation pass between the small triangles.
    const gltf::Primitive& primitive = scene.meshes[0].primitives[0];
    std::vector<gpu::RayRecord> records;
    for (std::uint64_t i = 0; i < rays * 5 / 8; ++i) {
        records.push_back(aim(primitive, scene.nodes[i % kPlacementCount].world, random));
    }
    gpu::FrameConstants constants{};
    constants.seed = kSeed;
    const std::vector<std::uint32_t> words = must(kernel->run(
        constants, records, static_cast<std::uint32_t>(records.size()), kPlacementCount * kWords));
    for (std::size_t i = 0; i < kPlacementCount; ++i) {
        Counts counts{};
        std::copy_n(words.begin() + static_cast<std::ptrdiff_t>(i * kWords), kWords, &counts.leaving);
        const float clearance = std::bit_cast<float>(counts.largestClearance);
        table += fmt::format("| {} | {} | {} | {} | {} | {} | {:.1e} | {:.1e} |\n", kind.name,
                             kPlacements[i].name, counts.leaving, counts.fromHit, counts.fromUnits,
                             counts.fromRayOrigin, std::bit_cast<float>(counts.largestUnits), clearance);
        totals[0] += counts.leaving;
        totals[1] += counts.fromHit;
        totals[2] += counts.fromUnits;
        totals[3] += counts.fromRayOrigin;
        EXPECT_EQ(counts.fromRayOrigin, 0U) << kind.name << ", " << kPlacements[i].name;
        // Rays start on the surface, as far as a scene of that size can show.
        EXPECT_LE(clearance, 1e-4 * magnitude(primitive, scene.nodes[i].world))
            << kind.name << ", " << kPlacements[i].name;
    }
}

TEST(SelfIntersection, NoRayMeetsTheTriangleThatItLeaves) {
    const std::uint64_t rays = wantedRays();
    std::string table = fmt::format(
        "Rays that meet the triangle they leave, at cosines from 0.001 to 1, on both sides; seed {}.\n\n"
        "| mesh | transform | rays | from the hit | offset by 256 units in the last place | offset by the "
        "error bound "
        "| largest offset by units, m | by the bound, m |\n|---|---|---|---|---|---|---|---|\n",
        kSeed);
    std::array<std::uint64_t, 4> totals{};
    for (const MeshKind& kind : kMeshes) {
        shoot(kind, rays / std::size(kMeshes), table, totals);
    }
    table += fmt::format("| all | | {} | {} | {} | {} | | |\n", totals[0], totals[1], totals[2], totals[3]);
    std::cout << table;
    RecordProperty("rays", std::to_string(totals[0]));
    RecordProperty("meetFromHit", std::to_string(totals[1]));
    RecordProperty("meetFromUnits", std::to_string(totals[2]));
    RecordProperty("meetFromRayOrigin", std::to_string(totals[3]));
    EXPECT_TRUE(
        base::writeFile(std::filesystem::path(GLINT_BINARY_DIR) / "tests" / "self_intersection.md", table));
    // The test must be able to detect a fault: most rays must have left a triangle, and some must have hit it
    // without an offset.
    EXPECT_GT(totals[0], rays / 2);
    EXPECT_GT(totals[1], totals[0] / 100);
}

}  // namespace
