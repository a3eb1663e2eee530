// The materials. Some differ in features, some only in values, and some have a feature at its neutral value.
#include "scene.h"
#include "textures.h"

namespace gallery {

namespace {

TextureTransform tiled(double u, double v) {
    return {{0.0, 0.0}, 0.0, {u, v}};
}

void addRoomMaterials(GltfWriter& writer, MaterialSet& set) {
    const int floorBase = writer.addTexture("floor_color", floorColor());
    const int floorMr = writer.addTexture("floor_metallic_roughness", floorMetallicRoughness());
    // The image holds 4 x 4 tiles of 0.8 m.
    const TextureTransform tiles{{0.0, 0.0}, 0.0, {0.3125, 0.3125}};
    set.floor = writer.addMaterial({.name = "Polished floor",
                                    .baseColorTexture = {floorBase, 0, tiles},
                                    .metallicRoughnessTexture = {floorMr, 0, tiles}});

    const int brickBase = writer.addTexture("brick_color", brickColor());
    const int brickOrm =
        writer.addTexture("brick_occlusion_roughness_metallic", brickOcclusionRoughnessMetallic());
    const int brickBump = writer.addTexture("brick_normal", brickNormal());
    set.brick = writer.addMaterial({.name = "Brick",
                                    .baseColorTexture = {brickBase},
                                    .metallicRoughnessTexture = {brickOrm},
                                    .normalTexture = {brickBump},
                                    .occlusionTexture = {brickOrm, 0, std::nullopt, 0.8}});

    const int plasterBase = writer.addTexture("plaster_color", plasterColor());
    const int plasterBump = writer.addTexture("plaster_normal", plasterNormal());
    set.plasterLeft = writer.addMaterial({.name = "Plaster, chalk",
                                          .baseColor = {0.62, 0.57, 0.49, 1.0},
                                          .metallic = 0.0,
                                          .roughness = 0.95,
                                          .baseColorTexture = {plasterBase, 0, tiled(0.5, 0.5)},
                                          .normalTexture = {plasterBump, 0, tiled(0.7, 0.7), 0.5}});
    // This has the same features as chalk; only the values differ.
    set.plasterRight = writer.addMaterial(
        {.name = "Plaster, petrol",
         .baseColor = {0.16, 0.32, 0.36, 1.0},
         .metallic = 0.0,
         .roughness = 0.9,
         .baseColorTexture = {plasterBase, 0, tiled(0.5, 0.5)},
         .normalTexture = {plasterBump, 0, TextureTransform{{0.3, 0.1}, 0.4, {0.7, 0.7}}, 0.4}});

    const int woodBase = writer.addTexture("wood_color", woodColor());
    const int woodMr = writer.addTexture("wood_metallic_roughness", woodMetallicRoughness());
    set.beamWood = writer.addMaterial({.name = "Wood, beams",
                                       .baseColorTexture = {woodBase, 0, tiled(0.4, 1.6)},
                                       .metallicRoughnessTexture = {woodMr, 0, tiled(0.4, 1.6)}});
    const TextureTransform across{{0.0, 1.0}, kQuarterTurn, {0.9, 0.6}};
    set.benchWood = writer.addMaterial({.name = "Wood, bench",
                                        .baseColor = {0.62, 0.50, 0.42, 1.0},
                                        .roughness = 0.7,
                                        .baseColorTexture = {woodBase, 0, across},
                                        .metallicRoughnessTexture = {woodMr, 0, across}});

    const int waterBump = writer.addTexture("water_normal", waterNormal());
    set.water = writer.addMaterial({.name = "Sea",
                                    .baseColor = {0.02, 0.07, 0.11, 1.0},
                                    .metallic = 0.0,
                                    .roughness = 0.12,
                                    .normalTexture = {waterBump, 0, tiled(0.12, 0.12), 0.6}});
    set.stone = writer.addMaterial(
        {.name = "Stone", .baseColor = {0.32, 0.30, 0.28, 1.0}, .metallic = 0.0, .roughness = 0.8});
}

void addPlainMaterials(GltfWriter& writer, MaterialSet& set) {
    set.gold = writer.addMaterial({.name = "Gold", .baseColor = {1.0, 0.72, 0.29, 1.0}, .roughness = 0.12});
    set.copper =
        writer.addMaterial({.name = "Copper", .baseColor = {0.95, 0.55, 0.40, 1.0}, .roughness = 0.2});
    set.mirror =
        writer.addMaterial({.name = "Mirror", .baseColor = {0.95, 0.95, 0.95, 1.0}, .roughness = 0.0});
    // An emissive strength of 1 changes nothing.
    set.redRubber = writer.addMaterial({.name = "Rubber, red",
                                        .baseColor = {0.60, 0.06, 0.04, 1.0},
                                        .metallic = 0.0,
                                        .roughness = 0.85,
                                        .emissiveStrength = 1.0});
    set.bluePlastic = writer.addMaterial(
        {.name = "Plastic, blue", .baseColor = {0.05, 0.16, 0.55, 1.0}, .metallic = 0.0, .roughness = 0.25});
    // The mesh has a COLOR_0 that is white everywhere, which changes nothing.
    set.whitePlastic = writer.addMaterial(
        {.name = "Plastic, white", .baseColor = {0.85, 0.85, 0.83, 1.0}, .metallic = 0.0, .roughness = 0.3});
    // This is shaded flat, because the geometry has no normals.
    set.ruby = writer.addMaterial(
        {.name = "Ruby", .baseColor = {0.75, 0.05, 0.12, 1.0}, .metallic = 0.35, .roughness = 0.05});
    set.emerald = writer.addMaterial(
        {.name = "Emerald", .baseColor = {0.06, 0.55, 0.28, 1.0}, .metallic = 0.35, .roughness = 0.08});
    set.paintedStairs = writer.addMaterial({.name = "Painted stairs", .metallic = 0.0, .roughness = 0.55});
    set.agave = writer.addMaterial({.name = "Agave", .metallic = 0.0, .roughness = 0.5, .doubleSided = true});
    set.glass = writer.addMaterial({.name = "Bottle glass",
                                    .baseColor = {0.10, 0.42, 0.30, 0.35},
                                    .metallic = 0.0,
                                    .roughness = 0.03,
                                    .alphaMode = "BLEND"});
    set.neonPink = writer.addMaterial({.name = "Neon, pink",
                                       .baseColor = {0.05, 0.05, 0.05, 1.0},
                                       .metallic = 0.0,
                                       .roughness = 0.4,
                                       .emissive = {1.0, 0.16, 0.42},
                                       .emissiveStrength = 2.2});
    set.neonCyan = writer.addMaterial({.name = "Neon, cyan",
                                       .baseColor = {0.05, 0.05, 0.05, 1.0},
                                       .metallic = 0.0,
                                       .roughness = 0.4,
                                       .emissive = {0.12, 0.75, 0.95},
                                       .emissiveStrength = 1.6});
    set.lanternCore = writer.addMaterial(
        {.name = "Lantern core", .baseColor = {1.0, 0.78, 0.45, 1.0}, .metallic = 0.0, .unlit = true});
}

void addStoneMaterials(GltfWriter& writer, MaterialSet& set) {
    const int marble = writer.addTexture("marble_color", marbleColor());
    const int occlusion = writer.addTexture("foot_occlusion", footOcclusion());
    // An identity transform changes nothing.
    set.marbleTable = writer.addMaterial({.name = "Marble, table",
                                          .metallic = 0.0,
                                          .roughness = 0.22,
                                          .baseColorTexture = {marble, 0, TextureTransform{}}});
    set.tintedMarble = writer.addMaterial({.name = "Marble, dark",
                                           .baseColor = {0.10, 0.11, 0.13, 1.0},
                                           .metallic = 0.0,
                                           .roughness = 0.15,
                                           .baseColorTexture = {marble}});
    set.marblePlinth = writer.addMaterial({.name = "Marble, plinth",
                                           .metallic = 0.0,
                                           .roughness = 0.35,
                                           .baseColorTexture = {marble},
                                           .occlusionTexture = {occlusion, 1}});

    const int vaseBase = writer.addTexture("vase_color", vaseColor());
    const int vaseMr = writer.addTexture("vase_metallic_roughness", vaseMetallicRoughness());
    const TextureTransform once{{0.5, 0.0}, 0.0, {1.0, 1.0}};
    set.vase = writer.addMaterial({.name = "Glazed vase",
                                   .baseColorTexture = {vaseBase, 0, once},
                                   .metallicRoughnessTexture = {vaseMr, 0, once},
                                   .occlusionTexture = {occlusion, 1, tiled(1.0, 0.9), 0.7}});
}

void addMetalMaterials(GltfWriter& writer, MaterialSet& set) {
    const int brushedMr = writer.addTexture("brushed_metallic_roughness", brushedMetallicRoughness());
    const int brushedBump = writer.addTexture("brushed_normal", brushedNormal());
    set.brushedSteel = writer.addMaterial({.name = "Brushed steel",
                                           .baseColor = {0.62, 0.63, 0.65, 1.0},
                                           .metallicRoughnessTexture = {brushedMr},
                                           .normalTexture = {brushedBump, 0, std::nullopt, 0.25}});
    const int hammered = writer.addTexture("hammered_normal", hammeredNormal());
    set.hammeredCopper = writer.addMaterial({.name = "Hammered copper",
                                             .baseColor = {0.90, 0.48, 0.34, 1.0},
                                             .roughness = 0.16,
                                             .normalTexture = {hammered}});
    // The coat follows the dents of the base: both use one texture, which is read once.
    set.enamel =
        writer.addMaterial({.name = "Enamel",
                            .baseColor = {0.02, 0.16, 0.20, 1.0},
                            .metallic = 0.0,
                            .roughness = 0.7,
                            .normalTexture = {hammered},
                            .extensions = {{"KHR_materials_clearcoat",
                                            {{"clearcoatFactor", 1.0}, {"clearcoatRoughnessFactor", 0.03}},
                                            {{"clearcoatNormalTexture", {hammered}}}}}});
    // A normal texture of scale 0 changes nothing.
    set.frame = writer.addMaterial({.name = "Gilt frame",
                                    .baseColor = {0.72, 0.50, 0.20, 1.0},
                                    .roughness = 0.35,
                                    .normalTexture = {hammered, 0, std::nullopt, 0.0}});
}

void addMotifMaterials(GltfWriter& writer, MaterialSet& set) {
    const int screen = writer.addTexture("screen_color", screenColor());
    set.screen = writer.addMaterial({.name = "Leaf screen",
                                     .metallic = 0.0,
                                     .roughness = 0.6,
                                     .baseColorTexture = {screen},
                                     .alphaMode = "MASK",
                                     .doubleSided = true});
    const int lanternBase = writer.addTexture("lantern_color", lanternColor());
    const int lanternGlow = writer.addTexture("lantern_emissive", lanternEmissive());
    set.lantern = writer.addMaterial({.name = "Pierced lantern",
                                      .roughness = 0.3,
                                      .emissive = {1.0, 1.0, 1.0},
                                      .baseColorTexture = {lanternBase},
                                      .emissiveTexture = {lanternGlow},
                                      .alphaMode = "MASK",
                                      .doubleSided = true});
    const int lamp = writer.addTexture("lamp_color", lampColor());
    set.lampPanel = writer.addMaterial(
        {.name = "Paper lamp", .metallic = 0.0, .baseColorTexture = {lamp}, .unlit = true});

    const int signBase = writer.addTexture("sign_color", signColor());
    const int signGlow = writer.addTexture("sign_emissive", signEmissive());
    set.sign = writer.addMaterial({.name = "Sign",
                                   .metallic = 0.0,
                                   .roughness = 0.4,
                                   .emissive = {1.0, 1.0, 1.0},
                                   .emissiveStrength = 1.5,
                                   .baseColorTexture = {signBase},
                                   .emissiveTexture = {signGlow}});

    const int painting = writer.addTexture("painting_color", paintingColor());
    const int canvas = writer.addTexture("canvas_normal", canvasNormal());
    set.painting = writer.addMaterial({.name = "Painting",
                                       .metallic = 0.0,
                                       .roughness = 0.7,
                                       .baseColorTexture = {painting, 1},
                                       .normalTexture = {canvas, 0, tiled(6.0, 6.0), 0.5}});

    const int globeBase = writer.addTexture("globe_color", globeColor());
    const int globeMr = writer.addTexture("globe_metallic_roughness", globeMetallicRoughness());
    const int globeTowns = writer.addTexture("globe_emissive", globeEmissive());
    set.globe = writer.addMaterial({.name = "Globe",
                                    .emissive = {1.0, 1.0, 1.0},
                                    .baseColorTexture = {globeBase},
                                    .metallicRoughnessTexture = {globeMr},
                                    .emissiveTexture = {globeTowns}});
}

}  // namespace

MaterialSet addMaterials(GltfWriter& writer) {
    MaterialSet set{};
    addRoomMaterials(writer, set);
    addPlainMaterials(writer, set);
    addStoneMaterials(writer, set);
    addMetalMaterials(writer, set);
    addMotifMaterials(writer, set);
    addLayeredMaterials(writer, set);
    return set;
}

}  // namespace gallery
