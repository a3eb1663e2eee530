// The exhibits of material extensions: a row on the floor in front of the bench, glass in front of the gate,
// a shield on the wall, a lampshade, and a pouf in two variants.
#include "builder.h"
#include "shapes.h"

#include <array>

namespace gallery {

namespace {

void addFloorRow(const Builder& builder) {
    const MaterialSet& materials = builder.materials;
    GltfWriter& writer = builder.writer;
    constexpr float kRadius = 0.22F;
    const MeshData ball = sphere(kRadius, 48, 24);
    builder.show("Carbon ball", ball, kBumped, materials.carbon, {{-1.00F, kRadius, 2.55F}});
    const int textured = writer.addGeometry(ball, kTextured);
    writer.addMeshNode("Film ball", writer.addMesh("Film ball", {{textured, materials.filmedSteel}}),
                       {{1.42F, kRadius, 2.60F}, turn(20.0F, kX) * turn(35.0F, kY)});
    writer.addMeshNode("Egg", writer.addMesh("Egg", {{textured, materials.porcelain}}),
                       {{1.98F, 1.25F * kRadius, 2.45F}, turn(30.0F, kY), {0.9F, 1.25F, 0.9F}});
    builder.show("Lacquer box", roundedBox({0.42F, 0.30F, 0.34F}, 0.05F, 4), kBumped, materials.lacquer,
                 {{-0.40F, 0.15F, 2.65F}, turn(24.0F, kY)});
    const std::array<glm::vec2, 9> bowl{{{0.0F, 0.09F},
                                         {0.14F, 0.13F},
                                         {0.22F, 0.24F},
                                         {0.245F, 0.25F},
                                         {0.25F, 0.235F},
                                         {0.17F, 0.09F},
                                         {0.10F, 0.03F},
                                         {0.11F, 0.0F},
                                         {0.0F, 0.0F}}};
    MeshData enamel = lathe(bowl, true, 48, 3);
    scaleTexCoords(enamel, {1.0F, 0.5F});
    builder.show("Enamel bowl", enamel, kBumped, materials.enamel, {{0.22F, 0.0F, 2.60F}});
    builder.show("Diamond", gem(0.25F, 8), 0, materials.diamond, {{0.84F, 0.24F, 2.70F}, turn(16.0F, kZ)});
    const std::array<glm::vec2, 10> jar{{{0.0F, 0.46F},
                                         {0.035F, 0.44F},
                                         {0.03F, 0.40F},
                                         {0.12F, 0.36F},
                                         {0.19F, 0.28F},
                                         {0.205F, 0.20F},
                                         {0.16F, 0.08F},
                                         {0.11F, 0.02F},
                                         {0.12F, 0.0F},
                                         {0.0F, 0.0F}}};
    builder.show("Celadon jar", lathe(jar, true, 48, 2), kTextured, materials.celadon,
                 {{2.55F, 0.0F, 2.75F}});
}

// The glass stands before the sky, which is seen through it.
void addGlass(const Builder& builder) {
    const MaterialSet& materials = builder.materials;
    GltfWriter& writer = builder.writer;
    const int pedestal = writer.addMesh(
        "Pedestal",
        {{writer.addGeometry(roundedBox({0.30F, 1.30F, 0.30F}, 0.02F, 2), kPlain), materials.stone}});
    constexpr float kRadius = 0.30F;
    const MeshData orb = sphere(kRadius, 48, 24);
    writer.addMeshNode("Pedestal, left", pedestal, {{-1.02F, 0.65F, -3.1F}});
    builder.show("Amber orb", orb, kTextured, materials.amberGlass, {{-1.02F, 1.30F + kRadius, -3.1F}});
    writer.addMeshNode("Pedestal, right", pedestal, {{0.92F, 0.65F, -3.1F}});
    builder.show("Frosted orb", orb, kPlain, materials.frostedGlass, {{0.92F, 1.30F + kRadius, -3.1F}});

    // A disc that faces +Y; its image is seen from there with -Z up.
    const std::array<glm::vec2, 2> rim{{{0.0F, 0.0F}, {0.36F, 0.0F}}};
    MeshData roundel = lathe(rim, false, 48, 2);
    for (std::size_t vertex = 0; vertex < roundel.positions.size(); ++vertex) {
        const glm::vec3& position = roundel.positions[vertex];
        roundel.texCoords0[vertex] = 0.5F + glm::vec2(position.x, position.z) / 0.72F;
    }
    builder.show("Roundel", roundel, kTextured, materials.stainedGlass,
                 {{-0.62F, 2.90F, kBackWallZ}, turn(90.0F, kX)});
    builder.show("Roundel frame", torus(0.37F, 0.03F, 48, 12), kPlain, materials.gold,
                 {{-0.62F, 2.90F, kBackWallZ}, turn(90.0F, kX)});
}

void addShield(const Builder& builder) {
    const std::array<glm::vec2, 6> shield{
        {{0.0F, 0.12F}, {0.14F, 0.11F}, {0.36F, 0.07F}, {0.58F, 0.0F}, {0.58F, -0.02F}, {0.0F, -0.02F}}};
    builder.show("Shield", lathe(shield, false, 96, 2), kBumped, builder.materials.turnedSteel,
                 {{-3.25F, 2.75F, kBackWallZ + 0.15F}, turn(90.0F, kX)});
}

// The shade is lit from within: light that the near side shows has passed the paper.
void addPaperShade(const Builder& builder) {
    const std::array<glm::vec2, 4> dome{{{0.05F, 0.24F}, {0.22F, 0.16F}, {0.33F, 0.0F}, {0.38F, -0.20F}}};
    builder.show("Paper shade", lathe(dome, true, 64, 4), kTextured, builder.materials.paper, {kPaperShade});
    builder.show("Paper shade, rod", box({0.015F, 1.55F, 0.015F}), kPlain, builder.materials.gold,
                 {kPaperShade + glm::vec3(0.0F, 1.0F, 0.0F)});
}

void addPouf(const Builder& builder) {
    GltfWriter& writer = builder.writer;
    const std::array<glm::vec2, 8> profile{{{0.0F, 0.36F},
                                            {0.20F, 0.385F},
                                            {0.38F, 0.36F},
                                            {0.46F, 0.27F},
                                            {0.47F, 0.17F},
                                            {0.42F, 0.06F},
                                            {0.34F, 0.0F},
                                            {0.0F, 0.0F}}};
    MeshData pouf = lathe(profile, true, 48, 3);
    scaleTexCoords(pouf, {2.0F, 1.0F});
    const int crimson = writer.addVariant("Crimson");
    const int peacock = writer.addVariant("Peacock");
    const int mesh = writer.addMesh(
        "Pouf", {{writer.addGeometry(pouf, kTextured),
                  builder.materials.velvetCrimson,
                  {{crimson, builder.materials.velvetCrimson}, {peacock, builder.materials.velvetPeacock}}}});
    writer.addMeshNode("Pouf", mesh, {{-2.55F, 0.0F, 1.45F}, turn(10.0F, kY)});
}

}  // namespace

void addShowcase(GltfWriter& writer, const MaterialSet& materials) {
    const Builder builder{writer, materials};
    addFloorRow(builder);
    addGlass(builder);
    addShield(builder);
    addPaperShade(builder);
    addPouf(builder);
}

}  // namespace gallery
