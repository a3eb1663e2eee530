#include "view/camera_control.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using glint::CameraView;
using glint::session::parsePlacedCamera;
using glint::session::PlacedCamera;
using glint::view::CameraControl;

double distanceOf(const PlacedCamera& camera) {
    return std::hypot(camera.target[0] - camera.position[0], camera.target[1] - camera.position[1],
                      camera.target[2] - camera.position[2]);
}

CameraControl startAt(float x, float y, float z, double distance) {
    CameraView view;
    view.position = {x, y, z};
    CameraControl camera;
    camera.start(view, "Front", distance);
    return camera;
}

TEST(CameraControl, StaysAsItIsUntilItMoves) {
    CameraView view;
    view.position = {1, 2, 3};
    view.up = {0.6F, 0.8F, 0.0F};  // rolled
    CameraControl camera;
    camera.start(view, "Front", 2.0);
    EXPECT_FALSE(camera.moved());
    EXPECT_EQ(camera.name(), "Front");
    EXPECT_EQ(camera.view(2.0).up, view.up);
    EXPECT_FLOAT_EQ(camera.view(2.0).halfWidth, 2.0F * view.halfHeight);
}

TEST(CameraControl, OrbitKeepsTargetAndDistance) {
    CameraControl camera = startAt(0, 0, 5, 5.0);
    camera.orbit(0.5, 0.0);  // a quarter turn
    const PlacedCamera placed = camera.placed();
    EXPECT_NEAR(placed.position[0], -5.0, 1e-4);
    EXPECT_NEAR(placed.position[2], 0.0, 1e-4);
    for (const double coordinate : placed.target) {
        EXPECT_NEAR(coordinate, 0.0, 1e-4);
    }
    camera.orbit(0.0, 10.0);  // as far up as it goes, and not over the top
    EXPECT_NEAR(distanceOf(camera.placed()), 5.0, 1e-3);
    EXPECT_GT(camera.view(1.0).up[1], 0.0F);
}

// A place far from the world's origin has as many digits behind the point as one that is close.
TEST(CameraControl, IsAsExactFarAway) {
    CameraView view;
    view.position = {2e8 + 0.0625, 1, 0};
    view.forward = {0, 0, -1};
    CameraControl camera;
    camera.start(view, "Front", 4.0);
    camera.look(0.0, 0.0);
    EXPECT_NEAR(camera.placed().position[0], 2e8 + 0.0625, 1e-5);
    EXPECT_NEAR(distanceOf(camera.placed()), 4.0, 1e-4);
    const auto parsed = parsePlacedCamera(camera.name());
    ASSERT_TRUE(parsed.has_value());
    EXPECT_EQ(parsed->position, camera.placed().position);
    // And in a scene of micrometres.
    CameraControl small = startAt(1e-6F, 0, 3e-6F, 3e-6);
    small.look(0.0, 0.0);
    EXPECT_NEAR(small.placed().position[2], 3e-6, 1e-11);
    EXPECT_NEAR(distanceOf(small.placed()), 3e-6, 1e-11);
}

TEST(CameraControl, LookKeepsThePosition) {
    CameraControl camera = startAt(1, 2, 3, 4.0);
    camera.look(0.25, 0.1);
    EXPECT_NEAR(camera.placed().position[0], 1.0, 1e-5);
    EXPECT_NEAR(camera.placed().position[2], 3.0, 1e-5);
    EXPECT_NEAR(distanceOf(camera.placed()), 4.0, 1e-3);
}

TEST(CameraControl, PanMovesTheSceneWithTheMouse) {
    CameraControl camera = startAt(0, 0, 10, 10.0);
    camera.pan(0.5, 0.0);  // the scene goes right, so the camera goes left
    EXPECT_LT(camera.placed().position[0], 0.0);
    EXPECT_NEAR(camera.placed().target[0], camera.placed().position[0], 1e-4);
}

TEST(CameraControl, ApproachNeverReachesTheTarget) {
    CameraControl camera = startAt(0, 0, 8, 8.0);
    camera.approach(0.5);
    EXPECT_NEAR(camera.placed().position[2], 4.0, 1e-4);
    camera.approach(1.0);
    EXPECT_GT(camera.placed().position[2], 0.0);
    camera.approach(-1.0);
    EXPECT_GT(distanceOf(camera.placed()), 0.0);
}

TEST(CameraControl, FliesBySecondsAndSpeed) {
    CameraControl camera = startAt(0, 0, 0, 3.0);
    camera.fly(0.0, 0.0, 1.0, 0.5);
    EXPECT_NEAR(camera.placed().position[2], -1.5, 1e-4);
    camera.changeSpeed(2.0);
    camera.fly(1.0, 0.0, 0.0, 0.5);
    EXPECT_NEAR(camera.placed().position[0], 3.0, 1e-4);
}

TEST(CameraControl, ItsNameGivesTheSameView) {
    CameraControl camera = startAt(1.2345678F, 2, 3, 4.0);
    camera.orbit(0.123, 0.045);
    camera.approach(0.3);
    const auto placed = parsePlacedCamera(camera.name());
    ASSERT_TRUE(placed.has_value()) << camera.name();
    const CameraView expected = camera.view(1.5);
    const CameraView view = viewOf(*placed, 1.5);
    EXPECT_EQ(view.position, expected.position);
    EXPECT_EQ(view.forward, expected.forward);
    EXPECT_EQ(view.up, expected.up);
    EXPECT_EQ(view.halfHeight, expected.halfHeight);
    EXPECT_EQ(view.near, expected.near);
    EXPECT_LT(camera.name().size(), 80U) << camera.name();
}

TEST(PlacedCamera, RefusesWhatShowsNothing) {
    EXPECT_TRUE(parsePlacedCamera("1,2,3/0,0,0/30").has_value());
    EXPECT_TRUE(parsePlacedCamera("1,2,3/0,0,0").has_value());
    for (const char* const text :
         {"", "1,2,3", "1,2,3/0,0", "1,2,3/1,5,3/30", "1,2,3/0,0,0/0", "1,2,3/0,0,0/180", "1,2,3/0,0,nan/30",
          "1,2,3/0,0,0/30/", "a", "1 2 3/0,0,0"}) {
        EXPECT_FALSE(parsePlacedCamera(text).has_value()) << text;
    }
}

}  // namespace
