#include "oracle/spec/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

namespace glint::spec {
namespace {

struct Color {
    const char* name;
    double r;
    double g;
    double b;
};
constexpr Color kWhite{"white", 1.0, 1.0, 1.0};
constexpr Color kGold{"gold", 1.0, 0.77, 0.34};
constexpr Color kRed{"red", 0.8, 0.1, 0.05};
constexpr Color kOlive{"olive", 0.45, 0.6, 0.2};

Json base(const Color& color, double metallic, double roughness) {
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {color.r, color.g, color.b, 1.0}},
              {"metallicFactor", metallic},
              {"roughnessFactor", roughness}}}};
}

Json extended(Json material, const char* extension, Json values) {
    material["extensions"][extension] = std::move(values);
    return material;
}

constexpr const char* kIor = "KHR_materials_ior";
constexpr const char* kSpecular = "KHR_materials_specular";
constexpr const char* kCoat = "KHR_materials_clearcoat";
constexpr const char* kSheen = "KHR_materials_sheen";
constexpr const char* kAnisotropy = "KHR_materials_anisotropy";
constexpr const char* kFilm = "KHR_materials_iridescence";
constexpr const char* kTransmission = "KHR_materials_transmission";
constexpr const char* kVolume = "KHR_materials_volume";
constexpr const char* kDispersion = "KHR_materials_dispersion";
constexpr const char* kDiffuse = "KHR_materials_diffuse_transmission";
constexpr const char* kGloss = "KHR_materials_pbrSpecularGlossiness";

// Adds a lobe to a material.
using Lobe = std::function<void(Json&)>;
Lobe lobe(const char* extension, Json values) {
    return [extension, values](Json& material) { material["extensions"][extension] = values; };
}

constexpr const char* kSpheres[] = {"white dielectric, roughness 0.25",
                                    "white metal, roughness 0.75",
                                    "white, metallic 0.5, roughness 0.5",
                                    "clearcoat of roughness 0.2 on white",
                                    "white sheen of roughness 0.3",
                                    "thin glass, roughness 0",
                                    "thin glass, roughness 0.2",
                                    "thin glass, metallic 0.5",
                                    "volume, roughness 0",
                                    "volume, roughness 0.2",
                                    "volume of ior 1.33",
                                    "diffuse transmission 0.3"};

class List {
public:
    void add(const char* group, std::string name, Json material, bool white = false, bool quick = false) {
        rows_.rows.push_back({group, std::move(name), std::move(material), white, quick, false});
    }
    // Returns the texture info of a new texture of one texel.
    Json texture(const Texel& texel) {
        rows_.texels.push_back(texel);
        return {{"index", rows_.texels.size() - 1}};
    }
    Rows take() {
        for (const char* name : kSpheres) {
            const auto found = std::find_if(rows_.rows.begin(), rows_.rows.end(),
                                            [&](const Row& row) { return row.name == name; });
            found->sphere = true;
        }
        return std::move(rows_);
    }

private:
    Rows rows_;
};

void addBases(List& list) {
    for (const double roughness : {0.0, 0.1, 0.25, 0.5, 0.75, 1.0}) {
        const std::string at = fmt::format("roughness {}", roughness);
        const bool quick = roughness == 0.25 || roughness == 0.75;
        list.add("base", "white dielectric, " + at, base(kWhite, 0, roughness), true, quick);
        list.add("base", "olive dielectric, " + at, base(kOlive, 0, roughness));
        list.add("base", "white metal, " + at, base(kWhite, 1, roughness), true, quick);
        list.add("base", "gold metal, " + at, base(kGold, 1, roughness));
    }
    for (const double metallic : {0.1, 0.25, 0.5, 0.75}) {
        for (const double roughness : {0.2, 0.5, 1.0}) {
            for (const Color& color : {kWhite, kGold, kRed}) {
                list.add("partial metal",
                         fmt::format("{}, metallic {}, roughness {}", color.name, metallic, roughness),
                         base(color, metallic, roughness), color.name == kWhite.name,
                         roughness == 0.5 && color.name != kGold.name);
            }
        }
    }
}

