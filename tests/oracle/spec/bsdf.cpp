#include "oracle/spec/bsdf.h"

#include "oracle/spec/directions.h"

#include <algorithm>
#include <cmath>

namespace glint::spec {
namespace {

constexpr double kLeastSheenRoughness = 0.07;

Vec3 mirrored(const Vec3& l) {
    return {l.x, l.y, -l.z};
}

double smallest(const Vec3& v) {
    return std::min({v.x, v.y, v.z});
}

}  // namespace

Bsdf::Bsdf(const Material& material, const Choices& choices, Albedos& albedos, const Vec3& view,
           const Vec3& coatNormal)
    : m_(material), choices_(choices), view_(view), coatNormal_(coatNormal) {
    choices_.iridescenceAtView = choices.iridescenceAtView || choices.compensation;
    alpha_ = glm::max(material.alpha(), Vec2(kLeastAlpha));
    coatAlpha_ = std::max(squared(material.clearcoatRoughness), kLeastAlpha);
    microfacets_ = &albedos.microfacets(alpha_, choices.masking);
    coatMicrofacets_ = &albedos.microfacets(Vec2(coatAlpha_), choices.masking);
    if (m_.specularGlossiness) {
        dielectric_.f0 = m_.specularColor;
    } else {
        // KHR_materials_specular, "Implementation".
        const Vec3 f0 = glm::min(reflectanceOfIor(m_.ior) * m_.specularColor, Vec3(1.0));
        dielectric_.f0 = m_.specular * f0;
        dielectric_.f90 = m_.specular;
    }
    metal_.f0 = m_.baseColor;
    setFilm(dielectric_);
    setFilm(metal_);
    if (largest(m_.sheenColor) > 0.0) {
        const double least = choices.sheenBounded ? kLeastSheenRoughness : 1e-3;
        sheenAlpha_ = squared(std::max(m_.sheenRoughness, least));
        sheenAlbedo_ = &albedos.sheen(sheenAlpha_);
    }
}

void Bsdf::setFilm(Base& base) const {
    if (m_.iridescence <= 0.0) {
        return;
    }
    if (!choices_.iridescenceAtView) {
        base.film = true;
        base.filmF0 = base.f0;
        return;
    }
    const Vec3 film =
        glm::min(filmFresnel(m_.iridescenceIor, base.f0, m_.iridescenceThickness, view_.z), Vec3(1.0));
    const double weight = schlickWeight(view_.z);
    const Vec3 f0 = (film - base.f90 * weight) / std::max(1.0 - weight, 1e-4);
    base.f0 = glm::mix(base.f0, glm::clamp(f0, Vec3(0.0), Vec3(base.f90)), m_.iridescence);
}

// Appendix B.3.4 (conductor_fresnel, fresnel_mix); KHR_materials_iridescence, "Implementation Notes".
Vec3 Bsdf::fresnel(const Base& base, double cosine) const {
    const Vec3 schlick = base.f0 + (Vec3(base.f90) - base.f0) * schlickWeight(cosine);
    if (!base.film) {
        return schlick;
    }
    const Vec3 film = filmFresnel(m_.iridescenceIor, base.filmF0, m_.iridescenceThickness, std::abs(cosine));
    return glm::mix(schlick, film, m_.iridescence);
}

Vec3 Bsdf::albedoOnce(const Base& base, const MicrofacetAlbedo::Value& value) const {
    return base.f0 * (value.whole() - value.weighted) + base.f90 * value.weighted;
}

Vec3 Bsdf::laterFresnel(const Base& base) const {
    // 2 ∫ F(μ) μ dμ of Schlick's Fresnel.
    const Vec3 mean = base.f0 + (Vec3(base.f90) - base.f0) / 21.0;
    const double lost = microfacets_->mean().lost;
    return mean * mean * (1.0 - lost) / (Vec3(1.0) - mean * lost);
}

Vec3 Bsdf::reflectedAlbedo(const Base& base, const MicrofacetAlbedo::Value& value) const {
    Vec3 result = albedoOnce(base, value);
    if (choices_.compensation) {
        result += laterFresnel(base) * value.lost;
    }
    return result;
}

double Bsdf::leftBelow(const MicrofacetAlbedo::Value& value) const {
    return std::max(smallest(Vec3(1.0) - reflectedAlbedo(dielectric_, value)), 0.0);
}

double Bsdf::layersAbove(const Vec3& l) const {
    double share = 1.0 - coatWeight();
    if (sheenAlbedo_ != nullptr) {
        // KHR_materials_sheen, "Albedo-scaling technique". The text has no light from the far side, which
        // passes the sheen once, on its way to the view.
        double below = belowSheenOfView();
        if (l.z > 0.0 && !choices_.sheenAtView) {
            const double albedo = sheenAlbedo_->at(l.z);
            below = std::min(below, 1.0 - largest(m_.sheenColor) *
                                              (choices_.sheenBounded ? std::min(albedo, 1.0) : albedo));
        }
        share *= below;
    }
    return share;
}

double Bsdf::sheenAlbedoOfView() const {
    if (sheenAlbedo_ == nullptr) {
        return 0.0;
    }
    const double albedo = sheenAlbedo_->at(view_.z);
    return choices_.sheenBounded ? std::min(albedo, 1.0) : albedo;
}

double Bsdf::belowSheenOfView() const {
    return 1.0 - largest(m_.sheenColor) * sheenAlbedoOfView();
}

// KHR_materials_clearcoat, "Layering": fresnel_coat with the angle of the view.
double Bsdf::coatWeight() const {
    const double cosine = glm::dot(view_, coatNormal_);
    return m_.clearcoat * (0.04 + 0.96 * schlickWeight(cosine));
}

Vec3 Bsdf::specular(const Vec3& l) const {
    if (l.z <= 0.0) {
        return Vec3(0.0);
    }
    const Vec3 h = glm::normalize(view_ + l);
    const double cosine = glm::dot(view_, h);
    // Appendix B.1: material = mix(dielectric_brdf, metal_brdf, metallic).
    const Vec3 both = glm::mix(fresnel(dielectric_, cosine), fresnel(metal_, cosine), m_.metallic);
    return both *
           (distribution(h, alpha_) * visibility(l, view_, alpha_, choices_.masking) * l.z * layersAbove(l));
}

Vec3 Bsdf::multiple(const Vec3& l) const {
    if (!choices_.compensation || l.z <= 0.0) {
        return Vec3(0.0);
    }
    const double lost =
        microfacets_->at(view_).lost * microfacets_->at(l).lost / std::max(microfacets_->mean().lost, 1e-15);
    return glm::mix(laterFresnel(dielectric_), laterFresnel(metal_), m_.metallic) *
           (lost / kPi * l.z * layersAbove(l));
}

double Bsdf::diffuseShare(const Vec3& l, double facetCosine) const {
    if (!choices_.compensation) {
        // fresnel_mix and rgb_mix: the base has what the layer's largest channel leaves.
        return 1.0 - largest(fresnel(dielectric_, facetCosine));
    }
    return leftBelow(microfacets_->at(view_)) * leftBelow(microfacets_->at(l)) /
           std::max(leftBelow(microfacets_->mean()), 1e-9);
}

Vec3 Bsdf::diffuse(const Vec3& l) const {
    if (l.z <= 0.0) {
        return Vec3(0.0);
    }
    const Vec3 h = glm::normalize(view_ + l);
    // KHR_materials_pbrSpecularGlossiness: c_diff = diffuse (1 - max(specular)).
    const double kept = m_.specularGlossiness ? 1.0 - largest(m_.specularColor) : 1.0;
    const double share =
        (1.0 - m_.metallic) * (1.0 - m_.transmission) * (1.0 - m_.diffuseTransmission) * kept;
    return m_.baseColor * (share * diffuseShare(l, glm::dot(view_, h)) / kPi * l.z * layersAbove(l));
}

Vec3 Bsdf::diffuseTransmitted(const Vec3& l) const {
    if (l.z >= 0.0 || m_.diffuseTransmission <= 0.0) {
        return Vec3(0.0);
    }
    // The text gives no half vector for light from the far side. This takes that of
    // KHR_materials_transmission.
    const Vec3 h = glm::normalize(view_ + mirrored(l));
    const double cosine = choices_.transmittedAtView ? view_.z : glm::dot(view_, h);
    const double share = (1.0 - m_.metallic) * (1.0 - m_.transmission) * m_.diffuseTransmission;
    const Vec3 absorbed = glm::exp(-m_.absorption * m_.thickness);
    return m_.diffuseTransmissionColor * absorbed *
           (share * diffuseShare(mirrored(l), cosine) / kPi * -l.z * layersAbove(l));
}

Vec3 Bsdf::iors() const {
    return dispersedIors(m_.ior, m_.dispersion);
}

// KHR_materials_volume, "Attenuation".
Vec3 Bsdf::absorbed() const {
    return choices_.absorbsAlongRays ? Vec3(1.0) : glm::exp(-m_.absorption * m_.thickness);
}

bool Bsdf::straight() const {
    return m_.volume && m_.transmission > 0.0 && std::abs(m_.ior - 1.0) < 1e-4;
}

Vec3 Bsdf::straightWeight() const {
    const double share =
        (1.0 - m_.metallic) * m_.transmission * (1.0 - largest(fresnel(dielectric_, view_.z)));
    return m_.baseColor * absorbed() * (share * layersAbove({0.0, 0.0, -1.0}));
}

double Bsdf::transmittedChannel(const Vec3& l, double eta) const {
    if (!m_.volume) {
        // KHR_materials_transmission, "Implementation Notes".
        const Vec3 h = glm::normalize(view_ + mirrored(l));
        return distribution(h, alpha_) * visibility(l, view_, alpha_, choices_.masking) *
               (1.0 - largest(fresnel(dielectric_, glm::dot(view_, h))));
    }
    // KHR_materials_volume, "Implementation"; the view is in air.
    Vec3 h = -glm::normalize(view_ + eta * l);
    h = h.z < 0.0 ? -h : h;
    const double viewCosine = glm::dot(view_, h);
    const double lightCosine = glm::dot(l, h);
    if (viewCosine <= 0.0 || lightCosine >= 0.0) {
        return 0.0;
    }
    // G / (|n·l| |n·v|) is four times the visibility.
    const double lobe = -lightCosine * viewCosine * 4.0 * visibility(l, view_, alpha_, choices_.masking) *
                        eta * eta * distribution(h, alpha_) / squared(viewCosine + eta * lightCosine);
    return lobe * (1.0 - largest(fresnel(dielectric_, eta >= 1.0 ? viewCosine : -lightCosine)));
}

Vec3 Bsdf::throughMicrofacets(const Vec3& l, double (Bsdf::*channel)(const Vec3&, double) const) const {
    if (l.z >= 0.0 || m_.transmission <= 0.0 || straight()) {
        return Vec3(0.0);
    }
    const Vec3 indices = iors();
    Vec3 lobe((this->*channel)(l, indices.y));
    if (m_.dispersion > 0.0) {
        lobe.x = (this->*channel)(l, indices.x);
        lobe.z = (this->*channel)(l, indices.z);
    }
    return lobe * m_.baseColor * absorbed() * ((1.0 - m_.metallic) * m_.transmission * -l.z * layersAbove(l));
}

Vec3 Bsdf::transmitted(const Vec3& l) const {
    return throughMicrofacets(l, &Bsdf::transmittedChannel);
}

// The density of the directions to which visible facets bend the view (Heitz 2018, with the Jacobian of
// Walter et al. 2007), times what they pass, for l on either side.
double Bsdf::bentLight(const Vec3& l, double eta) const {
    Vec3 h = -glm::normalize(view_ + eta * l);
    h = h.z < 0.0 ? -h : h;
    const double viewCosine = glm::dot(view_, h);
    const double lightCosine = glm::dot(l, h);
    if (viewCosine <= 0.0 || lightCosine >= 0.0) {
        return 0.0;
    }
    return visibleNormalDensity(view_, h, alpha_) * eta * eta * -lightCosine /
           squared(viewCosine + eta * lightCosine) * (1.0 - largest(fresnel(dielectric_, viewCosine)));
}

// What facets of a volume block leaves where they send it, mirrored at the plane if that is on the other
// side. All passes that the facets do not reflect.
double Bsdf::wholeChannel(const Vec3& l, double eta) const {
    const MicrofacetAlbedo::Value value = microfacets_->at(view_);
    const double once = 1.0 - largest(dielectric_.f0 + (Vec3(dielectric_.f90) - dielectric_.f0) * value.seen);
    return leftBelow(value) / once * (bentLight(l, eta) + bentLight(mirrored(l), eta)) / -l.z;
}

Vec3 Bsdf::transmittedOfLights(const Vec3& l) const {
    return choices_.compensation && m_.volume ? throughMicrofacets(l, &Bsdf::wholeChannel)
                                              : transmitted(l) + multipleTransmitted(l);
}

// Kulla and Conty's lobe on the far side of a thin wall: of what single scattering loses, what later bounces
// do not reflect passes in the end.
Vec3 Bsdf::multipleTransmitted(const Vec3& l) const {
    if (!choices_.compensation || l.z >= 0.0 || m_.volume) {
        return Vec3(0.0);
    }
    const double lost = microfacets_->at(view_).lost * microfacets_->at(mirrored(l)).lost /
                        std::max(microfacets_->mean().lost, 1e-15);
    const double passes =
        smallest(Vec3(1.0) - laterFresnel(dielectric_)) * (1.0 - m_.metallic) * m_.transmission;
    return m_.baseColor * (passes * lost / kPi * -l.z * layersAbove(l));
}

Vec3 Bsdf::sheen(const Vec3& l) const {
    if (sheenAlbedo_ == nullptr || l.z <= 0.0) {
        return Vec3(0.0);
    }
    const Vec3 h = glm::normalize(view_ + l);
    double lobe = sheenDistribution(h.z, sheenAlpha_) * sheenVisibility(l.z, view_.z, sheenAlpha_);
    if (choices_.sheenBounded) {
        lobe /= std::max({1.0, sheenAlbedo_->at(view_.z), sheenAlbedo_->at(l.z)});
    }
    return m_.sheenColor * (lobe * l.z * (1.0 - coatWeight()));
}

// The hemisphere is that about the coat's normal, whatever the normal of the base is.
Vec3 Bsdf::coat(const Vec3& l) const {
    const double lightCosine = glm::dot(coatNormal_, l);
    const double viewCosine = glm::dot(coatNormal_, view_);
    if (m_.clearcoat <= 0.0 || lightCosine <= 0.0 || viewCosine <= 0.0) {
        return Vec3(0.0);
    }
    // The lobe is isotropic, so any frame about the coat's normal serves. The cosine is that to this normal,
    // as the layer's own surface receives the light.
    const glm::dmat3 toCoat = glm::transpose(oracle::frameAbout(coatNormal_));
    const Vec3 v = toCoat * view_;
    const Vec3 light = toCoat * l;
    const Vec2 alpha(coatAlpha_);
    // What its microfacets scatter more than once grows the lobe.
    const double gain = choices_.compensation ? 1.0 / coatMicrofacets_->at(v).whole() : 1.0;
    return Vec3(coatWeight() * gain * distribution(glm::normalize(v + light), alpha) *
                visibility(light, v, alpha, choices_.masking) * lightCosine);
}

Vec3 Bsdf::base(const Vec3& l) const {
    return specular(l) + multiple(l) + diffuse(l) + diffuseTransmitted(l) + transmittedOfLights(l) + sheen(l);
}

// KHR_materials_clearcoat, "Emission".
Vec3 Bsdf::emission() const {
    return m_.emission * (1.0 - coatWeight());
}

Bsdf::Albedo Bsdf::albedo() const {
    const MicrofacetAlbedo::Value value = microfacets_->at(view_);
    return {glm::mix(albedoOnce(dielectric_, value), albedoOnce(metal_, value), m_.metallic),
            glm::mix(reflectedAlbedo(dielectric_, value), reflectedAlbedo(metal_, value), m_.metallic),
            leftBelow(value), value.lost};
}

}  // namespace glint::spec
