// Tests keys of the lobes that extensions add: each neutral value beside a twin that is not neutral.
#include "unit/plan/full_material.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace {

using namespace glint;
using namespace glint::testing;

using Change = std::function<void(Material&, PrimitiveInputs&)>;

// `neutral` removes the feature from the key of fullMaterial() and fullPrimitive(); `twin`, which is similar,
// does not.
struct Pair {
    std::string feature;
    std::string what;
    Change neutral;
    Change twin;
};

FeatureMask keyAfter(const Change& change, Dropped& dropped) {
    Material material = fullMaterial();
    PrimitiveInputs primitive = fullPrimitive();
    change(material, primitive);
    return makeKey(material, primitive, kTested, &dropped);
}

FeatureMask bitOf(const std::string& name) {
    for (const FeatureInfo& info : featureTable()) {
        if (info.name == name) {
            return bit(info.feature);
        }
    }
    ADD_FAILURE() << name;
    return 0;
}

void clearTexture(Material& material, TextureSlot slot) {
    material.texture(slot) = {};
}

void makeMetal(Material& material) {
    material.metallicFactor = 1.0F;
    clearTexture(material, TextureSlot::MetallicRoughness);
}

// Makes the material fully metallic except for a texture.
void makeTexturedMetal(Material& material, PrimitiveInputs&) {
    material.metallicFactor = 1.0F;
}

Pair metal(const std::string& feature) {
    return {feature, "Metal", [](Material& m, PrimitiveInputs&) { makeMetal(m); }, makeTexturedMetal};
}