void addReflectingLobes(List& list) {
    for (const double ior : {0.0, 1.0, 1.2, 1.33, 2.4}) {
        list.add("lobe", fmt::format("ior {}", ior), extended(base(kWhite, 0, 0.4), kIor, {{"ior", ior}}),
                 true, ior == 2.4);
    }
    for (const double factor : {0.0, 0.5}) {
        list.add("lobe", fmt::format("specular {}", factor),
                 extended(base(kWhite, 0, 0.4), kSpecular, {{"specularFactor", factor}}), true,
                 factor == 0.5);
    }
    list.add("lobe", "specular, coloured",
             extended(base(kOlive, 0, 0.4), kSpecular,
                      {{"specularFactor", 0.8}, {"specularColorFactor", {4.0, 1.0, 0.2}}}),
             false, true);
    for (const double roughness : {0.0, 0.2, 0.6, 1.0}) {
        const Json coat{{"clearcoatFactor", 1.0}, {"clearcoatRoughnessFactor", roughness}};
        const std::string at = fmt::format("clearcoat of roughness {}", roughness);
        list.add("lobe", at + " on white", extended(base(kWhite, 0, 0.6), kCoat, coat), true,
                 roughness == 0.2);
        list.add("lobe", at + " on black metal", extended(base({"black", 0, 0, 0}, 1, 1), kCoat, coat));
    }
    list.add(
        "lobe", "clearcoat 0.5 on gold",
        extended(base(kGold, 1, 0.5), kCoat, {{"clearcoatFactor", 0.5}, {"clearcoatRoughnessFactor", 0.1}}),
        false, true);
    Json lamp = extended(base(kOlive, 0, 0.6), kCoat, {{"clearcoatFactor", 1.0}});
    lamp["emissiveFactor"] = {0.2, 0.5, 1.0};
    lamp["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 3.0}};
    list.add("lobe", "emission below a clearcoat", lamp);
    for (const double roughness : {0.1, 0.3, 0.6, 1.0}) {
        const std::string at = fmt::format("sheen of roughness {}", roughness);
        list.add("lobe", "white " + at,
                 extended(base(kWhite, 0, 0.7), kSheen,
                          {{"sheenColorFactor", {1.0, 1.0, 1.0}}, {"sheenRoughnessFactor", roughness}}),
                 true, roughness == 0.3);
        list.add("lobe", "coloured " + at + " on black",
                 extended(base({"black", 0, 0, 0}, 0, 0.7), kSheen,
                          {{"sheenColorFactor", {0.9, 0.5, 0.1}}, {"sheenRoughnessFactor", roughness}}),
                 false, roughness == 0.6);
    }
    for (const double strength : {0.3, 0.6, 0.75, 1.0}) {
        for (const double roughness : {0.25, 0.5}) {
            const Json values{{"anisotropyStrength", strength}, {"anisotropyRotation", 0.7}};
            const std::string at = fmt::format("anisotropy {}, roughness {}", strength, roughness);
            list.add("lobe", "white metal, " + at, extended(base(kWhite, 1, roughness), kAnisotropy, values),
                     true, strength == 0.6 && roughness == 0.25);
            list.add("lobe", "olive dielectric, " + at,
                     extended(base(kOlive, 0, roughness), kAnisotropy, values));
        }
    }
    for (const double thickness : {250.0, 550.0}) {
        const Json film{
            {"iridescenceFactor", 1.0}, {"iridescenceIor", 1.6}, {"iridescenceThicknessMaximum", thickness}};
        for (const double metallic : {0.0, 0.5, 1.0}) {
            list.add("lobe", fmt::format("iridescence of {} nm, metallic {}", thickness, metallic),
                     extended(base(kGold, metallic, 0.3), kFilm, film), false, thickness == 550.0);
        }
        list.add("lobe", fmt::format("iridescence of {} nm on white", thickness),
                 extended(base(kWhite, 0, 0.3), kFilm, film));
    }
    list.add("lobe", "iridescence 0.4",
             extended(base(kOlive, 0, 0.3), kFilm, {{"iridescenceFactor", 0.4}, {"iridescenceIor", 2.0}}));
}

void addTransmittingLobes(List& list) {
    for (const double roughness : {0.0, 0.2, 0.5, 1.0}) {
        const std::string at = fmt::format("roughness {}", roughness);
        const Json clear = extended(base(kWhite, 0, roughness), kTransmission, {{"transmissionFactor", 1.0}});
        list.add("lobe", "thin glass, " + at, clear, true, roughness == 0.2 || roughness == 1.0);
        list.add("lobe", "volume, " + at, extended(clear, kVolume, {{"thicknessFactor", 1.0}}), true,
                 roughness == 0.2);
    }
    list.add("lobe", "thin glass, tinted, half",
             extended(base(kOlive, 0, 0.3), kTransmission, {{"transmissionFactor", 0.5}}), false, true);
    for (const double metallic : {0.25, 0.5}) {
        list.add("partial metal", fmt::format("thin glass, metallic {}", metallic),
                 extended(base(kWhite, metallic, 0.1), kTransmission, {{"transmissionFactor", 1.0}}), true,
                 true);
    }
    Json water = extended(base(kWhite, 0, 0.1), kTransmission, {{"transmissionFactor", 1.0}});
    water["extensions"][kVolume] = {{"thicknessFactor", 1.0}};
    water["extensions"][kIor] = {{"ior", 1.33}};
    list.add("lobe", "volume of ior 1.33", water, true);
    water["extensions"][kIor] = {{"ior", 1.8}};
    water["extensions"][kDispersion] = {{"dispersion", 4.0}};
    list.add("lobe", "volume with dispersion", water, true);
    for (const double factor : {0.3, 1.0}) {
        list.add("lobe", fmt::format("diffuse transmission {}", factor),
                 extended(base(kWhite, 0, 0.4), kDiffuse, {{"diffuseTransmissionFactor", factor}}), true,
                 factor == 0.3);
    }
    list.add(
        "lobe", "diffuse transmission, coloured",
        extended(base(kOlive, 0.3, 0.4), kDiffuse,
                 {{"diffuseTransmissionFactor", 0.6}, {"diffuseTransmissionColorFactor", {0.9, 0.4, 0.1}}}));
    list.add("lobe", "specular-glossiness",
             {{"extensions",
               {{kGloss,
                 {{"diffuseFactor", {0.6, 0.3, 0.1, 1.0}},
                  {"specularFactor", {0.3, 0.2, 0.4}},
                  {"glossinessFactor", 0.6}}}}}},
             false, true);
}

// The lobes that are paired, each with what makes it plain to see.
std::vector<std::pair<std::string, Lobe>> pairedLobes() {
    return {
        {"ior", lobe(kIor, {{"ior", 1.9}})},
        {"specular", lobe(kSpecular, {{"specularFactor", 0.7}, {"specularColorFactor", {1.5, 1.0, 0.4}}})},
        {"clearcoat", lobe(kCoat, {{"clearcoatFactor", 0.8}, {"clearcoatRoughnessFactor", 0.2}})},
        {"sheen", lobe(kSheen, {{"sheenColorFactor", {0.7, 0.4, 0.2}}, {"sheenRoughnessFactor", 0.5}})},
        {"anisotropy", lobe(kAnisotropy, {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 0.4}})},
        {"iridescence", lobe(kFilm, {{"iridescenceFactor", 0.9}, {"iridescenceIor", 1.5}})},
        {"transmission", lobe(kTransmission, {{"transmissionFactor", 0.7}})},
        {"volume",
         [](Json& m) {
             m["extensions"][kTransmission] = {{"transmissionFactor", 0.7}};
             m["extensions"][kVolume] = {{"thicknessFactor", 1.0}};
         }},
        {"diffuse transmission", lobe(kDiffuse, {{"diffuseTransmissionFactor", 0.5},
                                                 {"diffuseTransmissionColorFactor", {0.3, 0.8, 0.6}}})},
        {"half metal", [](Json& m) { m["pbrMetallicRoughness"]["metallicFactor"] = 0.5; }},
        {"emission",
         [](Json& m) {
             m["emissiveFactor"] = {0.1, 0.2, 0.3};
         }},
    };
}

