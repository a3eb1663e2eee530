// The materials of the glTF extensions that change what light does at the surface.
#include "scene.h"
#include "textures.h"

namespace gallery {

namespace {

void addCoatedMaterials(GltfWriter& writer, MaterialSet& set) {
    const int weave = writer.addTexture("carbon_normal", carbonNormal());
    // The coat is smooth over the weave. It has no normal texture of its own, so it has the mesh's normals.
    set.carbon =
        writer.addMaterial({.name = "Carbon fibre",
                            .baseColor = {0.14, 0.14, 0.15, 1.0},
                            .metallic = 1.0,
                            .roughness = 0.45,
                            .normalTexture = {weave, 0, TextureTransform{{0.0, 0.0}, 0.0, {2.0, 1.0}}},
                            .extensions = {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1.0}}}}});

    const int coat = writer.addTexture("lacquer_coat", lacquerCoat());
    const int peel = writer.addTexture("peel_normal", peelNormal());
    set.lacquer =
        writer.addMaterial({.name = "Worn lacquer",
                            .baseColor = {0.34, 0.015, 0.01, 1.0},
                            .metallic = 0.0,
                            .roughness = 0.75,
                            .extensions = {{"KHR_materials_clearcoat",
                                            {{"clearcoatFactor", 1.0}, {"clearcoatRoughnessFactor", 0.35}},
                                            {{"clearcoatTexture", {coat}},
                                             {"clearcoatRoughnessTexture", {coat}},
                                             {"clearcoatNormalTexture", {peel, 0, std::nullopt, 0.5}}}}}});

    const int velvet = writer.addTexture("velvet_sheen", velvetSheen());
    const auto addVelvet = [&](const char* name, const std::array<double, 4>& base,
                               const std::array<double, 3>& sheen) {
        return writer.addMaterial(
            {.name = name,
             .baseColor = base,
             .metallic = 0.0,
             .roughness = 0.9,
             .extensions = {{"KHR_materials_sheen",
                             {{"sheenColorFactor", sheen}, {"sheenRoughnessFactor", 0.45}},
                             {{"sheenColorTexture", {velvet}}, {"sheenRoughnessTexture", {velvet}}}}}});
    };
    set.velvetCrimson = addVelvet("Velvet, crimson", {0.16, 0.005, 0.015, 1.0}, {0.95, 0.30, 0.34});
    set.velvetPeacock = addVelvet("Velvet, peacock", {0.005, 0.05, 0.07, 1.0}, {0.20, 0.70, 0.75});
}

