// Tests keys of the lobes that extensions add: each neutral value beside a twin that is not neutral.
#include "unit/plan/full_material.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

namespace {

using namespace glint;
using namespace glint::testing;

using Change = std::function<void(materials::Material&, materials::PrimitiveInputs&)>;

// `neutral` removes the feature from the key of fullMaterial() and fullPrimitive(); `twin`, which is similar,
// does not.
struct Pair {
    std::string feature;
    std::string what;
    Change neutral;
    Change twin;
};

materials::FeatureMask keyAfter(const Change& change, Dropped& dropped) {
    materials::Material material = fullMaterial();
    materials::PrimitiveInputs primitive = fullPrimitive();
    change(material, primitive);
    return compiler::makeKey(material, primitive, kTested, &dropped);
}

materials::FeatureMask bitOf(const std::string& name) {
    for (const materials::Feature& info : materials::builtinMaterialModel().features) {
        if (info.name == name) {
            return info.mask();
        }
    }
    ADD_FAILURE() << name;
    return 0;
}

void clearTexture(materials::Material& material, const char* slot) {
    material.texture(slot) = {};
}

void makeMetal(materials::Material& material) {
    material["metallicFactor"] = 1.0F;
    clearTexture(material, "metallicRoughnessTexture");
}

// Makes the material fully metallic except for a texture.
void makeTexturedMetal(materials::Material& material, materials::PrimitiveInputs&) {
    material["metallicFactor"] = 1.0F;
}

Pair metal(const std::string& feature) {
    return {feature, "Metal", [](materials::Material& m, materials::PrimitiveInputs&) { makeMetal(m); },
            makeTexturedMetal};
}

std::vector<Pair> lobes() {
    return {
        {"ior", "Default", [](materials::Material& m, materials::PrimitiveInputs&) { m["ior"] = 1.5F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["ior"] = 0.0F; }},
        metal("ior"),
        {"specular", "Plain",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m.give("KHR_materials_specular");
             m["specularFactor"] = 1.0F;
             m["specularColorFactor"] = {1.0F, 1.0F, 1.0F};
             clearTexture(m, "specularTexture");
             clearTexture(m, "specularColorTexture");
         },
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m.give("KHR_materials_specular");
             m["specularFactor"] = 1.0F;
             m["specularColorFactor"] = {1.0F, 1.0F, 1.0F};
             clearTexture(m, "specularTexture");
         }},
        {"specularTexture", "Factor",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["specularFactor"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["specularFactor"] = 1.0F; }},
        {"specularColorTexture", "Factor",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["specularFactor"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["specularFactor"] = 1.0F; }},
        {"specularColorTexture", "Color",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["specularColorFactor"] = {0.0F, 0.0F, 0.0F};
         },
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["specularColorFactor"] = {0.0F, 0.0F, 0.1F};
         }},
        metal("specular"),
        {"clearcoat", "Factor",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["clearcoatFactor"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["clearcoatFactor"] = 0.01F; }},
        {"clearcoatTexture", "Lobe",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["clearcoatFactor"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["clearcoatRoughnessFactor"] = 0.0F; }},
        {"clearcoatRoughnessTexture", "Factor",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["clearcoatRoughnessFactor"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["clearcoatRoughnessFactor"] = 1.0F; }},
        {"clearcoatNormalTexture", "Scale",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["clearcoatNormalScale"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["clearcoatNormalScale"] = -1.0F; }},
        {"sheen", "Black",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["sheenColorFactor"] = {0.0F, 0.0F, 0.0F};
         },
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["sheenColorFactor"] = {0.0F, 0.0F, 0.1F};
         }},
        {"sheenColorTexture", "Lobe",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["sheenColorFactor"] = {0.0F, 0.0F, 0.0F};
         },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["sheenRoughnessFactor"] = 0.0F; }},
        {"sheenRoughnessTexture", "Factor",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["sheenRoughnessFactor"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["sheenRoughnessFactor"] = 0.1F; }},
        {"anisotropy", "Strength",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["anisotropyStrength"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["anisotropyRotation"] = 0.0F; }},
        {"anisotropy", "Rough",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["roughnessFactor"] = 1.0F;
             clearTexture(m, "metallicRoughnessTexture");
         },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["roughnessFactor"] = 1.0F; }},
        {"anisotropy", "Direction",
         [](materials::Material&, materials::PrimitiveInputs& p) {
             p.hasTangents = false;
             p.hasTexCoords0 = false;
             p.hasTexCoords1 = false;
         },
         [](materials::Material&, materials::PrimitiveInputs& p) {
             p.hasTexCoords0 = false;
             p.hasTexCoords1 = false;
         }},
        {"anisotropyTexture", "Lobe",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["anisotropyStrength"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["anisotropyStrength"] = 1.0F; }},
        {"iridescence", "Factor",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["iridescenceFactor"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["iridescenceFactor"] = 0.1F; }},
        {"iridescence", "Air",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["iridescenceIor"] = 1.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["iridescenceIor"] = 1.1F; }},
        {"iridescence", "ThicknessWithTexture",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["iridescenceThicknessMinimum"] = 0.0F;
             m["iridescenceThicknessMaximum"] = 0.0F;
         },
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["iridescenceThicknessMaximum"] = 0.0F;
         }},
        // Without its texture, the film has the largest thickness.
        {"iridescence", "ThicknessWithoutTexture",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["iridescenceThicknessMaximum"] = 0.0F;
             clearTexture(m, "iridescenceThicknessTexture");
         },
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["iridescenceThicknessMinimum"] = 0.0F;
             clearTexture(m, "iridescenceThicknessTexture");
         }},
        {"iridescenceTexture", "Lobe",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["iridescenceFactor"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["iridescenceFactor"] = 0.5F; }},
        {"iridescenceThicknessTexture", "Same",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["iridescenceThicknessMinimum"] = 400.0F;
         },
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["iridescenceThicknessMinimum"] = 500.0F;
         }},
    };
}

