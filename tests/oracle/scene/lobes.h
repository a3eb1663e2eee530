// Makes the shaders' BSDF parameters from a material at a point. It has internal linkage, like the BSDF
// (numerics/glsl.h): only surface.cpp includes this.
#pragma once

#include "numerics/shaders_double.h"
#include "oracle/material_vectors.h"
#include "oracle/scene/inputs.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace glint::oracle {
namespace {

double largestOf(const Vec3& v) {
    return std::max({v.x, v.y, v.z});
}

struct Base {
    Vec3 color{0.0};
    double metallic = 0.0;
    double roughness = 1.0;
    Vec3 specularColor{1.0};
};

// glTF 2.0, appendix B; KHR_materials_ior; KHR_materials_specular; KHR_materials_pbrSpecularGlossiness.
Base applyBase(const Inputs& inputs, glsl::Bsdf& bsdf) {
    const materials::Material& material = inputs.material();
    const glm::dvec4 texel = inputs.texel("metallicRoughnessTexture");
    Base base;
    base.color = Vec3(inputs.baseColor());
    if (material.gives("KHR_materials_pbrSpecularGlossiness")) {
        bsdf.base.f0 = toVec(material["glossySpecularFactor"]) * Vec3(texel);
        bsdf.base.f90 = 1.0;
        bsdf.diffuse = base.color * (1.0 - largestOf(bsdf.base.f0));
        base.roughness = 1.0 - material["glossinessFactor"] * texel.a;
        return base;
    }
    base.metallic = material["metallicFactor"] * texel.b;
    base.roughness = material["roughnessFactor"] * texel.g;
    const double ior = material["ior"];
    const double specular = material["specularFactor"] * inputs.texel("specularTexture").a;
    const Vec3 tint = toVec(material["specularColorFactor"]) * Vec3(inputs.texel("specularColorTexture"));
    base.specularColor = tint;
    const Vec3 dielectric = glm::min(squared((ior - 1.0) / (ior + 1.0)) * tint, Vec3(1.0)) * specular;
    bsdf.diffuse = base.color * (1.0 - base.metallic);
    bsdf.base.f0 = dielectric;
    bsdf.base.f90 = specular;
    bsdf.base.metalF0 = base.color;
    bsdf.base.metallic = base.metallic;
    return base;
}

// The medium around a surface, for paths that follow light through volumes.
struct Surroundings {
    Vec3 ior{1.0};        // of red, green, blue
    bool nested = false;  // it is a medium of the scene, not the air
};

// A surface's BSDF, prepared for a view, and its inputs. With `surroundings`, light that enters a volume is
// not absorbed at its surface, because its path is followed through the volume.
struct SurfaceLobes {
    Inputs inputs;
    const Surroundings* surroundings;
    double side;  // 1: seen from the front
    Vec3 view;    // world
    double mirrorLimit;
    glm::dmat3 frame{1.0};
    glsl::Bsdf bsdf{};
    glsl::uint lobes = 0;
    double roughness = 1.0;
    Vec3 emission{0.0};
    double occlusion = 1.0;

    SurfaceLobes(const Textures& textures, const SurfacePoint& point, const Vec3& incoming,
                 double mirrorRoughness, const Surroundings* around = nullptr)
        : inputs(textures, point),
          surroundings(around),
          side(point.front ? 1.0 : -1.0),
          view(-incoming),
          mirrorLimit(mirrorRoughness) {
        if (inputs.material().isUnlit()) {
            return;
        }
        const materials::Material& material = inputs.material();
        const Vec3 normal = side * inputs.mappedNormal("normalTexture", material["normalScale"]);
        frame = frameAbout(normal);
        bsdf.base.eta = Vec3(1.0);
        bsdf.layers.clearcoat.alpha = 1.0;
        bsdf.layers.clearcoat.normal = Vec3(0.0, 0.0, 1.0);
        bsdf.layers.sheen.alpha = 1.0;
        const Base base = applyBase(inputs, bsdf);
        bsdf.base.alpha = glm::dvec2(std::max(squared(base.roughness), glsl::kMinAlpha));
        roughness = base.roughness;
        if (!material.gives("KHR_materials_pbrSpecularGlossiness")) {
            applyAnisotropy();
            applyIridescence();
            applyTransmission(base);
            applySheen();
            applyClearcoat();
        }
        glsl::prepareBsdf(bsdf, features(), toFrame(view));
        emission = toVec(material["emissiveFactor"]) * Vec3(inputs.texel("emissiveTexture")) *
                   static_cast<double>(material["emissiveStrength"]) * (1.0 - coat());
        if (inputs.reads("occlusionTexture")) {
            occlusion = 1.0 + material["occlusionStrength"] * (inputs.texel("occlusionTexture").r - 1.0);
        }
    }