std::vector<Pair> lobes() {
    return {
        {"ior", "Default", [](Material& m, PrimitiveInputs&) { m.ior.ior = 1.5F; },
         [](Material& m, PrimitiveInputs&) { m.ior.ior = 0.0F; }},
        metal("ior"),
        {"specular", "Plain",
         [](Material& m, PrimitiveInputs&) {
             m.specular = {true, 1.0F, {1.0F, 1.0F, 1.0F}};
             clearTexture(m, TextureSlot::Specular);
             clearTexture(m, TextureSlot::SpecularColor);
         },
         [](Material& m, PrimitiveInputs&) {
             m.specular = {true, 1.0F, {1.0F, 1.0F, 1.0F}};
             clearTexture(m, TextureSlot::Specular);
         }},
        {"specularTexture", "Factor", [](Material& m, PrimitiveInputs&) { m.specular.factor = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.specular.factor = 1.0F; }},
        {"specularColorTexture", "Factor", [](Material& m, PrimitiveInputs&) { m.specular.factor = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.specular.factor = 1.0F; }},
        {"specularColorTexture", "Color",
         [](Material& m, PrimitiveInputs&) {
             m.specular.colorFactor = {0.0F, 0.0F, 0.0F};
         },
         [](Material& m, PrimitiveInputs&) {
             m.specular.colorFactor = {0.0F, 0.0F, 0.1F};
         }},
        metal("specular"),
        {"clearcoat", "Factor", [](Material& m, PrimitiveInputs&) { m.clearcoat.factor = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.clearcoat.factor = 0.01F; }},
        {"clearcoatTexture", "Lobe", [](Material& m, PrimitiveInputs&) { m.clearcoat.factor = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.clearcoat.roughnessFactor = 0.0F; }},
        {"clearcoatRoughnessTexture", "Factor",
         [](Material& m, PrimitiveInputs&) { m.clearcoat.roughnessFactor = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.clearcoat.roughnessFactor = 1.0F; }},
        {"clearcoatNormalTexture", "Scale",
         [](Material& m, PrimitiveInputs&) { m.clearcoat.normalScale = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.clearcoat.normalScale = -1.0F; }},
        {"sheen", "Black",
         [](Material& m, PrimitiveInputs&) {
             m.sheen.colorFactor = {0.0F, 0.0F, 0.0F};
         },
         [](Material& m, PrimitiveInputs&) {
             m.sheen.colorFactor = {0.0F, 0.0F, 0.1F};
         }},
        {"sheenColorTexture", "Lobe",
         [](Material& m, PrimitiveInputs&) {
             m.sheen.colorFactor = {0.0F, 0.0F, 0.0F};
         },
         [](Material& m, PrimitiveInputs&) { m.sheen.roughnessFactor = 0.0F; }},
        {"sheenRoughnessTexture", "Factor",
         [](Material& m, PrimitiveInputs&) { m.sheen.roughnessFactor = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.sheen.roughnessFactor = 0.1F; }},
        {"anisotropy", "Strength", [](Material& m, PrimitiveInputs&) { m.anisotropy.strength = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.anisotropy.rotation = 0.0F; }},
        {"anisotropy", "Rough",
         [](Material& m, PrimitiveInputs&) {
             m.roughnessFactor = 1.0F;
             clearTexture(m, TextureSlot::MetallicRoughness);
         },
         [](Material& m, PrimitiveInputs&) { m.roughnessFactor = 1.0F; }},
        {"anisotropy", "Direction",
         [](Material&, PrimitiveInputs& p) {
             p.hasTangents = false;
             p.hasTexCoords0 = false;
             p.hasTexCoords1 = false;
         },
         [](Material&, PrimitiveInputs& p) {
             p.hasTexCoords0 = false;
             p.hasTexCoords1 = false;
         }},
        {"anisotropyTexture", "Lobe", [](Material& m, PrimitiveInputs&) { m.anisotropy.strength = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.anisotropy.strength = 1.0F; }},
        {"iridescence", "Factor", [](Material& m, PrimitiveInputs&) { m.iridescence.factor = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.iridescence.factor = 0.1F; }},
        {"iridescence", "Air", [](Material& m, PrimitiveInputs&) { m.iridescence.ior = 1.0F; },
         [](Material& m, PrimitiveInputs&) { m.iridescence.ior = 1.1F; }},
        {"iridescence", "ThicknessWithTexture",
         [](Material& m, PrimitiveInputs&) {
             m.iridescence.thicknessMinimum = 0.0F;
             m.iridescence.thicknessMaximum = 0.0F;
         },
         [](Material& m, PrimitiveInputs&) { m.iridescence.thicknessMaximum = 0.0F; }},
        // Without its texture, the film has the largest thickness.
        {"iridescence", "ThicknessWithoutTexture",
         [](Material& m, PrimitiveInputs&) {
             m.iridescence.thicknessMaximum = 0.0F;
             clearTexture(m, TextureSlot::IridescenceThickness);
         },
         [](Material& m, PrimitiveInputs&) {
             m.iridescence.thicknessMinimum = 0.0F;
             clearTexture(m, TextureSlot::IridescenceThickness);
         }},
        {"iridescenceTexture", "Lobe", [](Material& m, PrimitiveInputs&) { m.iridescence.factor = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.iridescence.factor = 0.5F; }},
        {"iridescenceThicknessTexture", "Same",
         [](Material& m, PrimitiveInputs&) { m.iridescence.thicknessMinimum = 400.0F; },
         [](Material& m, PrimitiveInputs&) { m.iridescence.thicknessMinimum = 500.0F; }},
    };
}

