// Tests keys of the lobes that extensions add: each neutral value beside a twin that is not neutral.
#include "unit/plan/full_material.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
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
    for (const Feature& info : builtinMaterialModel().features) {
        if (info.name == name) {
            return info.mask();
        }
    }
    ADD_FAILURE() << name;
    return 0;
}

void clearTexture(Material& material, const char* slot) {
    material.texture(slot) = {};
}

void makeMetal(Material& material) {
    material["metallicFactor"] = 1.0F;
    clearTexture(material, "metallicRoughnessTexture");
}

// Makes the material fully metallic except for a texture.
void makeTexturedMetal(Material& material, PrimitiveInputs&) {
    material["metallicFactor"] = 1.0F;
}

Pair metal(const std::string& feature) {
    return {feature, "Metal", [](Material& m, PrimitiveInputs&) { makeMetal(m); }, makeTexturedMetal};
}

std::vector<Pair> lobes() {
    return {
        {"ior", "Default", [](Material& m, PrimitiveInputs&) { m["ior"] = 1.5F; },
         [](Material& m, PrimitiveInputs&) { m["ior"] = 0.0F; }},
        metal("ior"),
        {"specular", "Plain",
         [](Material& m, PrimitiveInputs&) {
             m.give("KHR_materials_specular");
             m["specularFactor"] = 1.0F;
             m["specularColorFactor"] = {1.0F, 1.0F, 1.0F};
             clearTexture(m, "specularTexture");
             clearTexture(m, "specularColorTexture");
         },
         [](Material& m, PrimitiveInputs&) {
             m.give("KHR_materials_specular");
             m["specularFactor"] = 1.0F;
             m["specularColorFactor"] = {1.0F, 1.0F, 1.0F};
             clearTexture(m, "specularTexture");
         }},
        {"specularTexture", "Factor", [](Material& m, PrimitiveInputs&) { m["specularFactor"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["specularFactor"] = 1.0F; }},
        {"specularColorTexture", "Factor", [](Material& m, PrimitiveInputs&) { m["specularFactor"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["specularFactor"] = 1.0F; }},
        {"specularColorTexture", "Color",
         [](Material& m, PrimitiveInputs&) {
             m["specularColorFactor"] = {0.0F, 0.0F, 0.0F};
         },
         [](Material& m, PrimitiveInputs&) {
             m["specularColorFactor"] = {0.0F, 0.0F, 0.1F};
         }},
        metal("specular"),
        {"clearcoat", "Factor", [](Material& m, PrimitiveInputs&) { m["clearcoatFactor"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["clearcoatFactor"] = 0.01F; }},
        {"clearcoatTexture", "Lobe", [](Material& m, PrimitiveInputs&) { m["clearcoatFactor"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["clearcoatRoughnessFactor"] = 0.0F; }},
        {"clearcoatRoughnessTexture", "Factor",
         [](Material& m, PrimitiveInputs&) { m["clearcoatRoughnessFactor"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["clearcoatRoughnessFactor"] = 1.0F; }},
        {"clearcoatNormalTexture", "Scale",
         [](Material& m, PrimitiveInputs&) { m["clearcoatNormalScale"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["clearcoatNormalScale"] = -1.0F; }},
        {"sheen", "Black",
         [](Material& m, PrimitiveInputs&) {
             m["sheenColorFactor"] = {0.0F, 0.0F, 0.0F};
         },
         [](Material& m, PrimitiveInputs&) {
             m["sheenColorFactor"] = {0.0F, 0.0F, 0.1F};
         }},
        {"sheenColorTexture", "Lobe",
         [](Material& m, PrimitiveInputs&) {
             m["sheenColorFactor"] = {0.0F, 0.0F, 0.0F};
         },
         [](Material& m, PrimitiveInputs&) { m["sheenRoughnessFactor"] = 0.0F; }},
        {"sheenRoughnessTexture", "Factor",
         [](Material& m, PrimitiveInputs&) { m["sheenRoughnessFactor"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["sheenRoughnessFactor"] = 0.1F; }},
        {"anisotropy", "Strength", [](Material& m, PrimitiveInputs&) { m["anisotropyStrength"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["anisotropyRotation"] = 0.0F; }},
        {"anisotropy", "Rough",
         [](Material& m, PrimitiveInputs&) {
             m["roughnessFactor"] = 1.0F;
             clearTexture(m, "metallicRoughnessTexture");
         },
         [](Material& m, PrimitiveInputs&) { m["roughnessFactor"] = 1.0F; }},
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
        {"anisotropyTexture", "Lobe", [](Material& m, PrimitiveInputs&) { m["anisotropyStrength"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["anisotropyStrength"] = 1.0F; }},
        {"iridescence", "Factor", [](Material& m, PrimitiveInputs&) { m["iridescenceFactor"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["iridescenceFactor"] = 0.1F; }},
        {"iridescence", "Air", [](Material& m, PrimitiveInputs&) { m["iridescenceIor"] = 1.0F; },
         [](Material& m, PrimitiveInputs&) { m["iridescenceIor"] = 1.1F; }},
        {"iridescence", "ThicknessWithTexture",
         [](Material& m, PrimitiveInputs&) {
             m["iridescenceThicknessMinimum"] = 0.0F;
             m["iridescenceThicknessMaximum"] = 0.0F;
         },
         [](Material& m, PrimitiveInputs&) { m["iridescenceThicknessMaximum"] = 0.0F; }},
        // Without its texture, the film has the largest thickness.
        {"iridescence", "ThicknessWithoutTexture",
         [](Material& m, PrimitiveInputs&) {
             m["iridescenceThicknessMaximum"] = 0.0F;
             clearTexture(m, "iridescenceThicknessTexture");
         },
         [](Material& m, PrimitiveInputs&) {
             m["iridescenceThicknessMinimum"] = 0.0F;
             clearTexture(m, "iridescenceThicknessTexture");
         }},
        {"iridescenceTexture", "Lobe", [](Material& m, PrimitiveInputs&) { m["iridescenceFactor"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["iridescenceFactor"] = 0.5F; }},
        {"iridescenceThicknessTexture", "Same",
         [](Material& m, PrimitiveInputs&) { m["iridescenceThicknessMinimum"] = 400.0F; },
         [](Material& m, PrimitiveInputs&) { m["iridescenceThicknessMinimum"] = 500.0F; }},
    };
}

std::vector<Pair> transmittingLobes() {
    const Change opaque = [](Material& m, PrimitiveInputs&) { m["transmissionFactor"] = 0.0F; };
    return {
        {"transmission", "Factor", opaque,
         [](Material& m, PrimitiveInputs&) { m["transmissionFactor"] = 1.0F; }},
        metal("transmission"),
        {"transmissionTexture", "Lobe", opaque,
         [](Material& m, PrimitiveInputs&) { m["diffuseTransmissionFactor"] = 0.0F; }},
        {"diffuseTransmission", "Factor",
         [](Material& m, PrimitiveInputs&) { m["diffuseTransmissionFactor"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["diffuseTransmissionFactor"] = 1.0F; }},
        metal("diffuseTransmission"),
        {"diffuseTransmission", "NothingLeft",
         [](Material& m, PrimitiveInputs&) {
             m["transmissionFactor"] = 1.0F;
             clearTexture(m, "transmissionTexture");
         },
         [](Material& m, PrimitiveInputs&) { m["transmissionFactor"] = 1.0F; }},
        {"diffuseTransmissionTexture", "Lobe",
         [](Material& m, PrimitiveInputs&) { m["diffuseTransmissionFactor"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) {
             m["diffuseTransmissionColorFactor"] = {0.0F, 0.0F, 0.0F};
         }},
        {"diffuseTransmissionColorTexture", "Black",
         [](Material& m, PrimitiveInputs&) {
             m["diffuseTransmissionColorFactor"] = {0.0F, 0.0F, 0.0F};
         },
         [](Material& m, PrimitiveInputs&) {
             m["diffuseTransmissionColorFactor"] = {0.1F, 0.0F, 0.0F};
         }},
        {"volume", "ThinWalled", [](Material& m, PrimitiveInputs&) { m["thicknessFactor"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["thicknessFactor"] = 1e-3F; }},
        {"volume", "Opaque",
         [](Material& m, PrimitiveInputs&) {
             m["transmissionFactor"] = 0.0F;
             m["diffuseTransmissionFactor"] = 0.0F;
         },
         opaque},
        metal("volume"),
        {"attenuation", "White",
         [](Material& m, PrimitiveInputs&) {
             m["attenuationColor"] = {1.0F, 1.0F, 1.0F};
         },
         [](Material& m, PrimitiveInputs&) {
             m["attenuationColor"] = {1.0F, 1.0F, 0.9F};
         }},
        {"attenuation", "Infinite",
         [](Material& m, PrimitiveInputs&) {
             m["attenuationDistance"] = std::numeric_limits<float>::infinity();
         },
         [](Material& m, PrimitiveInputs&) { m["attenuationDistance"] = 1e30F; }},
        {"attenuation", "NoVolume", [](Material& m, PrimitiveInputs&) { m["thicknessFactor"] = 0.0F; },
         opaque},
        metal("attenuation"),
        {"thicknessTexture", "NothingAbsorbs",
         [](Material& m, PrimitiveInputs&) {
             m["attenuationDistance"] = std::numeric_limits<float>::infinity();
         },
         [](Material& m, PrimitiveInputs&) { m["dispersion"] = 0.0F; }},
        {"dispersion", "Zero", [](Material& m, PrimitiveInputs&) { m["dispersion"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) { m["dispersion"] = 1e-3F; }},
        {"dispersion", "NothingRefracts", [](Material& m, PrimitiveInputs&) { m["ior"] = 1.0F; },
         [](Material& m, PrimitiveInputs&) { m["ior"] = 1.5F; }},
        {"dispersion", "NoVolume", [](Material& m, PrimitiveInputs&) { m["thicknessFactor"] = 0.0F; },
         [](Material& m, PrimitiveInputs&) {
             m["attenuationDistance"] = std::numeric_limits<float>::infinity();
         }},
        {"dispersion", "NoTransmission", opaque,
         [](Material& m, PrimitiveInputs&) { m["diffuseTransmissionFactor"] = 0.0F; }},
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
