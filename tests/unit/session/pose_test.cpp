#include <glint/session/scene_view.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace glint::session {
namespace {

constexpr gltf::Matrix4 kPoseIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
const double kHalf = std::numbers::sqrt2 / 2.0;

void expectNear(const gltf::Matrix4& actual, const gltf::Matrix4& expected) {
    for (std::size_t i = 0; i < actual.size(); ++i) {
        EXPECT_NEAR(actual[i], expected[i], 1e-12) << "element " << i;
    }
}

int addSampler(gltf::Animation& animation, std::size_t width, std::vector<float> times,
               std::vector<float> values) {
    animation.samplers.push_back({gltf::Interpolation::Linear, std::move(times), width, std::move(values)});
    return static_cast<int>(animation.samplers.size()) - 1;
}

// Returns a node at (1, 0, 0), and below it one at (0, 2, 0) with a mesh of two targets.
gltf::Scene twoNodes() {
    gltf::Scene scene;
    scene.nodes.resize(2);
    scene.nodes[0].rest.translation = {1, 0, 0};
    scene.nodes[1].parent = 0;
    scene.nodes[1].rest.translation = {0, 2, 0};
    scene.nodes[1].mesh = 0;
    scene.nodes[1].restWeights = {0.25, 0.5};
    scene.meshes.resize(1);
    applyPose(restPose(scene), scene);
    return scene;
}

TEST(Pose, RestIsWhereTheFilePlaces) {
    const gltf::Scene scene = twoNodes();
    expectNear(scene.nodes[1].world, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 0, 1});
    EXPECT_EQ(scene.nodes[1].weights, (std::vector<double>{0.25, 0.5}));
    // Tests no animation, and one that has no channel.
    gltf::Scene still = twoNodes();
    still.animations.resize(1);
    const std::array<std::size_t, 1> first{0};
    EXPECT_EQ(poseAt(still, {}, 3.0).worlds, restPose(still).worlds);
    EXPECT_EQ(poseAt(still, first, 3.0).worlds, restPose(still).worlds);
}

TEST(Pose, ChannelsMoveTheirNodesAndWhatIsBelow) {
    gltf::Scene scene = twoNodes();
    gltf::Animation& animation = scene.animations.emplace_back();
    const auto turn = addSampler(animation, 4, {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0});
    const auto grow = addSampler(animation, 3, {0, 1}, {1, 1, 1, 3, 1, 1});
    const auto shift = addSampler(animation, 3, {0, 1}, {1, 0, 0, 5, 0, 0});
    const auto morph = addSampler(animation, 2, {0, 1}, {0, 1, 1, 0});
    animation.channels = {{0, gltf::AnimationPath::Rotation, turn},
                          {0, gltf::AnimationPath::Scale, grow},
                          {0, gltf::AnimationPath::Translation, shift},
                          {1, gltf::AnimationPath::Weights, morph}};
    const std::array<std::size_t, 1> first{0};
    const session::Pose pose = poseAt(scene, first, 0.5);
    // The node is turned by 90 degrees about Z, twice as long in X, at (3, 0, 0). The child's (0, 2, 0) turns
    // to (-2, 0, 0).
    expectNear(pose.worlds[0], {0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1});
    expectNear(pose.worlds[1], {0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1});
    EXPECT_EQ(pose.weights[1], (std::vector<double>{0.5, 0.5}));
    applyPose(pose, scene);
    EXPECT_EQ(scene.nodes[1].world, pose.worlds[1]);
    // The rest pose is the original one.
    applyPose(restPose(scene), scene);
    expectNear(scene.nodes[1].world, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 0, 1});
    EXPECT_EQ(scene.nodes[1].weights, (std::vector<double>{0.25, 0.5}));
}

TEST(Pose, OfTwoAnimationsTheLaterOneHolds) {
    gltf::Scene scene = twoNodes();
    for (const float x : {7.0F, 9.0F}) {
        gltf::Animation& animation = scene.animations.emplace_back();
        const auto shift = addSampler(animation, 3, {0}, {x, 0, 0});
        animation.channels = {{0, gltf::AnimationPath::Translation, shift}};
    }
    const std::array<std::size_t, 2> both{0, 1};
    const std::array<std::size_t, 2> turned{1, 0};
    EXPECT_EQ(poseAt(scene, both, 0.0).worlds[0][12], 9.0);
    EXPECT_EQ(poseAt(scene, turned, 0.0).worlds[0][12], 7.0);
}

TEST(Pose, MatricesStayAsTheyAre) {
    gltf::Scene scene = twoNodes();
    scene.nodes[0].matrix = gltf::Matrix4{2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 1, 1};
    expectNear(restPose(scene).worlds[1], {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 4, 1, 1});
}

TEST(Pose, CamerasAndLightsFollowTheirNodes) {
    gltf::Scene scene = twoNodes();
    scene.cameras.resize(1);
    scene.lights.resize(2);
    scene.lights[1].type = gltf::LightType::Spot;
    scene.nodes[1].camera = 0;
    scene.nodes[1].light = 1;
    // A quarter turn about Y at twice the size: -Z becomes -X.
    scene.nodes[0].rest.rotation = {0, kHalf, 0, kHalf};
    scene.nodes[0].rest.scale = {2, 2, 2};
    applyPose(restPose(scene), scene);
    expectNear(scene.cameras[0].world, {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 4, 0, 1});
    EXPECT_EQ(scene.lights[1].position, (std::array<double, 3>{1, 4, 0}));
    EXPECT_NEAR(scene.lights[1].direction[0], -1.0F, 1e-6F);
    EXPECT_EQ(scene.lights[0].position, (std::array<double, 3>{}));
    // Even if scaled to nothing, they keep their direction.
    scene.nodes[0].rest.scale = {0, 0, 0};
    scene.nodes[0].rest.translation = {3, 0, 0};
    applyPose(restPose(scene), scene);
    expectNear(scene.cameras[0].world, {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 3, 0, 0, 1});
    EXPECT_NEAR(scene.lights[1].direction[0], -1.0F, 1e-6F);
    EXPECT_EQ(scene.lights[1].position, (std::array<double, 3>{3, 0, 0}));
}

TEST(Pose, JointsTakeTheMeshFromItsBindPose) {
    gltf::Scene scene = twoNodes();
    gltf::Skin skin;
    skin.joints = {1, 0};
    // The first joint was at (0, 1, 0) when the mesh was bound to it.
    skin.inverseBinds = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1}, kPoseIdentity};
    const std::vector<gltf::Matrix4> joints = jointMatrices(scene, skin);
    ASSERT_EQ(joints.size(), 2U);
    expectNear(joints[0], {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 1, 0, 1});
    expectNear(joints[1], {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1});
}

}  // namespace
}  // namespace glint::session