std::vector<Pair> transmittingLobes() {
    const Change opaque = [](Material& m, PrimitiveInputs&) { m.transmission.factor = 0.0F; };
    return {
        {"transmission", "Factor", opaque,
         [](Material& m, PrimitiveInputs&) { m.transmission.factor = 1.0F; }},
        metal("transmission"),
        {"transmissionTexture", "Lobe", opaque,
         [](Material& m, PrimitiveInputs&) { m.diffuseTransmission.factor = 0.0F; }},
        {"diffuseTransmission", "Factor",
         [](Material& m, PrimitiveInputs&) { m.diffuseTransmission.factor = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.diffuseTransmission.factor = 1.0F; }},
        metal("diffuseTransmission"),
        {"diffuseTransmission", "NothingLeft",
         [](Material& m, PrimitiveInputs&) {
             m.transmission.factor = 1.0F;
             clearTexture(m, TextureSlot::Transmission);
         },
         [](Material& m, PrimitiveInputs&) { m.transmission.factor = 1.0F; }},
        {"diffuseTransmissionTexture", "Lobe",
         [](Material& m, PrimitiveInputs&) { m.diffuseTransmission.factor = 0.0F; },
         [](Material& m, PrimitiveInputs&) {
             m.diffuseTransmission.colorFactor = {0.0F, 0.0F, 0.0F};
         }},
        {"diffuseTransmissionColorTexture", "Black",
         [](Material& m, PrimitiveInputs&) {
             m.diffuseTransmission.colorFactor = {0.0F, 0.0F, 0.0F};
         },
         [](Material& m, PrimitiveInputs&) {
             m.diffuseTransmission.colorFactor = {0.1F, 0.0F, 0.0F};
         }},
        {"volume", "ThinWalled", [](Material& m, PrimitiveInputs&) { m.volume.thicknessFactor = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.volume.thicknessFactor = 1e-3F; }},
        {"volume", "Opaque",
         [](Material& m, PrimitiveInputs&) {
             m.transmission.factor = 0.0F;
             m.diffuseTransmission.factor = 0.0F;
         },
         opaque},
        metal("volume"),
        {"attenuation", "White",
         [](Material& m, PrimitiveInputs&) {
             m.volume.attenuationColor = {1.0F, 1.0F, 1.0F};
         },
         [](Material& m, PrimitiveInputs&) {
             m.volume.attenuationColor = {1.0F, 1.0F, 0.9F};
         }},
        {"attenuation", "Infinite",
         [](Material& m, PrimitiveInputs&) { m.volume.attenuationDistance = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.volume.attenuationDistance = 1e30F; }},
        {"attenuation", "NoVolume", [](Material& m, PrimitiveInputs&) { m.volume.thicknessFactor = 0.0F; },
         opaque},
        metal("attenuation"),
        {"thicknessTexture", "NothingAbsorbs",
         [](Material& m, PrimitiveInputs&) { m.volume.attenuationDistance = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.dispersion.dispersion = 0.0F; }},
        {"dispersion", "Zero", [](Material& m, PrimitiveInputs&) { m.dispersion.dispersion = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.dispersion.dispersion = 1e-3F; }},
        {"dispersion", "NothingRefracts", [](Material& m, PrimitiveInputs&) { m.ior.ior = 1.0F; },
         [](Material& m, PrimitiveInputs&) { m.ior.ior = 1.5F; }},
        {"dispersion", "NoVolume", [](Material& m, PrimitiveInputs&) { m.volume.thicknessFactor = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m.volume.attenuationDistance = 0.0F; }},
        {"dispersion", "NoTransmission", opaque,
         [](Material& m, PrimitiveInputs&) { m.diffuseTransmission.factor = 0.0F; }},
        metal("dispersion"),
    };
}

class LobeNeutral : public ::testing::TestWithParam<Pair> {};

TEST_P(LobeNeutral, LeavesTheKeyWithAReasonAndItsTwinStays) {
    const Pair& pair = GetParam();
    Dropped dropped;
    EXPECT_EQ(keyAfter(pair.neutral, dropped) & bitOf(pair.feature), 0U);
    EXPECT_FALSE(reasonFor(dropped, pair.feature).empty());
    Dropped twinDropped;
    EXPECT_NE(keyAfter(pair.twin, twinDropped) & bitOf(pair.feature), 0U);
    EXPECT_TRUE(reasonFor(twinDropped, pair.feature).empty());
}

std::string nameOf(const ::testing::TestParamInfo<Pair>& info) {
    return info.param.feature + info.param.what;
}

INSTANTIATE_TEST_SUITE_P(Surface, LobeNeutral, ::testing::ValuesIn(lobes()), nameOf);
INSTANTIATE_TEST_SUITE_P(Transmitting, LobeNeutral, ::testing::ValuesIn(transmittingLobes()), nameOf);

}  // namespace
