// The exhibits of the room. Heights are above the floor.
#include "builder.h"
#include "shapes.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <vector>

namespace gallery {

namespace {

// The knot on its dais in front of the gate.
void addCentrepiece(const Builder& builder) {
    const MaterialSet& materials = builder.materials;
    const std::array<glm::vec2, 8> dais{{{0.0F, 0.30F},
                                         {0.62F, 0.30F},
                                         {0.66F, 0.26F},
                                         {0.66F, 0.15F},
                                         {1.05F, 0.15F},
                                         {1.09F, 0.11F},
                                         {1.09F, 0.0F},
                                         {0.0F, 0.0F}}};
    builder.show("Dais", lathe(dais, false, 96, 1), kTextured, materials.tintedMarble, {{0.0F, 0.0F, -2.2F}});
    const std::array<glm::vec2, 6> column{
        {{0.0F, 1.05F}, {0.34F, 1.05F}, {0.34F, 0.97F}, {0.24F, 0.90F}, {0.28F, 0.0F}, {0.0F, 0.0F}}};
    MeshData shaft = lathe(column, false, 64, 1);
    scaleTexCoords(shaft, {6.0F, 1.0F});
    builder.show("Column", shaft, kBumped, materials.brushedSteel, {{0.0F, 0.30F, -2.2F}});
    builder.show("Torus knot", torusKnot(2, 3, 0.40F, 0.19F, 0.105F, 384, 32), kPlain, materials.gold,
                 {{0.0F, 1.98F, -2.2F}, turn(72.0F, kX) * turn(12.0F, kY)});
}

void addPlinths(const Builder& builder) {
    GltfWriter& writer = builder.writer;
    const int plinth =
        writer.addMesh("Plinth", {{writer.addGeometry(box({0.72F, 1.0F, 0.72F}), kTextured | kTexCoord1),
                                   builder.materials.marblePlinth}});
    struct Spot {
        glm::vec3 foot;
        float height;
    };
    const std::array<Spot, 5> spots{{{{-2.45F, 0.0F, 0.2F}, 0.85F},
                                     {{-2.4F, 0.0F, -2.5F}, 1.05F},
                                     {{2.05F, 0.0F, 0.35F}, 0.72F},
                                     {{3.15F, 0.0F, -2.5F}, 1.05F},
                                     {{-4.1F, 0.0F, -0.9F}, 0.45F}}};
    for (const Spot& spot : spots) {
        writer.addMeshNode("Plinth", plinth,
                           {spot.foot + glm::vec3(0.0F, 0.5F * spot.height, 0.0F),
                            {1.0F, 0.0F, 0.0F, 0.0F},
                            {1.0F, spot.height, 1.0F}});
    }
}

void addPlinthExhibits(const Builder& builder) {
    const MaterialSet& materials = builder.materials;
    const std::array<glm::vec2, 14> vase{{{0.135F, 0.80F},
                                          {0.165F, 0.82F},
                                          {0.175F, 0.80F},
                                          {0.11F, 0.72F},
                                          {0.10F, 0.64F},
                                          {0.17F, 0.56F},
                                          {0.26F, 0.45F},
                                          {0.29F, 0.34F},
                                          {0.27F, 0.22F},
                                          {0.20F, 0.11F},
                                          {0.14F, 0.04F},
                                          {0.16F, 0.01F},
                                          {0.15F, 0.0F},
                                          {0.0F, 0.0F}}};
    builder.show("Vase", lathe(vase, true, 96, 5), kTextured | kTexCoord1, materials.vase,
                 {{-2.45F, 0.85F, 0.2F}});
    builder.show("Mirror sphere", sphere(0.52F, 96, 48), kPlain, materials.mirror, {{-2.4F, 1.57F, -2.5F}});
    builder.show("Ruby", gem(0.36F, 8), 0, materials.ruby,
                 {{2.05F, 1.07F, 0.35F}, turn(14.0F, kZ) * turn(20.0F, kX)});
    builder.show("Ruby ring", torus(0.24F, 0.035F, 64, 16), kPlain, materials.gold, {{2.05F, 0.75F, 0.35F}});
    builder.show("Hammered torus", torus(0.36F, 0.16F, 96, 48), kBumped, materials.hammeredCopper,
                 {{3.15F, 1.55F, -2.5F}, turn(78.0F, kX)});
    MeshData agave = rosette(26, 0.95F);
    paintVertices(agave, [](const glm::vec3& position) {
        const float tip = glm::clamp(glm::length(position) / 0.95F, 0.0F, 1.0F);
        return glm::vec4(glm::mix(glm::vec3(0.24F, 0.42F, 0.20F), glm::vec3(0.10F, 0.26F, 0.16F), tip) +
                             glm::vec3(0.35F, 0.22F, 0.08F) * tip * tip * tip * tip,
                         1.0F);
    });
    builder.show("Agave", agave, kNormals | kColorsByte4, materials.agave, {{-4.1F, 0.92F, -0.9F}});
    const std::array<glm::vec2, 6> pot{
        {{0.24F, 0.40F}, {0.30F, 0.50F}, {0.33F, 0.47F}, {0.29F, 0.20F}, {0.20F, 0.0F}, {0.0F, 0.0F}}};
    builder.show("Pot", lathe(pot, false, 64, 1), kPlain, materials.redRubber, {{-4.1F, 0.45F, -0.9F}});
}

// A low bench across the front with a row of small things, so that their reflections appear beside them.
void addBench(const Builder& builder) {
    const MaterialSet& materials = builder.materials;
    GltfWriter& writer = builder.writer;
    builder.show("Bench", roundedBox({3.1F, 0.10F, 0.52F}, 0.03F, 3), kTextured, materials.benchWood,
                 {{0.0F, 0.40F, 0.9F}});
    const int leg = writer.addMesh(
        "Bench leg",
        {{writer.addGeometry(roundedBox({0.08F, 0.35F, 0.44F}, 0.02F, 2), kPlain), materials.stone}});
    writer.addMeshNode("Bench leg, left", leg, {{-1.3F, 0.175F, 0.9F}});
    writer.addMeshNode("Bench leg, right", leg, {{1.3F, 0.175F, 0.9F}});

    constexpr float kRadius = 0.19F;
    constexpr float kTop = 0.45F + kRadius;
    const MeshData ball = sphere(kRadius, 64, 32);
    const int plain = writer.addGeometry(ball, kPlain);
    const int textured = writer.addGeometry(ball, kTextured);
    writer.addMeshNode("Ball, copper", writer.addMesh("Ball, copper", {{plain, materials.copper}}),
                       {{-1.25F, kTop, 0.9F}});
    writer.addMeshNode("Globe", writer.addMesh("Globe", {{textured, materials.globe}}),
                       {{-0.72F, kTop, 0.9F}, turn(-15.0F, kZ) * turn(140.0F, kY)});
    const int red = writer.addMesh("Ball, red", {{plain, materials.redRubber}});
    // The same ball, flattened to a pebble.
    writer.addMeshNode("Ball, red", red, {{-0.20F, kTop, 0.9F}});
    writer.addMeshNode("Pebble", red, {{0.28F, 0.45F + 0.095F, 0.98F}, turn(30.0F, kY), {1.0F, 0.5F, 0.75F}});
    const std::array<glm::vec2, 11> bottle{{{0.0F, 0.62F},
                                            {0.035F, 0.62F},
                                            {0.045F, 0.60F},
                                            {0.038F, 0.57F},
                                            {0.04F, 0.44F},
                                            {0.06F, 0.38F},
                                            {0.13F, 0.30F},
                                            {0.145F, 0.22F},
                                            {0.14F, 0.06F},
                                            {0.12F, 0.0F},
                                            {0.0F, 0.0F}}};
    builder.show("Bottle", lathe(bottle, true, 64, 5), kPlain, materials.glass, {{0.74F, 0.45F, 0.86F}});
    builder.show("Emerald", gem(0.20F, 6), 0, materials.emerald, {{1.22F, 0.62F, 0.9F}, turn(8.0F, kY)});
}

// Blocks on the right, all made from one rounded box.
void addBlocks(const Builder& builder) {
    GltfWriter& writer = builder.writer;
    MeshData block = roundedBox({0.5F, 0.5F, 0.5F}, 0.06F, 5);
    const int plain = writer.addGeometry(block, kPlain);
    paintVertices(block, [](const glm::vec3&) { return glm::vec4(1.0F); });
    const int white = writer.addGeometry(block, kNormals | kColorsByte4);
    const int blueMesh = writer.addMesh("Block, blue", {{plain, builder.materials.bluePlastic}});
    const int whiteMesh = writer.addMesh("Block, white", {{white, builder.materials.whitePlastic}});
    writer.addMeshNode("Block, blue", blueMesh, {{3.05F, 0.25F, 1.75F}, turn(24.0F, kY)});
    writer.addMeshNode("Block, blue, upper", blueMesh,
                       {{3.33F, 0.68F, 1.45F}, turn(-35.0F, kY), {0.72F, 0.72F, 0.72F}});
    writer.addMeshNode("Block, white", whiteMesh, {{3.60F, 0.25F, 1.30F}, turn(-10.0F, kY)});
    // A left-handed knot, mirrored by the negative scale.
    const int knot = writer.addMesh(
        "Small knot", {{writer.addGeometry(torusKnot(2, 3, 0.16F, 0.075F, 0.042F, 192, 16), kPlain),
                        builder.materials.copper}});
    writer.addMeshNode("Small knot", knot, {{-2.35F, 0.12F, 2.3F}, turn(8.0F, kX)});
    writer.addMeshNode("Small knot, mirrored", knot,
                       {{-1.65F, 0.12F, 2.6F}, turn(8.0F, kX), {-1.0F, 1.0F, 1.0F}});
}

void addStairs(const Builder& builder) {
    MeshData stairs;
    constexpr int kSteps = 7;
    for (int step = 0; step < kSteps; ++step) {
        const float height = 0.2F * static_cast<float>(step + 1);
        const glm::vec3 centre(0.0F, 0.5F * height, -0.28F * static_cast<float>(step));
        append(stairs, box({0.9F, height, 0.28F}), glm::translate(glm::mat4(1.0F), centre));
    }
    paintVertices(stairs, [](const glm::vec3& position) {
        const float hue = glm::clamp(-position.z / 2.0F, 0.0F, 1.0F);
        return glm::vec4(glm::mix(glm::vec3(0.80F, 0.24F, 0.08F), glm::vec3(0.90F, 0.62F, 0.14F), hue), 1.0F);
    });
    builder.show("Stairs", stairs, kNormals | kColorsFloat3, builder.materials.paintedStairs,
                 {{4.35F, 0.0F, -1.3F}});
}

// A folding screen: one panel in three nodes, of which the middle one is mirrored.
void addScreen(const Builder& builder) {
    GltfWriter& writer = builder.writer;
    MeshData leaf = panel({0.62F, 1.9F});
    leaf.texCoords0 = leaf.texCoords1;
    scaleTexCoords(leaf, {0.667F, 2.0F / 1.0F * 0.7F});
    MeshData rails;
    for (const float side : {-1.0F, 1.0F}) {
        append(rails, box({0.04F, 2.0F, 0.04F}),
               glm::translate(glm::mat4(1.0F), glm::vec3(side * 0.31F, 0.0F, 0.0F)));
        append(rails, box({0.62F, 0.05F, 0.035F}),
               glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, side * 0.95F, 0.0F)));
    }
    const int mesh =
        writer.addMesh("Screen panel", {{writer.addGeometry(leaf, kTextured), builder.materials.screen},
                                        {writer.addGeometry(rails, kTextured), builder.materials.beamWood}});
    constexpr float kTurn = 34.0F;
    writer.addMeshNode("Screen, left", mesh, {{-4.42F, 1.0F, -3.18F}, turn(kTurn, kY)});
    writer.addMeshNode("Screen, middle", mesh,
                       {{-3.90F, 1.0F, -3.18F}, turn(-kTurn, kY), {-1.0F, 1.0F, 1.0F}});
    writer.addMeshNode("Screen, right", mesh, {{-3.38F, 1.0F, -3.18F}, turn(kTurn, kY)});
}

