#include "gltf/material_extensions.h"

#include "gltf/extensions.h"
#include "gltf/object_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint::gltf {

namespace {

void readAnisotropy(const ObjectReader& reader, Material& material) {
    material.anisotropy.given = true;
    material.anisotropy.strength = reader.number("anisotropyStrength", 0.0, kUnit);
    // Only the sine and cosine of the angle are used, so it is reduced here in double precision.
    material.anisotropy.rotation =
        static_cast<float>(std::remainder(reader.number("anisotropyRotation", 0.0), 2.0 * std::numbers::pi));
}

void readClearcoat(const ObjectReader& reader, Material& material) {
    Clearcoat& clearcoat = material.clearcoat;
    clearcoat.given = true;
    clearcoat.factor = reader.number("clearcoatFactor", 0.0, kUnit);
    clearcoat.roughnessFactor = reader.number("clearcoatRoughnessFactor", 0.0, kUnit);
    if (const Json* normal = find(reader.json(), "clearcoatNormalTexture")) {
        const Json* scale = find(*normal, "scale");
        clearcoat.normalScale = scale == nullptr ? 1.0F : static_cast<float>(scale->get<double>());
    }
}

void readDiffuseTransmission(const ObjectReader& reader, Material& material) {
    DiffuseTransmission& transmission = material.diffuseTransmission;
    transmission.given = true;
    transmission.factor = reader.number("diffuseTransmissionFactor", 0.0, kUnit);
    reader.numbers("diffuseTransmissionColorFactor", transmission.colorFactor, kUnit);
}

void readDispersion(const ObjectReader& reader, Material& material) {
    material.dispersion.given = true;
    material.dispersion.dispersion = reader.number("dispersion", 0.0, kNotNegative);
}

void readEmissiveStrength(const ObjectReader& reader, Material& material) {
    material.hasEmissiveStrength = true;
    material.emissiveStrength = reader.number("emissiveStrength", 1.0, kNotNegative);
}

void readIor(const ObjectReader& reader, Material& material) {
    material.ior.given = true;
    const double ior = reader.number("ior", 1.5);
    // 0 stands for an infinite index, which reflects everything.
    const bool valid = ior == 0.0 || ior >= 1.0;
    material.ior.ior = valid ? static_cast<float>(ior) : 1.0F;
    if (!valid) {
        reader.warn("ior", fmt::format("is {}; 1 is used", ior), "use 0, or 1 or more");
    }
}

void readIridescence(const ObjectReader& reader, Material& material) {
    Iridescence& film = material.iridescence;
    film.given = true;
    film.factor = reader.number("iridescenceFactor", 0.0, kUnit);
    film.ior = reader.number("iridescenceIor", 1.3, {1.0, kNotNegative.high});
    film.thicknessMinimum = reader.number("iridescenceThicknessMinimum", 100.0, kNotNegative);
    film.thicknessMaximum = reader.number("iridescenceThicknessMaximum", 400.0, kNotNegative);
}

void readSheen(const ObjectReader& reader, Material& material) {
    material.sheen.given = true;
    reader.numbers("sheenColorFactor", material.sheen.colorFactor, kUnit);
    material.sheen.roughnessFactor = reader.number("sheenRoughnessFactor", 0.0, kUnit);
}

void readSpecular(const ObjectReader& reader, Material& material) {
    material.specular.given = true;
    material.specular.factor = reader.number("specularFactor", 1.0, kUnit);
    reader.numbers("specularColorFactor", material.specular.colorFactor, kNotNegative);
}

void readSpecularGlossiness(const ObjectReader& reader, Material& material) {
    material.specularGlossiness.given = true;
    // KHR_materials_unlit takes precedence, and uses the base colour of metallic-roughness.
    if (material.unlit) {
        return;
    }
    material.baseColorFactor = {1.0F, 1.0F, 1.0F, 1.0F};
    reader.numbers("diffuseFactor", material.baseColorFactor, kUnit);
    reader.numbers("specularFactor", material.specularGlossiness.specularFactor, kUnit);
    material.specularGlossiness.glossinessFactor = reader.number("glossinessFactor", 1.0, kUnit);
    // The values that the extension replaces are not read.
    material.metallicFactor = 0.0F;
    material.roughnessFactor = 1.0F;
}

void readTransmission(const ObjectReader& reader, Material& material) {
    material.transmission.given = true;
    material.transmission.factor = reader.number("transmissionFactor", 0.0, kUnit);
}

void readUnlit(const ObjectReader&, Material& material) {
    material.unlit = true;
}

void readVolume(const ObjectReader& reader, Material& material) {
    Volume& volume = material.volume;
    volume.given = true;
    volume.thicknessFactor = reader.number("thicknessFactor", 0.0, kNotNegative);
    reader.numbers("attenuationColor", volume.attenuationColor, kUnit);
    constexpr const char* kDistance = "attenuationDistance";
    if (find(reader.json(), kDistance) != nullptr) {
        // A distance that does not fit into a float is practically infinite. For a distance that is not above
        // 0, a micrometre is the nearest sensible value: it absorbs as much as any surface shows.
        constexpr double kLeast = 1e-6;
        const double distance = reader.number(kDistance, 0.0);
        if (distance <= 0.0) {
            reader.warn(kDistance, fmt::format("is {}; {} is used", distance, kLeast),
                        "use more than 0, or leave it out for an infinite distance");
        }
        volume.attenuationDistance = distance <= 0.0                 ? static_cast<float>(kLeast)
                                     : distance >= kNotNegative.high ? 0.0F
                                                                     : static_cast<float>(distance);
    }
}

// KHR_materials_unlit comes first, because others depend on it.
constexpr struct {
    const char* name;
    void (*read)(const ObjectReader& reader, Material& material);
} kExtensions[] = {
    {"KHR_materials_unlit", readUnlit},
    {"KHR_materials_anisotropy", readAnisotropy},
    {"KHR_materials_clearcoat", readClearcoat},
    {"KHR_materials_diffuse_transmission", readDiffuseTransmission},
    {"KHR_materials_dispersion", readDispersion},
    {"KHR_materials_emissive_strength", readEmissiveStrength},
    {"KHR_materials_ior", readIor},
    {"KHR_materials_iridescence", readIridescence},
    {"KHR_materials_pbrSpecularGlossiness", readSpecularGlossiness},
    {"KHR_materials_sheen", readSheen},
    {"KHR_materials_specular", readSpecular},
    {"KHR_materials_transmission", readTransmission},
    {"KHR_materials_volume", readVolume},
};

}  // namespace

void readMaterialExtensions(Document& document, const Json& json, const std::string& pointer,
                            Material& material) {
    const Json* extensions = find(json, "extensions");
    if (extensions == nullptr) {
        return;
    }
    for (const auto& extension : kExtensions) {
        if (const Json* object = find(*extensions, extension.name)) {
            extension.read({document, *object, fmt::format("{}/extensions/{}", pointer, extension.name)},
                           material);
        }
    }
    for (const auto& [name, ignored] : extensions->items()) {
        if (!isSupportedExtension(name) && !changesNoPicture(name)) {
            material.unsupportedExtensions.push_back(name);
        }
    }
}

}  // namespace glint::gltf