    glsl::Features features() const {
        // Here every material has both bases. The specification mixes them whatever the share of the metal
        // is.
        return {0U, GLINT_PARTIAL_METAL, 0xFFFFFFFFU, 0U, 0U, 0U, 0U, lobes, 0U, 0U, 0U};
    }
    bool has(glsl::uint lobe) const {
        return (lobes & lobe) != 0U;
    }
    Vec3 toFrame(const Vec3& direction) const {
        return glm::transpose(frame) * direction;
    }

    // KHR_materials_anisotropy.
    void applyAnisotropy() {
        const materials::Material& given = inputs.material();
        if (given["anisotropyStrength"] == 0.0F || !inputs.hasDirection()) {
            return;
        }
        lobes |= GLINT_ANISOTROPY;
        double angle = given["anisotropyRotation"];
        double strength = given["anisotropyStrength"];
        Vec2 direction(std::cos(angle), std::sin(angle));
        std::string_view slot = "normalTexture";
        if (inputs.reads("anisotropyTexture")) {
            slot = "anisotropyTexture";
            const glm::dvec4 texel = inputs.texel(slot);
            const Vec2 turned = Vec2(texel) * 2.0 - 1.0;
            direction = {direction.x * turned.x - direction.y * turned.y,
                         direction.y * turned.x + direction.x * turned.y};
            strength *= texel.b;
        }
        const glm::dmat3 tangents = inputs.tangentFrame(slot);
        const Vec3 n = frame[2];
        Vec3 along = tangents[0] * direction.x + tangents[1] * direction.y;
        along -= n * glm::dot(n, along);
        if (along != Vec3(0.0)) {
            const Vec3 tangent = glm::normalize(along);
            frame = {tangent, glm::cross(n, tangent), n};
        }
        bsdf.base.alpha.x = glm::mix(bsdf.base.alpha.y, 1.0, squared(strength));
        roughness = std::sqrt(bsdf.base.alpha.x);
    }

    // KHR_materials_iridescence, at the angle of the view.
    void applyIridescence() {
        const materials::Material& given = inputs.material();
        if (given["iridescenceFactor"] == 0.0F || given["iridescenceIor"] == 1.0F) {
            return;
        }
        const double factor = given["iridescenceFactor"] * inputs.texel("iridescenceTexture").r;
        double thickness = given["iridescenceThicknessMaximum"];
        if (inputs.reads("iridescenceThicknessTexture")) {
            thickness = glm::mix<double>(float{given["iridescenceThicknessMinimum"]},
                                         float{given["iridescenceThicknessMaximum"]},
                                         inputs.texel("iridescenceThicknessTexture").g);
        }
        const double cosine = std::clamp(toFrame(view).z, 0.0, 1.0);
        const auto covered = [&](const Vec3& f0, double f90) {
            const Vec3 film = glsl::iridescentFresnel(cosine, f0, float{given["iridescenceIor"]}, thickness);
            return glm::mix(f0, glm::min(glsl::schlickF0(film, f90, cosine), Vec3(f90)), factor);
        };
        bsdf.base.f0 = covered(bsdf.base.f0, bsdf.base.f90);
        bsdf.base.metalF0 = covered(bsdf.base.metalF0, 1.0);
    }

    // KHR_materials_transmission, _diffuse_transmission, _volume, _dispersion.
    void applyTransmission(const Base& base) {
        const materials::Material& material = inputs.material();
        const double dielectric = 1.0 - base.metallic;
        double passed = 0.0;
        if (material["transmissionFactor"] > 0.0F) {
            lobes |= GLINT_TRANSMISSION;
            passed = material["transmissionFactor"] * inputs.texel("transmissionTexture").r;
            bsdf.base.transmitted = base.color * (dielectric * passed);
            bsdf.diffuse *= 1.0 - passed;
        }
        if (material["diffuseTransmissionFactor"] > 0.0F) {
            lobes |= GLINT_DIFFUSE_TRANSMISSION;
            const double share =
                material["diffuseTransmissionFactor"] * inputs.texel("diffuseTransmissionTexture").a;
            bsdf.diffuseTransmitted = toVec(material["diffuseTransmissionColorFactor"]) *
                                      Vec3(inputs.texel("diffuseTransmissionColorTexture")) *
                                      (share * (1.0 - passed) * dielectric);
            bsdf.diffuse *= 1.0 - share;
        }
        if (has(GLINT_TRANSMISSION | GLINT_DIFFUSE_TRANSMISSION) && material["thicknessFactor"] > 0.0F) {
            applyVolume(base);
        }
    }

