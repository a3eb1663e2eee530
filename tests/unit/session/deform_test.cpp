#include "scene/deformed.h"

#include <glint/session/scene_view.h>

#include <gtest/gtest.h>

namespace glint::session {
namespace {

constexpr gltf::Matrix4 kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
using Double3 = std::array<double, 3>;

gltf::Primitive twoVertices() {
    gltf::Primitive primitive;
    primitive.positions = {{1, 0, 0}, {0, 1, 0}};
    primitive.indices = {0, 1, 0};
    return primitive;
}

TEST(Deform, TargetsAddUp) {
    gltf::Primitive primitive = twoVertices();
    primitive.targets.resize(3);
    primitive.targets[0].positions = {{0, 0, 1}, {0, 0, 2}};
    primitive.targets[2].positions = {{4, 0, 0}, {0, 0, 0}};
    const std::vector<double> weights{0.5, 1.0, 0.25};
    EXPECT_EQ(deformedPositions(primitive, weights, {}), (std::vector<Double3>{{2, 0, 0.5}, {0, 1, 1}}));
    // Missing weights are 0.
    EXPECT_EQ(deformedPositions(primitive, std::vector{1.0}, {}),
              (std::vector<Double3>{{1, 0, 1}, {0, 1, 2}}));
    EXPECT_EQ(deformedPositions(primitive, {}, {}), (std::vector<Double3>{{1, 0, 0}, {0, 1, 0}}));
}

TEST(Deform, VerticesFollowTheMeanOfTheirJoints) {
    gltf::Primitive primitive = twoVertices();
    primitive.targets.resize(1);
    primitive.targets[0].positions = {{1, 0, 0}, {0, 0, 0}};
    primitive.influences = {2, {0, 1, 1, 0}, {0.25F, 0.75F, 1.0F, 0.0F}};
    // The first joint does nothing; the second scales by three and moves by 4 in Z.
    const std::vector<gltf::Matrix4> joints{kIdentity, {3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 3, 0, 0, 0, 4, 1}};
    // The vertex is morphed before it is skinned: (2, 0, 0) becomes a quarter of itself plus three quarters
    // of (6, 0, 4).
    EXPECT_EQ(deformedPositions(primitive, std::vector{1.0}, joints),
              (std::vector<Double3>{{5, 0, 3}, {0, 3, 4}}));
    EXPECT_EQ(deformedPositions(primitive, {}, {}), (std::vector<Double3>{{1, 0, 0}, {0, 1, 0}}));
}

TEST(Deform, WhatDeformsIsFound) {
    gltf::Scene scene;
    gltf::Mesh& mesh = scene.meshes.emplace_back();
    mesh.primitives.push_back(twoVertices());
    scene.nodes.resize(2);
    scene.nodes[1].mesh = 0;
    EXPECT_FALSE(compiler::hasDeformedMesh(scene));
    mesh.primitives[0].influences = {1, {0, 0}, {1.0F, 1.0F}};
    EXPECT_FALSE(compiler::isDeformed(scene, scene.nodes[1])) << "a mesh without a skin";
    scene.nodes[1].skin = 0;
    EXPECT_TRUE(compiler::isDeformed(scene, scene.nodes[1]));
    EXPECT_FALSE(compiler::isDeformed(scene, scene.nodes[0]));
    scene.nodes[1].skin = -1;
    mesh.primitives[0].influences = {};
    mesh.primitives[0].targets.resize(1);
    EXPECT_TRUE(compiler::hasDeformedMesh(scene));
    scene.nodes[1].mesh = -1;
    EXPECT_FALSE(compiler::hasDeformedMesh(scene)) << "a mesh that no node draws";
}

}  // namespace
}  // namespace glint::session
