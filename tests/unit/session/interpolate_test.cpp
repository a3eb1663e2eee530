// Compares interpolation with values computed by hand from glTF 2.0, appendix C.
#include "session/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glint::session {
namespace {

constexpr double kPi = std::numbers::pi;

void expectNear(const std::vector<double>& actual, const std::vector<double>& expected) {
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < actual.size(); ++i) {
        EXPECT_NEAR(actual[i], expected[i], 1e-12) << "number " << i;
    }
}

void expectNear(const session::Quaternion& actual, const session::Quaternion& expected) {
    for (glm::length_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(actual[i], expected[i], 1e-12) << "component " << i;
    }
}

// Returns a turn about Z.
session::Quaternion turned(double angle) {
    return {std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle)};
}

std::vector<float> floats(std::initializer_list<session::Quaternion> quaternions) {
    std::vector<float> values;
    for (const session::Quaternion& quaternion : quaternions) {
        for (glm::length_t i = 0; i < 4; ++i) {
            values.push_back(static_cast<float>(quaternion[i]));
        }
    }
    return values;
}

gltf::AnimationSampler makeSampler(gltf::Interpolation interpolation, std::vector<float> times,
                                   std::size_t width, std::vector<float> values) {
    return {interpolation, std::move(times), width, std::move(values)};
}

TEST(Interpolation, StepHoldsUntilTheNextKeyframe) {
    const gltf::AnimationSampler sampler =
        makeSampler(gltf::Interpolation::Step, {1.0F, 2.0F, 4.0F}, 2, {1, 2, 3, 4, 5, 6});
    expectNear(sampleNumbers(sampler, 0.0), {1, 2});
    expectNear(sampleNumbers(sampler, 1.999), {1, 2});
    expectNear(sampleNumbers(sampler, 2.0), {3, 4});
    expectNear(sampleNumbers(sampler, 3.9), {3, 4});
    expectNear(sampleNumbers(sampler, 4.0), {5, 6});
    expectNear(sampleNumbers(sampler, 100.0), {5, 6});
}

TEST(Interpolation, LinearGoesStraight) {
    const gltf::AnimationSampler sampler =
        makeSampler(gltf::Interpolation::Linear, {1.0F, 2.0F, 4.0F}, 2, {0, 8, 4, 0, 0, 2});
    expectNear(sampleNumbers(sampler, -1.0), {0, 8});
    expectNear(sampleNumbers(sampler, 1.25), {1, 6});
    expectNear(sampleNumbers(sampler, 2.0), {4, 0});
    expectNear(sampleNumbers(sampler, 3.0), {2, 1});
    expectNear(sampleNumbers(sampler, 9.0), {0, 2});
}

// The spline goes over two seconds from 1 with slope 3 to 5 with slope -1. At the middle: 0.5 * 1 + 2 * 0.125
// * 3 + 0.5 * 5 - 2 * 0.125 * -1 = 4. At a quarter: 0.84375 * 1 + 2 * 0.140625 * 3 + 0.15625 * 5 - 2 *
// 0.046875 * -1 = 2.5625.
TEST(Interpolation, CubicSplineFollowsItsTangents) {
    const gltf::AnimationSampler sampler =
        makeSampler(gltf::Interpolation::CubicSpline, {1.0F, 3.0F}, 1, {99, 1, 3, -1, 5, 99});
    expectNear(sampleNumbers(sampler, 1.0), {1});
    expectNear(sampleNumbers(sampler, 1.5), {2.5625});
    expectNear(sampleNumbers(sampler, 2.0), {4});
    expectNear(sampleNumbers(sampler, 3.0), {5});
    expectNear(sampleNumbers(sampler, 7.0), {5});
}

TEST(Interpolation, OneKeyframeHoldsAlways) {
    for (const gltf::Interpolation kind : {gltf::Interpolation::Step, gltf::Interpolation::Linear}) {
        const gltf::AnimationSampler sampler = makeSampler(kind, {2.0F}, 1, {7});
        for (const double time : {0.0, 2.0, 3.0}) {
            expectNear(sampleNumbers(sampler, time), {7});
        }
    }
    expectNear(sampleNumbers(makeSampler(gltf::Interpolation::CubicSpline, {2.0F}, 1, {1, 7, 1}), 2.5), {7});
}

TEST(Interpolation, RotationsTurnEvenly) {
    const gltf::AnimationSampler sampler =
        makeSampler(gltf::Interpolation::Linear, {0.0F, 1.0F}, 4, {0, 0, 0, 1, 0, 0, 1, 0});
    // For half a turn, a third of the time is 60 degrees.
    expectNear(sampleRotation(sampler, 1.0 / 3.0), turned(kPi / 3.0));
    expectNear(sampleRotation(sampler, 0.5), turned(kPi / 2.0));
    expectNear(sampleRotation(sampler, 2.0), turned(kPi));
}

TEST(Interpolation, RotationsTakeTheShorterWay) {
    // The short way from 0 to 270 degrees is 90 degrees back.
    const session::Quaternion half = slerp(turned(0.0), turned(1.5 * kPi), 0.5);
    const session::Quaternion expected = turned(-0.25 * kPi);
    expectNear(half.w * expected.w < 0.0 ? -half : half, expected);
    // Tests equal quaternions, and opposite quaternions of one rotation.
    expectNear(slerp(turned(1.0), turned(1.0), 0.3), turned(1.0));
    const session::Quaternion q = turned(1.0);
    expectNear(slerp(q, -q, 0.7), q);
    // Some of these are so close that sines of the angle are lost in rounding, and some are just above that.
    for (const double angle : {1e-12, 1e-8, 1e-6, 1e-3}) {
        expectNear(slerp(turned(0.0), turned(angle), 0.25), turned(0.25 * angle));
    }
}

TEST(Interpolation, RotationsAreUnit) {
    // Stored quaternions are rounded, and those between the keyframes of a spline are not unit quaternions.
    const gltf::AnimationSampler step = makeSampler(gltf::Interpolation::Step, {0.0F}, 4, {0, 0, 2, 0});
    expectNear(sampleRotation(step, 0.0), {0, 0, 0, 1});
    const gltf::AnimationSampler none = makeSampler(gltf::Interpolation::Step, {0.0F}, 4, {0, 0, 0, 0});
    expectNear(sampleRotation(none, 0.0), {1, 0, 0, 0});
    const session::Quaternion zero(0.0, 0.0, 0.0, 0.0);
    const gltf::AnimationSampler spline =
        makeSampler(gltf::Interpolation::CubicSpline, {0.0F, 1.0F}, 4,
                    floats({zero, turned(0.0), zero, zero, turned(kPi), zero}));
    // Without tangents the middle is the mean, (0, 0, 0.5, 0.5), before it is normalised.
    expectNear(sampleRotation(spline, 0.5), turned(0.5 * kPi));
}

}  // namespace
}  // namespace glint::session