void addWallPieces(const Builder& builder) {
    const MaterialSet& materials = builder.materials;
    GltfWriter& writer = builder.writer;
    // Two pictures on the left wall, in one frame mesh.
    MeshData frame;
    for (const float side : {-1.0F, 1.0F}) {
        append(frame, roundedBox({1.62F, 0.11F, 0.09F}, 0.03F, 3),
               glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, side * 0.60F, 0.0F)));
        append(frame, roundedBox({0.11F, 1.11F, 0.09F}, 0.03F, 3),
               glm::translate(glm::mat4(1.0F), glm::vec3(side * 0.755F, 0.0F, 0.0F)));
    }
    const int picture = writer.addMesh(
        "Picture", {{writer.addGeometry(panel({1.5F, 1.2F}), kBumped | kTexCoord1), materials.painting},
                    {writer.addGeometry(frame, kBumped), materials.frame}});
    writer.addMeshNode("Picture, large", picture, {{-4.85F, 2.45F, -0.75F}, turn(90.0F, kY)});
    writer.addMeshNode("Picture, small", picture,
                       {{-4.85F, 2.65F, -2.6F}, turn(90.0F, kY), {0.8F, 0.8F, 1.0F}});

    MeshData sign = panel({1.44F, 0.72F});
    sign.texCoords0 = sign.texCoords1;
    builder.show("Sign", sign, kTextured, materials.sign, {{3.3F, 2.95F, kBackWallZ + 0.17F}});
    builder.show("Sign case", roundedBox({1.52F, 0.80F, 0.08F}, 0.03F, 3), kPlain, materials.stone,
                 {{3.3F, 2.95F, kBackWallZ + 0.125F}});

    const int ring = writer.addGeometry(torus(0.55F, 0.035F, 96, 16), kPlain);
    writer.addMeshNode("Neon ring, pink", writer.addMesh("Neon ring, pink", {{ring, materials.neonPink}}),
                       {{4.82F, 2.75F, -1.35F}, turn(90.0F, kZ)});
    writer.addMeshNode("Neon ring, cyan", writer.addMesh("Neon ring, cyan", {{ring, materials.neonCyan}}),
                       {{4.80F, 2.45F, -0.75F}, turn(90.0F, kZ), {0.7F, 1.0F, 0.7F}});
}

