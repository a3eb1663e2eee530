// Tests the whole materials of the oracle: reading, reciprocity, energy, and light from maps.
#include "oracle/spec/sky.h"

#include "oracle/spec/directions.h"
#include "oracle/spec/rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace glint::spec;

const Rows& rows() {
    static const Rows kRows = allRows();
    return kRows;
}

Material materialOf(const std::string& name) {
    for (const Row& row : rows().rows) {
        if (row.name == name) {
            return readMaterial(row.material, rows().texels);
        }
    }
    ADD_FAILURE() << "no row " << name;
    return {};
}

Choices compensated() {
    Choices choices;
    choices.compensation = true;
    choices.sheenBounded = true;
    choices.sheenAtView = true;  // the smaller of two shares loses light
    return choices;
}

const Map& whiteMap() {
    static const Map kMap(64, 32, [](const Vec3&) { return Vec3(1.0); });
    return kMap;
}

Vec3 inFurnace(const Material& material, const Choices& choices, const Vec3& view, Albedos& albedos) {
    const Point point{glm::dmat3(1.0), view};
    return Surface(material, choices, albedos, point).underMap(whiteMap(), {48}).sum();
}

TEST(SpecMaterial, DefaultsAreThoseOfTheSpecification) {
    const Material m = readMaterial(Json::object(), {});
    EXPECT_EQ(m.baseColor, Vec3(1.0));
    EXPECT_EQ(m.metallic, 1.0);
    EXPECT_EQ(m.roughness, 1.0);
    EXPECT_EQ(m.ior, 1.5);
    EXPECT_EQ(m.iridescenceIor, 1.3);
    EXPECT_EQ(m.iridescenceThickness, 400.0);
    EXPECT_FALSE(m.volume);
}

TEST(SpecMaterial, TexturesHaveTheirChannelsAndColourSpaces) {
    // Texel (180, 120, 60, 210).
    const double srgb180 = std::pow((180.0 / 255.0 + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(materialOf("base colour").baseColor.x, srgb180, 1e-12);
    EXPECT_NEAR(materialOf("metallic and roughness").metallic, 60.0 / 255.0, 1e-12);
    EXPECT_NEAR(materialOf("metallic and roughness").roughness, 120.0 / 255.0, 1e-12);
    EXPECT_NEAR(materialOf("occlusion").occlusion, 1.0 + 0.6 * (180.0 / 255.0 - 1.0), 1e-12);
    EXPECT_NEAR(materialOf("specular").specular, 210.0 / 255.0, 1e-12);
    EXPECT_NEAR(materialOf("clearcoat").clearcoat, 180.0 / 255.0, 1e-12);
    EXPECT_NEAR(materialOf("clearcoat roughness").clearcoatRoughness, 120.0 / 255.0, 1e-12);
    EXPECT_NEAR(materialOf("sheen roughness").sheenRoughness, 210.0 / 255.0, 1e-12);
    EXPECT_NEAR(materialOf("sheen colour").sheenColor.x, srgb180, 1e-12);
    EXPECT_NEAR(materialOf("anisotropy").anisotropy, 60.0 / 255.0, 1e-12);
    EXPECT_NEAR(materialOf("iridescence thickness").iridescenceThickness, 200.0 + 500.0 * 120.0 / 255.0,
                1e-9);
    EXPECT_NEAR(materialOf("transmission").transmission, 180.0 / 255.0, 1e-12);
    EXPECT_NEAR(materialOf("thickness").thickness, 120.0 / 255.0, 1e-12);
    EXPECT_NEAR(materialOf("thickness").absorption.x, -std::log(0.5) / 0.5, 1e-12);
    EXPECT_NEAR(materialOf("diffuse transmission").diffuseTransmission, 210.0 / 255.0, 1e-12);
    EXPECT_NEAR(materialOf("specular-glossiness textures").roughness, 1.0 - 0.9 * 210.0 / 255.0, 1e-12);
}

// f(v, l) = f(l, v), where nothing is weighed at the view alone.
TEST(SpecBsdf, IsReciprocal) {
    const char* const kNames[] = {"gold, metallic 0.5, roughness 0.5",
                                  "olive dielectric, roughness 0.5",
                                  "olive dielectric, anisotropy 0.6, roughness 0.25",
                                  "specular, coloured",
                                  "iridescence of 550 nm, metallic 0.5",
                                  "white sheen of roughness 0.3"};
    Albedos albedos;
    for (const char* name : kNames) {
        const Material material = materialOf(name);
        for (const bool compensation : {false, true}) {
            if (compensation && material.iridescence > 0.0) {
                continue;  // the film's angle is then the view's
            }
            const Vec3 v = polarDirection(0.3, 0.2);
            const Vec3 l = polarDirection(0.8, 2.0);
            Choices choices = compensation ? compensated() : Choices{};
            choices.sheenAtView = false;
            const Bsdf from(material, choices, albedos, v);
            const Bsdf to(material, choices, albedos, l);
            const Vec3 there = (from.base(l) + from.coat(l)) / l.z;
            const Vec3 back = (to.base(v) + to.coat(v)) / v.z;
            for (int i = 0; i < 3; ++i) {
                EXPECT_NEAR(there[i], back[i], 1e-9 * there[i]) << name;
            }
        }
    }
}

// With compensation nothing is lost: metallic from 0 to 1, every roughness, anisotropy, sheen, diffuse
// transmission.
TEST(SpecBsdf, WhiteBasesKeepAllLight) {
    Albedos albedos;
    int compared = 0;
    for (const Row& row : rows().rows) {
        const Material m = readMaterial(row.material, rows().texels);
        const bool losesByDesign = m.transmission > 0.0 || m.clearcoat > 0.0;
        if (!row.white || losesByDesign || row.group == "normal map") {
            continue;
        }
        ++compared;
        for (const double cosine : {0.9, 0.2}) {
            const Vec3 light = inFurnace(m, compensated(), polarDirection(cosine, 0.5), albedos);
            for (int i = 0; i < 3; ++i) {
                EXPECT_NEAR(light[i], 1.0, 6e-3) << row.name << " at " << cosine;
            }
        }
    }
    EXPECT_GT(compared, 40);
}

// The plain formulas lose what single scattering loses.
TEST(SpecBsdf, PlainMetalLosesItsAlbedo) {
    Albedos albedos;
    const Material m = materialOf("white metal, roughness 1");
    const double cosine = 0.5;
    EXPECT_NEAR(inFurnace(m, {}, polarDirection(cosine, 0.5), albedos).x,
                1.0 - cosine * std::log1p(1.0 / cosine), 2e-3);
}

// A formula that mixes the F0 of metal and dielectric, and takes the diffuse light from the mixture, is told
// from mix(dielectric_brdf, metal_brdf, metallic).
TEST(SpecBsdf, MixesTwoBases) {
    Albedos albedos;
    const Material m = materialOf("white, metallic 0.5, roughness 0.5");
    const Vec3 view = polarDirection(0.9, 0.5);
    EXPECT_NEAR(inFurnace(m, compensated(), view, albedos).x, 1.0, 2e-3);
    // F0 0.52: half of the diffuse light is there, and it has less than half of that.
    Material mixed = m;
    mixed.metallic = 0.0;
    mixed.baseColor = Vec3(0.5);
    mixed.specularColor = Vec3(0.52 / 0.04);
    EXPECT_LT(inFurnace(mixed, compensated(), view, albedos).x, 0.8);
}

// A smooth surface of glass passes what Fresnel leaves, refracted by Snell's law.
TEST(SpecBsdf, SmoothGlassShowsWhatIsBehind) {
    Albedos albedos;
    const Map map(512, 256, [](const Vec3& d) { return Vec3(2.0 + d.x, 2.0 + d.y, 2.0 + d.z); });
    const Vec3 view = polarDirection(0.6, 1.0);
    const Point point{glm::dmat3(1.0), view};
    const double passed = 0.96 * (1.0 - std::pow(0.4, 5.0));
    const Terms thin = Surface(materialOf("thin glass, roughness 0"), {}, albedos, point).underMap(map, {64});
    EXPECT_NEAR(thin.transmitted.x, passed * (2.0 - view.x), 2e-3);
    const Terms thick = Surface(materialOf("volume, roughness 0"), {}, albedos, point).underMap(map, {64});
    EXPECT_NEAR(thick.transmitted.x, passed * (2.0 - view.x / 1.5), 2e-3);
}

TEST(SpecMap, IsReadAsItWasMade) {
    const Map map(256, 128, [](const Vec3& d) { return Vec3(2.0) + d; });
    for (const Vec3 d :
         {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0.6, 0.0, -0.8), Vec3(0.36, 0.48, 0.8)}) {
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(map.at(d)[i], 2.0 + d[i], 1e-3) << i;
        }
    }
    // The mean of the texels around a pole is the pole's value.
    EXPECT_NEAR(map.at({0, 1, 0}).y, 3.0, 1e-3);
}

