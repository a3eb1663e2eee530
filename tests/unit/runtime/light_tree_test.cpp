// Tests the hierarchy over lights: its shape and its bounds, without a device.
#include "data/light_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace glint {
namespace {

gpu::LightRecord point(float x, float y, float z, float intensity = 1.0F, float range = 0.0F) {
    gpu::LightRecord light{};
    light.type = gpu::kLightPoint;
    light.position = {x, y, z};
    light.intensity = {intensity, intensity, intensity};
    light.range = range;
    return light;
}

gpu::LightRecord spot(float x, float y, float z, gpu::vec3 direction, float cosOuter) {
    gpu::LightRecord light = point(x, y, z);
    light.type = gpu::kLightSpot;
    light.direction = direction;
    light.spotScale = 10.0F;
    light.spotOffset = -cosOuter * light.spotScale;
    return light;
}

// Points and spots in a box, and every 50th a directional light.
std::vector<gpu::LightRecord> mixedLights(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    std::vector<gpu::LightRecord> lights;
    for (std::size_t i = 0; i < count; ++i) {
        const gpu::vec3 d{unit(random), unit(random), unit(random)};
        const float length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        lights.push_back(i % 2 == 0
                             ? point(unit(random), unit(random), unit(random), 1.0F + unit(random), 3.0F)
                             : spot(unit(random), unit(random), unit(random),
                                    {d.x / length, d.y / length, d.z / length}, 0.5F));
        lights.back().size = i % 3 == 0 ? 0.2F : 0.0F;
        if (i % 50 == 0) {
            lights.back().type = gpu::kLightDirectional;
        }
    }
    return lights;
}

struct Leaf {
    std::uint32_t node;
    std::uint32_t light;
    std::vector<std::uint32_t> ancestors;
};

// Walks the tree as shaders do.
void collect(const LightTree& tree, std::uint32_t node, std::vector<std::uint32_t>& way,
             std::vector<Leaf>& leaves) {
    const std::uint32_t next = tree.nodes[node].next;
    if ((next & gpu::kLightLeaf) != 0) {
        leaves.push_back({node, next & ~gpu::kLightLeaf, way});
        return;
    }
    ASSERT_GT(next, node + 1);
    ASSERT_LT(next, tree.treeNodes);
    way.push_back(node);
    collect(tree, node + 1, way, leaves);
    collect(tree, next, way, leaves);
    way.pop_back();
}

std::vector<Leaf> leavesOf(const LightTree& tree) {
    std::vector<Leaf> leaves;
    std::vector<std::uint32_t> way;
    if (tree.treeNodes > 0) {
        collect(tree, 0, way, leaves);
    }
    return leaves;
}

void expectBounds(const LightTree& tree, const std::vector<gpu::LightRecord>& lights) {
    for (const Leaf& leaf : leavesOf(tree)) {
        const gpu::LightRecord& light = lights[leaf.light];
        for (const std::uint32_t above : leaf.ancestors) {
            const gpu::LightNode& node = tree.nodes[above];
            const gpu::vec3& at = light.position;
            const float size = light.size - 1e-6F;
            EXPECT_TRUE(at.x - size >= node.lower.x && at.x + size <= node.upper.x);
            EXPECT_TRUE(at.y - size >= node.lower.y && at.y + size <= node.upper.y);
            EXPECT_TRUE(at.z - size >= node.lower.z && at.z + size <= node.upper.z);
            EXPECT_GE(node.reach, light.range > 0.0F ? light.range : INFINITY);
            EXPECT_GE(node.intensity, tree.nodes[leaf.node].intensity * 0.999F);
            EXPECT_LE(node.cosEmission, tree.nodes[leaf.node].cosEmission);
            if (light.type == gpu::kLightSpot) {
                const float cosine = node.axis.x * light.direction.x + node.axis.y * light.direction.y +
                                     node.axis.z * light.direction.z;
                EXPECT_GE(cosine, node.cosAxes - 1e-5F);
            } else {
                EXPECT_EQ(node.cosAxes, -1.0F) << "a point shines everywhere";
            }
        }
    }
}

TEST(LightTree, ReachesEveryLightOnce) {
    for (const std::size_t count : {0U, 1U, 2U, 3U, 64U, 1000U, 20000U}) {
        const std::vector<gpu::LightRecord> lights = mixedLights(count, 1);
        const LightTree tree = buildLightTree(lights);
        std::vector<int> reached(count);
        const std::vector<Leaf> leaves = leavesOf(tree);
        for (const Leaf& leaf : leaves) {
            EXPECT_NE(lights[leaf.light].type, gpu::kLightDirectional);
            ++reached[leaf.light];
        }
        ASSERT_EQ(tree.nodes.size(), tree.treeNodes + tree.apart);
        for (std::uint32_t i = tree.treeNodes; i < tree.nodes.size(); ++i) {
            const std::uint32_t light = tree.nodes[i].next & ~gpu::kLightLeaf;
            EXPECT_EQ(lights[light].type, gpu::kLightDirectional);
            ++reached[light];
        }
        EXPECT_TRUE(std::ranges::all_of(reached, [](int times) { return times == 1; })) << count << " lights";
    }
}

TEST(LightTree, NodesBoundWhatIsBelow) {
    const std::vector<gpu::LightRecord> lights = mixedLights(2000, 2);
    expectBounds(buildLightTree(lights), lights);
}

// Shaders have room for so many nodes that wait.
TEST(LightTree, IsNoDeeperThanShadersCanWalk) {
    std::vector<gpu::LightRecord> lights;
    lights.reserve(300);
    for (int i = 0; i < 300; ++i) {
        lights.push_back(point(std::pow(1.5F, static_cast<float>(i - 150)), 0, 0, 1.0F));
    }
    const std::vector<Leaf> leaves = leavesOf(buildLightTree(lights));
    ASSERT_EQ(leaves.size(), lights.size());
    std::size_t depth = 0;
    for (const Leaf& leaf : leaves) {
        depth = std::max(depth, leaf.ancestors.size());
    }
    std::printf("depth %zu\n", depth);
    EXPECT_LE(depth, gpu::kLightTreeDepth);
}

TEST(LightTree, IsShallow) {
    const std::vector<gpu::LightRecord> lights = mixedLights(20000, 3);
    std::size_t deepest = 0;
    for (const Leaf& leaf : leavesOf(buildLightTree(lights))) {
        deepest = std::max(deepest, leaf.ancestors.size());
    }
    EXPECT_LE(deepest, 36U);  // the shader has random bits for as many
}

TEST(LightTree, LightsAtOnePlaceAreHalved) {
    const std::vector<gpu::LightRecord> lights(1024, point(1.0F, 2.0F, 3.0F));
    const LightTree tree = buildLightTree(lights);
    for (const Leaf& leaf : leavesOf(tree)) {
        EXPECT_EQ(leaf.ancestors.size(), 10U);
    }
    EXPECT_FLOAT_EQ(tree.nodes[0].intensity, 1024.0F);
}

// The bounds of a tree at other positions are those of a tree with the same splits. With the lights of the
// build they are the same to the bit.
TEST(LightTree, RefittingGivesTheBoundsOfTheLights) {
    std::vector<gpu::LightRecord> lights = mixedLights(500, 4);
    LightTree tree = buildLightTree(lights);
    const LightTree built = tree;
    refitLightTree(tree, lights);
    ASSERT_EQ(tree.nodes.size(), built.nodes.size());
    EXPECT_EQ(std::memcmp(tree.nodes.data(), built.nodes.data(), tree.nodes.size() * sizeof(gpu::LightNode)),
              0);

    const std::vector<gpu::LightRecord> others = mixedLights(500, 5);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const std::uint32_t type = lights[i].type;
        lights[i] = others[i];
        lights[i].type = type;
        lights[i].position.x += 100.0F;
    }
    refitLightTree(tree, lights);
    expectBounds(tree, lights);
    EXPECT_GT(tree.nodes[0].lower.x, 90.0F) << "the bounds are those of the new positions alone";
    EXPECT_LT(tree.nodes[0].upper.x, 110.0F);
}