void addPairs(List& list) {
    const auto lobes = pairedLobes();
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        for (std::size_t j = i + 1; j < lobes.size(); ++j) {
            if (lobes[i].first == "transmission" && lobes[j].first == "volume") {
                continue;  // a volume has the transmission
            }
            Json material = base(kOlive, 0, 0.35);
            lobes[i].second(material);
            lobes[j].second(material);
            list.add("pair", lobes[i].first + " and " + lobes[j].first, material);
        }
    }
}

// Texels whose channels all differ, so that a wrong channel or colour space shows.
constexpr Texel kTexel{180, 120, 60, 210};

void addTextures(List& list) {
    const auto add = [&](const std::string& name, Json material) {
        list.add("texture", name, std::move(material));
    };
    Json m = base(kWhite, 1, 0.4);
    m["pbrMetallicRoughness"]["baseColorTexture"] = list.texture(kTexel);
    add("base colour", m);
    m = base(kOlive, 1, 1);
    m["pbrMetallicRoughness"]["metallicRoughnessTexture"] = list.texture(kTexel);
    add("metallic and roughness", m);
    m = base(kOlive, 0, 0.5);
    m["occlusionTexture"] = list.texture(kTexel);
    m["occlusionTexture"]["strength"] = 0.6;
    add("occlusion", m);
    m = base(kOlive, 0, 0.5);
    m["emissiveFactor"] = {1.0, 0.8, 0.6};
    m["emissiveTexture"] = list.texture(kTexel);
    add("emission", m);
    const auto slot = [&](const char* name, const char* extension, const char* field, Json values,
                          const Color& color = kOlive) {
        values[field] = list.texture(kTexel);
        Json material = extended(base(color, 0, 0.4), extension, std::move(values));
        if (extension == kVolume) {
            material["extensions"][kTransmission] = {{"transmissionFactor", 1.0}};
        }
        add(name, material);
    };
    slot("specular", kSpecular, "specularTexture", {{"specularFactor", 1.0}});
    slot("specular colour", kSpecular, "specularColorTexture", {{"specularColorFactor", {8.0, 8.0, 8.0}}});
    slot("clearcoat", kCoat, "clearcoatTexture",
         {{"clearcoatFactor", 1.0}, {"clearcoatRoughnessFactor", 0.3}});
    slot("clearcoat roughness", kCoat, "clearcoatRoughnessTexture",
         {{"clearcoatFactor", 1.0}, {"clearcoatRoughnessFactor", 1.0}});
    slot("sheen colour", kSheen, "sheenColorTexture",
         {{"sheenColorFactor", {1.0, 1.0, 1.0}}, {"sheenRoughnessFactor", 0.5}});
    slot("sheen roughness", kSheen, "sheenRoughnessTexture",
         {{"sheenColorFactor", {0.8, 0.8, 0.8}}, {"sheenRoughnessFactor", 1.0}});
    slot("anisotropy", kAnisotropy, "anisotropyTexture",
         {{"anisotropyStrength", 1.0}, {"anisotropyRotation", 0.3}});
    slot("iridescence", kFilm, "iridescenceTexture", {{"iridescenceFactor", 1.0}, {"iridescenceIor", 1.7}});
    slot("iridescence thickness", kFilm, "iridescenceThicknessTexture",
         {{"iridescenceFactor", 1.0},
          {"iridescenceThicknessMinimum", 200.0},
          {"iridescenceThicknessMaximum", 700.0}});
    slot("transmission", kTransmission, "transmissionTexture", {{"transmissionFactor", 1.0}});
    slot("thickness", kVolume, "thicknessTexture",
         {{"thicknessFactor", 1.0}, {"attenuationDistance", 0.5}, {"attenuationColor", {0.5, 0.7, 0.9}}},
         kWhite);
    slot("diffuse transmission", kDiffuse, "diffuseTransmissionTexture",
         {{"diffuseTransmissionFactor", 1.0}});
    slot("diffuse transmission colour", kDiffuse, "diffuseTransmissionColorTexture",
         {{"diffuseTransmissionFactor", 0.5}});
    Json gloss{{"glossinessFactor", 0.9}, {"specularFactor", {0.6, 0.7, 0.8}}};
    gloss["diffuseTexture"] = list.texture({200, 90, 150, 255});
    gloss["specularGlossinessTexture"] = list.texture(kTexel);
    add("specular-glossiness textures", {{"extensions", {{kGloss, gloss}}}});
}