// For a radiance of 1 + z: irradiance over π is 1 + 2/3 n.z, and so is the mean of a lobe of roughness 1.
TEST(SpecMap, MeansOfASlope) {
    const Map map(256, 128, [](const Vec3& d) { return Vec3(1.0 + d.z); });
    const Harmonics harmonics(map);
    const Vec3 n = glm::normalize(Vec3(0.3, -0.5, 0.7));
    EXPECT_NEAR(harmonics.irradianceOverPi(n).x, 1.0 + 2.0 / 3.0 * n.z, 1e-3);
    EXPECT_NEAR(cosineMean(map, n).x, 1.0 + 2.0 / 3.0 * n.z, 1e-3);
    EXPECT_NEAR(lobeMean(map, n, 1.0).x, 1.0 + 2.0 / 3.0 * n.z, 1e-3);
    EXPECT_NEAR(lobeMean(map, n, 0.0).x, 1.0 + n.z, 1e-3);
    EXPECT_NEAR(levelMean(map, n, 0.5, 3).x, lobeMean(map, n, 0.5).x, 1e-9);
}

// Twice as many points change a result by less than a thousandth.
TEST(SpecSky, QuadraturesHaveConverged) {
    Albedos albedos;
    const Map map(256, 128, [](const Vec3& d) {
        return Vec3(0.5 + 0.3 * d.x, 0.5 + 0.4 * d.y, 0.5) +
               Vec3(20.0) * std::exp(-40.0 * (1.0 - glm::dot(d, glm::normalize(Vec3(0.3, 0.2, 0.9)))));
    });
    for (const char* name : {"gold, metallic 0.5, roughness 0.2", "coloured sheen of roughness 0.6 on black",
                             "volume, roughness 0.2", "olive dielectric, anisotropy 0.6, roughness 0.25",
                             "clearcoat 0.5 on gold", "thin glass, tinted, half"}) {
        const Material m = materialOf(name);
        for (const double cosine : {0.9, 0.2}) {
            const Point point{glm::dmat3(1.0), polarDirection(cosine, 0.5)};
            const Surface surface(m, {}, albedos, point);
            const Vec3 coarse = surface.underMap(map, {64}).sum();
            const Vec3 fine = surface.underMap(map, {160}).sum();
            EXPECT_LT(largest(glm::abs(coarse - fine)), 1e-3 * largest(fine)) << name << " at " << cosine;
        }
    }
}

}  // namespace