TEST(LightTree, DarkLightsHaveNoIntensity) {
    const LightTree tree = buildLightTree(std::vector{point(0, 0, 0, 0.0F), point(1, 0, 0, 2.0F)});
    ASSERT_EQ(tree.treeNodes, 3U);
    EXPECT_FLOAT_EQ(tree.nodes[0].intensity, 2.0F);
    EXPECT_EQ(std::min(tree.nodes[1].intensity, tree.nodes[2].intensity), 0.0F);
}

// The mean and the deviation of positions, from the shares of the box that a node has.
TEST(LightTree, NodesKnowWhereTheirLightComesFrom) {
    const std::vector<gpu::LightRecord> lights = mixedLights(300, 10);
    const LightTree tree = buildLightTree(lights);
    double weight = 0.0;
    double mean = 0.0;
    double squares = 0.0;
    for (const Leaf& leaf : leavesOf(tree)) {
        const gpu::LightRecord& light = lights[leaf.light];
        const double x = light.position.x;
        weight += light.intensity.x;
        mean += light.intensity.x * x;
        // A light with a size is everywhere in its box.
        squares += light.intensity.x * (x * x + light.size * light.size / 3.0);
    }
    mean /= weight;
    const gpu::LightNode& root = tree.nodes[0];
    const double size = root.upper.x - root.lower.x;
    const auto share = [](std::uint32_t shares) { return (shares & gpu::kLightShares) / 1023.0; };
    EXPECT_NEAR(root.lower.x + size * share(root.mean3x10), mean, size / 1023.0);
    EXPECT_NEAR(size / 2.0 * share(root.deviation3x10), std::sqrt(squares / weight - mean * mean),
                size / 1023.0);
    const LightTree pair = buildLightTree(std::vector{point(0, 1, 0, 3.0F), point(8, 1, 0, 1.0F)});
    EXPECT_NEAR(share(pair.nodes[0].mean3x10), 0.25, 1e-3);
    EXPECT_NEAR(share(pair.nodes[0].deviation3x10), std::sqrt(0.75), 1e-3) << "a share of half of the box";
    EXPECT_EQ(pair.nodes[0].deviation3x10 >> 10, 0U);
    EXPECT_EQ(pair.nodes[1].deviation3x10, 0U) << "one point";
}