    void applyVolume(const Base& base) {
        const materials::Material& material = inputs.material();
        lobes |= GLINT_VOLUME;
        Vec3 iors(material["ior"]);
        if (material["dispersion"] > 0.0F && has(GLINT_TRANSMISSION)) {
            // KHR_materials_dispersion, "Implementation".
            lobes |= GLINT_DISPERSION;
            const double spread = (material["ior"] - 1.0) * 0.025 * material["dispersion"];
            iors += Vec3(-spread, 0.0, spread);
        }
        bsdf.base.eta = side < 0.0 ? 1.0 / iors : iors;
        if (side < 0.0 && (surroundings == nullptr || has(GLINT_TRANSMISSION))) {
            bsdf.diffuse = Vec3(0.0);
            bsdf.diffuseTransmitted = Vec3(0.0);
        }
        if (surroundings != nullptr) {
            bsdf.base.eta = side < 0.0 ? surroundings->ior / iors : iors / surroundings->ior;
            if (surroundings->nested) {
                // KHR_materials_specular, with the index of the medium outside. f90 is its factor.
                const double plain = squared((bsdf.base.eta.y - 1.0) / (bsdf.base.eta.y + 1.0));
                bsdf.base.f0 = glm::min(plain * base.specularColor, Vec3(1.0)) * bsdf.base.f90;
            }
            return;
        }
        if (material["attenuationDistance"] > 0.0F) {
            const double thickness =
                material["thicknessFactor"] * inputs.texel("thicknessTexture").g * inputs.point().scale;
            const Vec3 transmittance = glm::pow(toVec(material["attenuationColor"]),
                                                Vec3(thickness / material["attenuationDistance"]));
            bsdf.base.transmitted *= transmittance;
            bsdf.diffuseTransmitted *= transmittance;
        }
    }

    void applySheen() {
        const materials::Material& given = inputs.material();
        if (toVec(given["sheenColorFactor"]) == Vec3(0.0)) {
            return;
        }
        lobes |= GLINT_SHEEN;
        bsdf.layers.sheen.color = toVec(given["sheenColorFactor"]) * Vec3(inputs.texel("sheenColorTexture"));
        bsdf.layers.sheen.alpha =
            std::max(squared(given["sheenRoughnessFactor"] * inputs.texel("sheenRoughnessTexture").a),
                     glsl::kMinSheenAlpha);
    }

    // KHR_materials_clearcoat: the coat has the mesh's normals unless it has a texture of its own.
    void applyClearcoat() {
        const materials::Material& given = inputs.material();
        if (given["clearcoatFactor"] == 0.0F) {
            return;
        }
        lobes |= GLINT_CLEARCOAT;
        bsdf.layers.clearcoat.factor = given["clearcoatFactor"] * inputs.texel("clearcoatTexture").r;
        bsdf.layers.clearcoat.alpha =
            std::max(squared(given["clearcoatRoughnessFactor"] * inputs.texel("clearcoatRoughnessTexture").g),
                     glsl::kMinAlpha);
        bsdf.layers.clearcoat.normal =
            toFrame(side * inputs.mappedNormal("clearcoatNormalTexture", given["clearcoatNormalScale"]));
    }

    // Returns the share that the coat reflects at the view.
    double coat() const {
        return has(GLINT_CLEARCOAT)
                   ? glsl::clearcoatFresnel(bsdf.layers.clearcoat.factor,
                                            glsl::clearcoatViewCosine(bsdf.layers.clearcoat, bsdf.view))
                   : 0.0;
    }
    double baseShare() const {
        const double share = 1.0 - coat();
        return has(GLINT_SHEEN) ? share * glsl::belowSheen(bsdf.layers.sheen, bsdf.layers.sheen.albedo)
                                : share;
    }

    double tracedShare(double lobeRoughness) const {
        if (lobeRoughness > mirrorLimit || mirrorLimit < 0.0) {
            return 0.0;
        }
        const double fade =
            mirrorLimit > 0.0
                ? std::clamp((lobeRoughness - 0.8 * mirrorLimit) / (0.2 * mirrorLimit), 0.0, 0.999)
                : 0.0;
        return 1.0 - fade * fade * (3.0 - 2.0 * fade);
    }
    double tracedCoat() const {
        return has(GLINT_CLEARCOAT) ? tracedShare(std::sqrt(bsdf.layers.clearcoat.alpha)) : 0.0;
    }
};

}  // namespace
}  // namespace glint::oracle