void addGlassMaterials(GltfWriter& writer, MaterialSet& set) {
    const int thickness = writer.addTexture("amber_thickness", amberThickness());
    set.amberGlass =
        writer.addMaterial({.name = "Amber glass",
                            .metallic = 0.0,
                            .roughness = 0.0,
                            .extensions = {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
                                           {"KHR_materials_volume",
                                            {{"thicknessFactor", 0.5},
                                             {"attenuationDistance", 0.25},
                                             {"attenuationColor", {0.95, 0.50, 0.12}}},
                                            {{"thicknessTexture", {thickness}}}}}});
    set.frostedGlass =
        writer.addMaterial({.name = "Frosted glass",
                            .metallic = 0.0,
                            .roughness = 0.45,
                            .extensions = {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
                                           {"KHR_materials_volume", {{"thicknessFactor", 0.5}}}}});
    const int roundel = writer.addTexture("roundel_color", roundelColor());
    const int panes = writer.addTexture("roundel_transmission", roundelTransmission());
    // Without a volume this is a thin sheet, which does not bend the view.
    set.stainedGlass = writer.addMaterial({.name = "Stained glass",
                                           .metallic = 0.0,
                                           .roughness = 0.05,
                                           .baseColorTexture = {roundel},
                                           .doubleSided = true,
                                           .extensions = {{"KHR_materials_transmission",
                                                           {{"transmissionFactor", 0.95}},
                                                           {{"transmissionTexture", {panes}}}}}});
    set.diamond = writer.addMaterial(
        {.name = "Diamond",
         .metallic = 0.0,
         .roughness = 0.0,
         .extensions = {{"KHR_materials_ior", {{"ior", 2.42}}},
                        {"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
                        {"KHR_materials_volume", {{"thicknessFactor", 0.3}}},
                        // This is 20 over the Abbe number (55 for diamond), times four to be visible.
                        {"KHR_materials_dispersion", {{"dispersion", 1.5}}}}});
}

void addReflectiveMaterials(GltfWriter& writer, MaterialSet& set) {
    const int film = writer.addTexture("oil_film", oilFilm());
    set.filmedSteel = writer.addMaterial(
        {.name = "Filmed steel",
         .baseColor = {0.35, 0.35, 0.37, 1.0},
         .roughness = 0.15,
         .extensions = {{"KHR_materials_iridescence",
                         {{"iridescenceFactor", 1.0},
                          {"iridescenceIor", 1.8},
                          {"iridescenceThicknessMinimum", 220.0},
                          {"iridescenceThicknessMaximum", 420.0}},
                         {{"iridescenceTexture", {film}}, {"iridescenceThicknessTexture", {film}}}}}});
    const int bands = writer.addTexture("porcelain_specular", porcelainSpecular());
    set.porcelain = writer.addMaterial(
        {.name = "Lustre porcelain",
         .baseColor = {0.10, 0.10, 0.12, 1.0},
         .metallic = 0.0,
         .roughness = 0.12,
         .extensions = {{"KHR_materials_specular",
                         {{"specularColorFactor", {6.0, 6.0, 6.0}}},
                         {{"specularTexture", {bands}}, {"specularColorTexture", {bands}}}}}});
    const int strokes = writer.addTexture("turned_anisotropy", turnedAnisotropy());
    // The grooves run along the tangent, which goes in circles, so the highlight stretches across them.
    set.turnedSteel = writer.addMaterial(
        {.name = "Turned steel",
         .baseColor = {0.75, 0.74, 0.72, 1.0},
         .roughness = 0.25,
         .extensions = {{"KHR_materials_anisotropy",
                         {{"anisotropyStrength", 0.8}, {"anisotropyRotation", kQuarterTurn}},
                         {{"anisotropyTexture", {strokes}}}}}});
    const int paper = writer.addTexture("paper_transmission", paperTransmission());
    set.paper = writer.addMaterial(
        {.name = "Paper shade",
         .baseColor = {0.85, 0.80, 0.70, 1.0},
         .metallic = 0.0,
         .roughness = 0.9,
         .doubleSided = true,
         .extensions = {
             {"KHR_materials_diffuse_transmission",
              {{"diffuseTransmissionFactor", 0.75}, {"diffuseTransmissionColorFactor", {0.50, 0.36, 0.20}}},
              {{"diffuseTransmissionTexture", {paper}}, {"diffuseTransmissionColorTexture", {paper}}}}}});
    const int glaze = writer.addTexture("celadon_color", celadonColor());
    const int gloss = writer.addTexture("celadon_specular_glossiness", celadonSpecularGlossiness());
    // This is the older of glTF's two base models.
    set.celadon = writer.addMaterial(
        {.name = "Celadon",
         .metallic = 0.0,
         .roughness = 0.1,
         .baseColorTexture = {glaze},
         .extensions = {{"KHR_materials_pbrSpecularGlossiness",
                         {},
                         {{"diffuseTexture", {glaze}}, {"specularGlossinessTexture", {gloss}}}}}});
}

}  // namespace

void addLayeredMaterials(GltfWriter& writer, MaterialSet& set) {
    addCoatedMaterials(writer, set);
    addGlassMaterials(writer, set);
    addReflectiveMaterials(writer, set);
}

}  // namespace gallery