// Triangles of random places and normals, of which every fifth is dark and every third shines on both sides.
std::vector<EmitterBounds> someEmitters(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::vector<EmitterBounds> emitters(count);
    for (std::size_t i = 0; i < count; ++i) {
        EmitterBounds& emitter = emitters[i];
        double squared = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            emitter.lower[axis] = unit(random);
            emitter.upper[axis] = emitter.lower[axis] + 0.05 * (1.0 + unit(random));
            emitter.normal[axis] = unit(random);
            squared += emitter.normal[axis] * emitter.normal[axis];
        }
        for (double& component : emitter.normal) {
            component /= std::sqrt(squared);
        }
        emitter.twoSided = i % 3 == 0;
        emitter.intensity = i % 5 == 0 ? 0.0 : 1.0 + unit(random);
    }
    return emitters;
}

void expectEmitterBounds(const LightTree& tree, const std::vector<EmitterBounds>& emitters) {
    for (const Leaf& leaf : leavesOf(tree)) {
        if ((leaf.light & gpu::kLightEmitter) == 0) {
            continue;
        }
        const EmitterBounds& emitter = emitters[leaf.light & ~gpu::kLightEmitter];
        for (const std::uint32_t above : leaf.ancestors) {
            const gpu::LightNode& node = tree.nodes[above];
            const double slack = 1e-5;
            EXPECT_LE(node.lower.x, emitter.lower[0] + slack);
            EXPECT_GE(node.upper.y, emitter.upper[1] - slack);
            EXPECT_GE(node.upper.z, emitter.upper[2] - slack);
            EXPECT_EQ(std::abs(node.reach), INFINITY);
            EXPECT_TRUE(!emitter.twoSided || node.reach < 0.0F);
            EXPECT_NEAR(node.cosEmission, 0.0, 1e-6);
            const double cosine = node.axis.x * emitter.normal[0] + node.axis.y * emitter.normal[1] +
                                  node.axis.z * emitter.normal[2];
            EXPECT_GE(cosine, node.cosAxes - slack);
        }
    }
}