void addNormalMaps(List& list) {
    // Tilts of about 20° and 45° towards the tangent.
    const Texel slight{171, 128, 247, 255};
    const Texel steep{218, 128, 218, 255};
    for (const auto& [texel, tilt] : {std::pair(slight, 20), std::pair(steep, 45)}) {
        for (const double roughness : {0.04, 0.06, 0.2, 0.31, 0.7}) {
            Json metal = base(kWhite, 1, roughness);
            metal["normalTexture"] = list.texture(texel);
            list.add("normal map", fmt::format("white metal, roughness {}, {}° off", roughness, tilt), metal,
                     true, tilt == 20 && roughness != 0.2);
        }
        Json plastic = base(kWhite, 0, 0.2);
        plastic["normalTexture"] = list.texture(texel);
        list.add("normal map", fmt::format("white dielectric, {}° off", tilt), plastic, true, tilt == 20);
        Json coated = extended(plastic, kCoat, {{"clearcoatFactor", 1.0}, {"clearcoatRoughnessFactor", 0.1}});
        list.add("normal map", fmt::format("dielectric {}° off below a flat clearcoat", tilt), coated, true,
                 tilt == 20);
        Json rippled = base(kWhite, 0, 0.6);
        rippled["extensions"][kCoat] = {{"clearcoatFactor", 1.0}, {"clearcoatRoughnessFactor", 0.1}};
        rippled["extensions"][kCoat]["clearcoatNormalTexture"] = list.texture(texel);
        list.add("normal map", fmt::format("clearcoat {}° off", tilt), rippled, true, tilt == 20);
        Json half = base(kWhite, 0, 0.2);
        half["normalTexture"] = list.texture(texel);
        half["normalTexture"]["scale"] = 0.5;
        list.add("normal map", fmt::format("white dielectric, {}° off, scale 0.5", tilt), half, true);
    }
}

}  // namespace

Rows allRows() {
    List list;
    addBases(list);
    addReflectingLobes(list);
    addTransmittingLobes(list);
    addPairs(list);
    addTextures(list);
    addNormalMaps(list);
    return list.take();
}

}  // namespace glint::spec