std::vector<Pair> transmittingLobes() {
    const Change opaque = [](materials::Material& m, materials::PrimitiveInputs&) {
        m["transmissionFactor"] = 0.0F;
    };
    return {
        {"transmission", "Factor", opaque,
         [](materials::Material& m, materials::PrimitiveInputs&) { m["transmissionFactor"] = 1.0F; }},
        metal("transmission"),
        {"transmissionTexture", "Lobe", opaque,
         [](materials::Material& m, materials::PrimitiveInputs&) { m["diffuseTransmissionFactor"] = 0.0F; }},
        {"diffuseTransmission", "Factor",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["diffuseTransmissionFactor"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["diffuseTransmissionFactor"] = 1.0F; }},
        metal("diffuseTransmission"),
        {"diffuseTransmission", "NothingLeft",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["transmissionFactor"] = 1.0F;
             clearTexture(m, "transmissionTexture");
         },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["transmissionFactor"] = 1.0F; }},
        {"diffuseTransmissionTexture", "Lobe",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["diffuseTransmissionFactor"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["diffuseTransmissionColorFactor"] = {0.0F, 0.0F, 0.0F};
         }},
        {"diffuseTransmissionColorTexture", "Black",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["diffuseTransmissionColorFactor"] = {0.0F, 0.0F, 0.0F};
         },
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["diffuseTransmissionColorFactor"] = {0.1F, 0.0F, 0.0F};
         }},
        {"volume", "ThinWalled",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["thicknessFactor"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["thicknessFactor"] = 1e-3F; }},
        {"volume", "Opaque",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["transmissionFactor"] = 0.0F;
             m["diffuseTransmissionFactor"] = 0.0F;
         },
         opaque},
        metal("volume"),
        {"attenuation", "White",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["attenuationColor"] = {1.0F, 1.0F, 1.0F};
         },
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["attenuationColor"] = {1.0F, 1.0F, 0.9F};
         }},
        {"attenuation", "Infinite",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["attenuationDistance"] = std::numeric_limits<float>::infinity();
         },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["attenuationDistance"] = 1e30F; }},
        {"attenuation", "NoVolume",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["thicknessFactor"] = 0.0F; }, opaque},
        metal("attenuation"),
        {"thicknessTexture", "NothingAbsorbs",
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["attenuationDistance"] = std::numeric_limits<float>::infinity();
         },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["dispersion"] = 0.0F; }},
        {"dispersion", "Zero",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["dispersion"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["dispersion"] = 1e-3F; }},
        {"dispersion", "NothingRefracts",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["ior"] = 1.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) { m["ior"] = 1.5F; }},
        {"dispersion", "NoVolume",
         [](materials::Material& m, materials::PrimitiveInputs&) { m["thicknessFactor"] = 0.0F; },
         [](materials::Material& m, materials::PrimitiveInputs&) {
             m["attenuationDistance"] = std::numeric_limits<float>::infinity();
         }},
        {"dispersion", "NoTransmission", opaque,
         [](materials::Material& m, materials::PrimitiveInputs&) { m["diffuseTransmissionFactor"] = 0.0F; }},
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
