// Tests the order of triangles and instances in acceleration structures: pictures do not depend on it, and
// the device uses it.
#include "context/context.h"
#include "data/traversal_order.h"
#include "render/hit_kernel.h"
#include "render/scene_builder.h"
#include "support/halved_tree.h"
#include "support/must.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

namespace glint::testing {
namespace {

constexpr std::uint32_t kWidth = 16;  // quads of the hills in each direction

// Returns the even or odd columns of quads of a square of hills under the camera, 4 m wide, with `material`.
gltf::Primitive hills(int material, std::uint32_t parity) {
    gltf::Primitive primitive = makeQuad(material, {-2, -1, -4}, {4, 0, 0}, {0, 0, -4});
    primitive.positions.clear();
    primitive.normals.clear();
    primitive.texCoords0.clear();
    primitive.indices.clear();
    for (std::uint32_t y = 0; y <= kWidth; ++y) {
        for (std::uint32_t x = 0; x <= kWidth; ++x) {
            const float u = static_cast<float>(x) / kWidth;
            const float v = static_cast<float>(y) / kWidth;
            primitive.positions.push_back(
                {4.0F * u - 2.0F, 0.2F * std::sin(11.0F * u) * std::cos(9.0F * v) - 1.0F, -1.0F - 4.0F * v});
            primitive.texCoords0.push_back({4.0F * u, 4.0F * v});
        }
    }
    for (std::uint32_t y = 0; y < kWidth; ++y) {
        for (std::uint32_t x = parity; x < kWidth; x += 2) {
            const std::uint32_t a = y * (kWidth + 1) + x;
            const std::uint32_t b = a + kWidth + 1;
            for (const std::uint32_t corner : {a, a + 1, b, a + 1, b + 1, b}) {
                primitive.indices.push_back(corner);
            }
        }
    }
    return primitive;
}

void shuffleTriangles(gltf::Primitive& primitive) {
    std::vector<std::array<std::uint32_t, 3>> triangles(primitive.indices.size() / 3);
    for (std::size_t i = 0; i < primitive.indices.size(); ++i) {
        triangles[i / 3][i % 3] = primitive.indices[i];
    }
    std::ranges::shuffle(triangles, std::mt19937(7));
    for (std::size_t i = 0; i < primitive.indices.size(); ++i) {
        primitive.indices[i] = triangles[i / 3][i % 3];
    }
}

// Returns mirrors and masked stripes in one mesh, nine times, under a wall that they reflect.
gltf::Scene stripes(bool shuffled) {
    gltf::Scene scene = emptyScene();
    const int mirror = addMaterial(scene, mirrorMaterial());
    const int texture =
        addTexture(scene, 2, 2, {255, 90, 90, 255, 90, 255, 90, 0, 90, 90, 255, 0, 255, 255, 90, 255});
    materials::Material masked = mirrorMaterial();
    masked.alphaMode = materials::AlphaMode::Mask;
    masked.texture("baseColorTexture").texture = texture;
    const int mask = addMaterial(scene, masked);
    gltf::Mesh& mesh = scene.meshes.emplace_back();
    mesh.primitives = {hills(mirror, 0), hills(mask, 1)};
    if (shuffled) {
        for (gltf::Primitive& primitive : mesh.primitives) {
            shuffleTriangles(primitive);
        }
    }
    std::vector<std::array<double, 2>> places;
    for (int i = 0; i < 9; ++i) {
        places.push_back({4.0 * (i % 3) - 4.0, -4.0 * (i / 3)});
    }
    if (shuffled) {
        std::ranges::shuffle(places, std::mt19937(8));
    }
    for (const auto& [x, z] : places) {
        gltf::Matrix4 world = scaling(1, 1, 1);
        world[12] = x;
        world[14] = z;
        addInstance(scene, 0, world);
    }
    const int wall = addMaterial(scene, unlitMaterial({0.2F, 0.7F, 0.3F}));
    addQuad(scene, wall, {-8, -1, -14}, {16, 0, 0}, {0, 5, 0});
    addCamera(scene);
    return scene;
}

LinearImage render(const gltf::Scene& scene, SceneView::TraversalOrder order) {
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    const LoadedScene loaded(scene, settings,
                             [&](session::SceneViewData& data) { data.traversalOrder = order; });
    return loaded.render(package::kStrategyUber, defaultSetup(scene, 64, 36));
}

TEST(Traversal, PicturesDoNotShowTheOrder) {
    const LinearImage input = render(stripes(false), SceneView::TraversalOrder::Input);
    EXPECT_EQ(render(stripes(true), SceneView::TraversalOrder::Halving).pixels, input.pixels);
    // A mirror that reflects sky and wall has more than a few colours.
    EXPECT_NE(input.pixels[2200], input.pixels[1100]);
}

// Rays go straight down to the centre of each triangle. They return the number that the driver gives it.
TEST(Traversal, TheDeviceHasTheTrianglesInOrder) {
    gltf::Scene scene = emptyScene();
    gltf::Primitive primitive = hills(addMaterial(scene, unlitMaterial({1, 1, 1})), 0);
    shuffleTriangles(primitive);
    const gltf::Primitive own = primitive;
    addInstance(scene, addMesh(scene, std::move(primitive)));
    addCamera(scene);
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    const LoadedScene loaded(scene, settings, [](session::SceneViewData& data) {
        data.traversalOrder = SceneView::TraversalOrder::Halving;
    });
    const std::unique_ptr<HitKernel> kernel = must(HitKernel::create(scene, loaded, "hit_numbers.comp"));
    const std::size_t count = own.indices.size() / 3;
    std::vector<LeafBox> leaves(count);
    std::vector<gpu::RayRecord> rays(count);
    for (std::size_t i = 0; i < own.indices.size(); ++i) {
        const gltf::Float3& corner = own.positions[own.indices[i]];
        leaves[i / 3].extend(corner);
        rays[i / 3].origin.x += corner[0] / 3.0F;
        rays[i / 3].origin.y = 5.0F;
        rays[i / 3].origin.z += corner[2] / 3.0F;
        rays[i / 3].direction = {0.0F, -1.0F, 0.0F};
    }
    const std::vector<std::uint32_t> numbers =
        must(kernel->run({}, rays, static_cast<std::uint32_t>(count), 2 * count));
    std::vector<std::uint32_t> order(count, static_cast<std::uint32_t>(count));
    for (std::uint32_t i = 0; i < count; ++i) {
        EXPECT_EQ(numbers[2 * i], 0U);
        ASSERT_LT(numbers[2 * i + 1], count);
        order[numbers[2 * i + 1]] = i;
    }
    ASSERT_EQ(std::ranges::count(order, count), 0) << "two triangles have one number";
    std::vector<std::uint32_t> given(count);
    std::iota(given.begin(), given.end(), 0U);
    const double cost = test::halvedTreeCost(leaves, order);
    EXPECT_LT(cost, 1.02 * test::halvedTreeCost(leaves, halvingOrder(leaves, 1)));
    EXPECT_GT(test::halvedTreeCost(leaves, given), 5.0 * cost) << "the shuffled input is no problem to solve";
}

}  // namespace
}  // namespace glint::testing
