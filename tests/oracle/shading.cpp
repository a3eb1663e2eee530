#include "oracle/shading.h"

#include "numerics/shaders_double.h"
#include "oracle/material_vectors.h"

#include <algorithm>

namespace glint::oracle {
namespace {

// glTF 2.0, appendix B; KHR_materials_ior; KHR_materials_specular.
struct Base {
    Vec3 diffuse;
    Vec3 f0;  // of the dielectric
    double f90;
    Vec3 metalF0;
    double metallic;
};

Base baseOf(const materials::Material& material, const Vec3& color) {
    const double ior = material["ior"];
    const double metallic = material["metallicFactor"];
    const double specular = material["specularFactor"];
    const Vec3 dielectric =
        glm::min(squared((ior - 1.0) / (ior + 1.0)) * toVec(material["specularColorFactor"]), Vec3(1.0)) *
        specular;
    return {color * (1.0 - metallic), dielectric, specular, color, metallic};
}

glsl::Features featuresOf(const materials::Material& material) {
    glsl::uint lobes = 0;
    lobes |= material["clearcoatFactor"] > 0.0F ? GLINT_CLEARCOAT : 0U;
    lobes |= toVec(material["sheenColorFactor"]) != Vec3(0.0) ? GLINT_SHEEN : 0U;
    return {0U, GLINT_PARTIAL_METAL, 0xFFFFFFFFU, 0U, 0U, 0U, 0U, lobes, 0U, 0U, 0U};
}

glsl::Bsdf bsdfOf(const materials::Material& material, const Vec3& color, const Vec3& view) {
    const Base base = baseOf(material, color);
    glsl::Bsdf bsdf{};
    bsdf.diffuse = base.diffuse;
    bsdf.base.f0 = base.f0;
    bsdf.base.f90 = base.f90;
    bsdf.base.metalF0 = base.metalF0;
    bsdf.base.metallic = base.metallic;
    bsdf.base.alpha = glm::dvec2(std::max(squared(material["roughnessFactor"]), glsl::kMinAlpha));
    bsdf.base.eta = Vec3(1.0);
    bsdf.layers.clearcoat.factor = material["clearcoatFactor"];
    bsdf.layers.clearcoat.alpha = std::max(squared(material["clearcoatRoughnessFactor"]), glsl::kMinAlpha);
    bsdf.layers.clearcoat.normal = {0.0, 0.0, 1.0};
    bsdf.layers.sheen.color = toVec(material["sheenColorFactor"]);
    bsdf.layers.sheen.alpha = std::max(squared(material["sheenRoughnessFactor"]), glsl::kMinSheenAlpha);
    glsl::prepareBsdf(bsdf, featuresOf(material), view);
    return bsdf;
}

}  // namespace

Shading::Shading(const materials::Material& material, const Hit& hit, const Vec3& incoming)
    : material_(material),
      color_(hit.color),
      frame_(frameAbout(hit.front ? hit.normal : -hit.normal)),
      geometricNormal_(hit.front ? hit.geometricNormal : -hit.geometricNormal),
      view_(glm::transpose(frame_) * -incoming) {}

Vec3 Shading::baseColor() const {
    const auto& factor = material_["baseColorFactor"];
    return Vec3(factor[0], factor[1], factor[2]) * color_;
}

Vec3 Shading::emission() const {
    // KHR_materials_clearcoat: the coat transmits the part of the emission that it does not reflect.
    const double coat = material_["clearcoatFactor"] * reflectedByCoat();
    return toVec(material_["emissiveFactor"]) * static_cast<double>(material_["emissiveStrength"]) *
           (1.0 - coat);
}

Vec3 Shading::scattered(const Vec3& toLight) const {
    const Vec3 light = glm::transpose(frame_) * toLight;
    if (light.z * glm::dot(geometricNormal_, toLight) <= 0.0) {
        return Vec3(0.0);
    }
    return glsl::evaluateBsdf(bsdfOf(material_, baseColor(), view_), featuresOf(material_), light);
}

Vec3 Shading::mirrored(Vec3& direction) const {
    direction = frame_ * Vec3(-view_.x, -view_.y, view_.z);
    const Base base = baseOf(material_, baseColor());
    const double weight = std::pow(1.0 - std::clamp(view_.z, 0.0, 1.0), 5.0);
    return glm::mix(glm::mix(base.f0, Vec3(base.f90), weight), glm::mix(base.metalF0, Vec3(1.0), weight),
                    base.metallic);
}

double Shading::reflectedByCoat() const {
    return 0.04 + 0.96 * std::pow(1.0 - std::clamp(view_.z, 0.0, 1.0), 5.0);
}

}  // namespace glint::oracle