TEST(LightTree, EmittersAreLeavesUnlessTheyAreDark) {
    const std::vector<gpu::LightRecord> lights(20, point(1.0F, 2.0F, 3.0F));
    std::vector<EmitterBounds> emitters = someEmitters(500, 7);
    EXPECT_EQ(buildLightTree(lights, emitters).treeNodes, 2U * (400 + 20) - 1);
    LightTree tree = buildLightTree(lights, emitters, true);
    EXPECT_EQ(tree.treeNodes, 2U * (500 + 20) - 1);
    // Points have a range of infinity and axes everywhere, so only subtrees of emitters are bounded.
    tree = buildLightTree({}, emitters, true);
    expectEmitterBounds(tree, emitters);
    const std::vector<EmitterBounds> moved = someEmitters(500, 8);
    refitLightTree(tree, {}, moved);
    expectEmitterBounds(tree, moved);
}

// Lights far from each other in the tree have ancestors in common.
TEST(LightTree, RefittingAFewGivesWhatRefittingAllGives) {
    std::vector<gpu::LightRecord> lights = mixedLights(300, 4);
    std::vector<EmitterBounds> emitters = someEmitters(500, 7);
    LightTree tree = buildLightTree(lights, emitters, true);
    refitLightTree(tree, lights, emitters);
    const std::vector<gpu::LightRecord> otherLights = mixedLights(300, 5);
    const std::vector<EmitterBounds> otherEmitters = someEmitters(500, 8);
    for (const std::uint32_t step : {7U, 150U, 299U}) {
        std::vector<std::pair<std::uint32_t, gpu::LightRecord>> movedLights;
        std::vector<std::pair<std::uint32_t, EmitterBounds>> movedEmitters;
        for (std::uint32_t i = 0; i < lights.size(); i += step) {
            const std::uint32_t type = lights[i].type;
            lights[i] = otherLights[i];
            lights[i].type = type;
            movedLights.emplace_back(i, lights[i]);
            emitters[i] = otherEmitters[i];
            movedEmitters.emplace_back(i, emitters[i]);
        }
        LightTree all = tree;
        std::vector<gpu::LightNode> nodes = tree.nodes;
        refitLightTree(all, lights, emitters);
        for (const std::uint32_t node : refitLightTree(tree, movedLights, movedEmitters)) {
            nodes[node] = tree.nodes[node];
        }
        const std::size_t bytes = nodes.size() * sizeof(gpu::LightNode);
        EXPECT_EQ(std::memcmp(tree.nodes.data(), all.nodes.data(), bytes), 0) << step;
        EXPECT_EQ(std::memcmp(nodes.data(), all.nodes.data(), bytes), 0) << "it names all that differ";
    }
}

TEST(LightTree, AFewLightsAreApartFromEmitters) {
    const std::vector<EmitterBounds> emitters = someEmitters(4, 9);
    std::vector<gpu::LightRecord> lights(gpu::kMostLightsApart, point(1.0F, 2.0F, 3.0F));
    const LightTree few = buildLightTree(lights, emitters, true);
    EXPECT_EQ(few.apart, lights.size());
    EXPECT_EQ(few.treeNodes, 2U * 4 - 1);
    EXPECT_EQ(few.nodes.back().next, gpu::kLightLeaf | (gpu::kMostLightsApart - 1));
    EXPECT_EQ(buildLightTree(lights).apart, 0U) << "without emitters";
    lights.push_back(point(4.0F, 5.0F, 6.0F));
    const LightTree many = buildLightTree(lights, emitters, true);
    EXPECT_EQ(many.apart, 0U);
    EXPECT_EQ(many.treeNodes, 2U * (4 + lights.size()) - 1);
}

// Threads build large trees; the result is the same.
TEST(LightTree, BuildsOfManyLightsAreDeterministic) {
    const std::vector<gpu::LightRecord> lights = mixedLights(30000, 6);
    const LightTree first = buildLightTree(lights);
    const LightTree second = buildLightTree(lights);
    EXPECT_EQ(
        std::memcmp(first.nodes.data(), second.nodes.data(), first.nodes.size() * sizeof(gpu::LightNode)), 0);
}

}  // namespace
}  // namespace glint
