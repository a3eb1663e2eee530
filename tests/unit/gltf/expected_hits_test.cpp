// Tests areas in the world, and the hits that are expected from them.
#include "gltf/import.h"
#include "gltf/planning_inputs.h"

#include <gtest/gtest.h>

#include <limits>

namespace glint::test {
namespace {

// Returns a square in the plane z = 0, of side 1 or of another size.
gltf::Primitive square(float side = 1.0F) {
    gltf::Primitive primitive;
    primitive.positions = {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}};
    primitive.indices = {0, 1, 2, 0, 2, 3};
    return primitive;
}

gltf::Matrix4 scaled(double x, double y, double z) {
    return {x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 7, 8, 9, 1};
}

// Returns a stretch along X followed by a turn of 45 degrees about Z: columns of unequal lengths.
gltf::Matrix4 stretchedAndTurned(double x) {
    const double half = 0.7071067811865476;
    return {x * half, x * half, 0, 0, -half, half, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
}

struct Places {
    gltf::Scene scene;

    void add(const gltf::Primitive& primitive, const std::vector<gltf::Matrix4>& worlds) {
        scene.meshes.push_back({"", {primitive}});
        for (const gltf::Matrix4& world : worlds) {
            gltf::Node node;
            node.mesh = static_cast<int>(scene.meshes.size()) - 1;
            node.world = world;
            scene.nodes.push_back(node);
        }
    }
    std::vector<double> hits() const {
        std::vector<double> hits;
        for (const materials::PrimitiveInputs& inputs : planningInputs(scene)) {
            hits.push_back(inputs.expectedHits);
        }
        return hits;
    }
};

// With the median m, an area a is expected to get a / (a + 10 m).
double expected(double area, double median) {
    return area / (area + 10.0 * median);
}

TEST(ExpectedHits, GrowWithTheAreaUntilItFillsTheView) {
    Places places;
    places.add(square(), {scaled(1, 1, 1)});
    places.add(square(0.5F), {scaled(1, 1, 1)});
    places.add(square(1000.0F), {scaled(1, 1, 1)});
    const std::vector<double> hits = places.hits();
    EXPECT_DOUBLE_EQ(hits[0], expected(1.0, 1.0));
    EXPECT_DOUBLE_EQ(hits[1], expected(0.25, 1.0));
    EXPECT_DOUBLE_EQ(hits[2], expected(1e6, 1.0));
}

TEST(ExpectedHits, AddUpOverPlacesAndScales) {
    Places places;
    places.add(square(), {scaled(1, 1, 1), scaled(2, 2, 2)});
    places.add(square(), {scaled(3, 1, 1)});
    places.add(square(), {stretchedAndTurned(3)});
    places.add(square(), {});
    const std::vector<double> hits = places.hits();
    // The areas are 1, 4, 3 and 3.
    EXPECT_NEAR(hits[0], expected(1.0, 3.0) + expected(4.0, 3.0), 1e-12);
    EXPECT_NEAR(hits[1], expected(3.0, 3.0), 1e-12);
    EXPECT_NEAR(hits[2], expected(3.0, 3.0), 1e-12);
    EXPECT_EQ(hits[3], 0.0);
}

// A plane that is flattened along its normal keeps its area.
TEST(ExpectedHits, DoNotNeedAThirdDimension) {
    Places places;
    places.add(square(), {scaled(2, 2, 0)});
    places.add(square(), {scaled(0, 1, 1)});
    const std::vector<double> hits = places.hits();
    EXPECT_NEAR(hits[0], expected(4.0, 4.0), 1e-12);
    EXPECT_EQ(hits[1], 0.0);
}

TEST(ExpectedHits, AreFiniteWhateverTheNumbers) {
    constexpr double kHuge = std::numeric_limits<double>::max();
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    Places places;
    places.add(square(), {scaled(1, 1, 1)});
    places.add(square(std::numeric_limits<float>::max()), {scaled(kHuge, kHuge, kHuge), scaled(1, 1, 1)});
    places.add(square(), {scaled(kNan, 1, 1)});
    places.add(square(std::numeric_limits<float>::denorm_min()), {scaled(1e-300, 1e-300, 1)});
    for (const double hits : places.hits()) {
        EXPECT_TRUE(hits >= 0.0 && hits <= 2.0) << hits;
    }
    EXPECT_TRUE(Places().hits().empty());
}

}  // namespace
}  // namespace glint::test
