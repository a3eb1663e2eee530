#include "oracle/spec/material.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace glint::spec {
namespace {

// Texture values of one slot. Without a texture all components are 1 (glTF 2.0, section 3.9.2).
struct Sample {
    std::array<double, 4> linear{1.0, 1.0, 1.0, 1.0};
    std::array<double, 4> fromSrgb{1.0, 1.0, 1.0, 1.0};  // alpha is linear
    bool given = false;

    Vec3 color() const {
        return {fromSrgb[0], fromSrgb[1], fromSrgb[2]};
    }
};

// IEC 61966-2-1, the inverse of the transfer function of sRGB.
double decodeSrgb(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

class Reader {
public:
    Reader(const Json& object, const std::vector<Texel>& texels) : object_(object), texels_(texels) {}

    double number(const char* name, double otherwise) const {
        return object_.value(name, otherwise);
    }
    Vec3 color(const char* name, const Vec3& otherwise) const {
        if (!object_.contains(name)) {
            return otherwise;
        }
        const Json& value = object_[name];
        return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
    }
    Sample texture(const char* name) const {
        Sample sample;
        if (!object_.contains(name)) {
            return sample;
        }
        const Texel& texel = texels_.at(object_[name].at("index").get<std::size_t>());
        for (std::size_t i = 0; i < 4; ++i) {
            sample.linear[i] = texel[i] / 255.0;
            sample.fromSrgb[i] = i == 3 ? sample.linear[i] : decodeSrgb(sample.linear[i]);
        }
        sample.given = true;
        return sample;
    }
    // glTF 2.0, section 3.9.3: normalTextureInfo.scale.
    Vec3 normal(const char* name) const {
        const Sample sample = texture(name);
        if (!sample.given) {
            return {0.0, 0.0, 1.0};
        }
        const double scale = object_[name].value("scale", 1.0);
        return glm::normalize(Vec3(scale * (2.0 * sample.linear[0] - 1.0),
                                   scale * (2.0 * sample.linear[1] - 1.0), 2.0 * sample.linear[2] - 1.0));
    }
    Reader child(const char* name) const {
        static const Json kNothing = Json::object();
        return {object_.contains(name) ? object_[name] : kNothing, texels_};
    }
    bool has(const char* name) const {
        return object_.contains(name);
    }
    const Json& operator[](const char* name) const {
        return object_[name];
    }

private:
    const Json& object_;
    const std::vector<Texel>& texels_;
};

void readMetallicRoughness(const Reader& pbr, Material& m) {
    m.baseColor = pbr.color("baseColorFactor", Vec3(1.0)) * pbr.texture("baseColorTexture").color();
    const Sample texture = pbr.texture("metallicRoughnessTexture");
    m.metallic = pbr.number("metallicFactor", 1.0) * texture.linear[2];
    m.roughness = pbr.number("roughnessFactor", 1.0) * texture.linear[1];
}

void readSpecularGlossiness(const Reader& pbr, Material& m) {
    m.specularGlossiness = true;
    m.baseColor = pbr.color("diffuseFactor", Vec3(1.0)) * pbr.texture("diffuseTexture").color();
    const Sample texture = pbr.texture("specularGlossinessTexture");
    m.specularColor = pbr.color("specularFactor", Vec3(1.0)) * texture.color();
    m.roughness = 1.0 - pbr.number("glossinessFactor", 1.0) * texture.linear[3];
    m.metallic = 0.0;
}

void readTransmission(const Reader& extensions, Material& m) {
    const Reader transmission = extensions.child("KHR_materials_transmission");
    m.transmission = transmission.number("transmissionFactor", 0.0) *
                     transmission.texture("transmissionTexture").linear[0];
    const Reader diffuse = extensions.child("KHR_materials_diffuse_transmission");
    m.diffuseTransmission = diffuse.number("diffuseTransmissionFactor", 0.0) *
                            diffuse.texture("diffuseTransmissionTexture").linear[3];
    m.diffuseTransmissionColor = diffuse.color("diffuseTransmissionColorFactor", Vec3(1.0)) *
                                 diffuse.texture("diffuseTransmissionColorTexture").color();
    const Reader volume = extensions.child("KHR_materials_volume");
    const double factor = volume.number("thicknessFactor", 0.0);
    m.volume = factor > 0.0;
    m.thickness = factor * volume.texture("thicknessTexture").linear[1];
    if (volume.has("attenuationDistance")) {
        // "Attenuation": σ = -log(c) / d.
        m.absorption = -glm::log(volume.color("attenuationColor", Vec3(1.0))) /
                       volume.number("attenuationDistance", 1.0);
    }
    m.dispersion = extensions.child("KHR_materials_dispersion").number("dispersion", 0.0);
}

void readLayers(const Reader& extensions, Material& m) {
    const Reader coat = extensions.child("KHR_materials_clearcoat");
    m.clearcoat = coat.number("clearcoatFactor", 0.0) * coat.texture("clearcoatTexture").linear[0];
    m.clearcoatRoughness =
        coat.number("clearcoatRoughnessFactor", 0.0) * coat.texture("clearcoatRoughnessTexture").linear[1];
    m.clearcoatNormal = coat.normal("clearcoatNormalTexture");
    const Reader sheen = extensions.child("KHR_materials_sheen");
    m.sheenColor = sheen.color("sheenColorFactor", Vec3(0.0)) * sheen.texture("sheenColorTexture").color();
    m.sheenRoughness =
        sheen.number("sheenRoughnessFactor", 0.0) * sheen.texture("sheenRoughnessTexture").linear[3];
    const Reader film = extensions.child("KHR_materials_iridescence");
    m.iridescence = film.number("iridescenceFactor", 0.0) * film.texture("iridescenceTexture").linear[0];
    m.iridescenceIor = film.number("iridescenceIor", 1.3);
    const Sample thickness = film.texture("iridescenceThicknessTexture");
    m.iridescenceThickness = film.number("iridescenceThicknessMaximum", 400.0);
    if (thickness.given) {
        m.iridescenceThickness = std::lerp(film.number("iridescenceThicknessMinimum", 100.0),
                                           m.iridescenceThickness, thickness.linear[1]);
    }
}

void readAnisotropy(const Reader& extension, Material& m) {
    const Sample texture = extension.texture("anisotropyTexture");
    m.anisotropy = extension.number("anisotropyStrength", 0.0);
    Vec2 direction(1.0, 0.0);
    if (texture.given) {
        direction = glm::normalize(Vec2(2.0 * texture.linear[0] - 1.0, 2.0 * texture.linear[1] - 1.0));
        m.anisotropy *= texture.linear[2];
    }
    const double rotation = extension.number("anisotropyRotation", 0.0);
    m.anisotropyDirection = {std::cos(rotation) * direction.x - std::sin(rotation) * direction.y,
                             std::sin(rotation) * direction.x + std::cos(rotation) * direction.y};
}

}  // namespace

Vec2 Material::alpha() const {
    const double across = roughness * roughness;
    return {std::lerp(across, 1.0, anisotropy * anisotropy), across};
}

Material readMaterial(const Json& material, const std::vector<Texel>& texels) {
    const Reader root(material, texels);
    const Reader extensions = root.child("extensions");
    Material m;
    if (extensions.has("KHR_materials_pbrSpecularGlossiness")) {
        readSpecularGlossiness(extensions.child("KHR_materials_pbrSpecularGlossiness"), m);
    } else {
        readMetallicRoughness(root.child("pbrMetallicRoughness"), m);
        m.ior = extensions.child("KHR_materials_ior").number("ior", 1.5);
        const Reader specular = extensions.child("KHR_materials_specular");
        m.specular = specular.number("specularFactor", 1.0) * specular.texture("specularTexture").linear[3];
        m.specularColor = specular.color("specularColorFactor", Vec3(1.0)) *
                          specular.texture("specularColorTexture").color();
    }
    m.emission = root.color("emissiveFactor", Vec3(0.0)) * root.texture("emissiveTexture").color() *
                 extensions.child("KHR_materials_emissive_strength").number("emissiveStrength", 1.0);
    m.normal = root.normal("normalTexture");
    if (root.has("occlusionTexture")) {
        // Section 3.9.3: occlusionTextureInfo.strength.
        const double strength = root["occlusionTexture"].value("strength", 1.0);
        m.occlusion = 1.0 + strength * (root.texture("occlusionTexture").linear[0] - 1.0);
    }
    readTransmission(extensions, m);
    readLayers(extensions, m);
    readAnisotropy(extensions.child("KHR_materials_anisotropy"), m);
    return m;
}

}  // namespace glint::spec