void addLamps(const Builder& builder) {
    const MaterialSet& materials = builder.materials;
    builder.show("Lantern", sphere(0.26F, 64, 32), kTextured, materials.lantern, {{-1.75F, 3.1F, -1.3F}});
    builder.show("Lantern core", sphere(0.09F, 32, 16), kPlain, materials.lanternCore,
                 {{-1.75F, 3.1F, -1.3F}});
    builder.show("Lantern rod", box({0.015F, 1.2F, 0.015F}), kPlain, materials.gold,
                 {{-1.75F, 3.95F, -1.3F}});
    // A paper lamp that stands on the floor: four panels and a cap.
    MeshData paper;
    for (int side = 0; side < 4; ++side) {
        const glm::mat4 spin =
            glm::rotate(glm::mat4(1.0F), glm::half_pi<float>() * static_cast<float>(side), kY);
        append(paper, panel({0.36F, 0.80F}), glm::translate(spin, glm::vec3(0.0F, 0.0F, 0.18F)));
    }
    paper.texCoords0 = paper.texCoords1;
    builder.show("Paper lamp", paper, kTextured, materials.lampPanel,
                 {{1.75F, 0.46F, -3.2F}, turn(20.0F, kY)});
    MeshData caps = box({0.42F, 0.05F, 0.42F});
    append(caps, box({0.42F, 0.05F, 0.42F}), glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, 0.85F, 0.0F)));
    builder.show("Paper lamp, caps", caps, kTextured, materials.marbleTable,
                 {{1.75F, 0.035F, -3.2F}, turn(20.0F, kY)});
}

}  // namespace

void addExhibits(GltfWriter& writer, const MaterialSet& materials) {
    const Builder builder{writer, materials};
    addCentrepiece(builder);
    addPlinths(builder);
    addPlinthExhibits(builder);
    addBench(builder);
    addBlocks(builder);
    addStairs(builder);
    addScreen(builder);
    addWallPieces(builder);
    addLamps(builder);
}

}  // namespace gallery
