// The BSDF of a glTF material for one view, lobe by lobe, from the specification's structure:
// coat(sheen(mix(dielectric, metal, metallic))). The plain formulas are those of the texts. Choices that
// Glint documents are options here, in formulas of their own.
#pragma once

#include "oracle/spec/albedo.h"

namespace glint::spec {

// Choices of Glint that docs/materials.md states. Without any of them the result is the specification's.
struct Choices {
    // Microfacets give back what leaves them after several bounces (Kulla and Conty 2017, with Hill's Fresnel
    // of 2018), and the diffuse lobes have what the dielectric's microfacets leave in both directions
    // (Kelemen and Szirmay-Kalos 2001) instead of 1 - F(v·h). Implies `iridescenceAtView`.
    bool compensation = false;
    // The film's reflectance at the angle of the view becomes the F0 of Schlick's approximation.
    bool iridescenceAtView = false;
    // The sheen's roughness is at least 0.07, its lobe is divided by max(1, E(v), E(l)), and E counts up
    // to 1.
    bool sheenBounded = false;
    // The sheen leaves to the base what the view's albedo says, whatever the light's (the simplified form of
    // the extension's text).
    bool sheenAtView = false;
    // Diffuse transmission counts the Fresnel of the view, not that of a mirrored half vector.
    bool transmittedAtView = false;
    // A ray absorbs over its own distance in a volume. The comparisons' rays end in the volume that they
    // enter, without having met a surface, so nothing is absorbed. Otherwise the thickness at the surface
    // counts.
    bool absorbsAlongRays = false;
    Masking masking = Masking::HeightCorrelated;
};

class Bsdf {
public:
    // `view` is in the frame of the base, z > 0. `coatNormal` is a unit vector in the same frame. The
    // material and the albedos must outlive the BSDF.
    Bsdf(const Material& material, const Choices& choices, Albedos& albedos, const Vec3& view,
         const Vec3& coatNormal = {0.0, 0.0, 1.0});

    // Each lobe's value for light from l, times its |cosine|, with what the layers above leave of it.
    Vec3 specular(const Vec3& l) const;  // the base's microfacets, once
    Vec3 multiple(const Vec3& l) const;  // later bounces; 0 without compensation
    Vec3 diffuse(const Vec3& l) const;
    Vec3 diffuseTransmitted(const Vec3& l) const;
    Vec3 transmitted(const Vec3& l) const;          // through microfacets
    Vec3 multipleTransmitted(const Vec3& l) const;  // thin walls: at later bounces; 0 without compensation
    Vec3 transmittedOfLights(const Vec3& l) const;  // at all bounces that the choices count
    Vec3 sheen(const Vec3& l) const;
    Vec3 coat(const Vec3& l) const;
    Vec3 base(const Vec3& l) const;  // all but the coat
    Vec3 emission() const;

    // The volume's index is that of air, so light goes straight on with this weight, and transmitted() is 0.
    bool straight() const;
    Vec3 straightWeight() const;

    // Shares of a uniform white sky for the view, without the layers above.
    struct Albedo {
        Vec3 once{0.0};       // the base's microfacets reflect after one bounce
        Vec3 reflected{0.0};  // after all bounces that the choices count
        double below = 0.0;  // the dielectric leaves to what lies below, in the channel where it leaves least
        double lost = 0.0;   // single scattering loses, whatever the reflectance
    };
    Albedo albedo() const;
    // The coat's weight, and the share of the view's light that the sheen leaves to the base.
    double coatWeight() const;
    double belowSheenOfView() const;
    double sheenAlbedoOfView() const;

    const Material& material() const {
        return m_;
    }
    const Vec2& alpha() const {
        return alpha_;
    }
    const Vec3& view() const {
        return view_;
    }
    const Vec3& coatNormal() const {
        return coatNormal_;
    }
    double coatAlpha() const {
        return coatAlpha_;
    }
    // The indices of red, green and blue.
    Vec3 iors() const;
    bool compensated() const {
        return choices_.compensation;
    }

private:
    struct Base {
        Vec3 f0{0.0};
        double f90 = 1.0;
        bool film = false;  // of the film at each facet, in the proportion of the iridescence
        Vec3 filmF0{0.0};   // F0 below the film
    };
    Vec3 fresnel(const Base& base, double cosine) const;
    Vec3 albedoOnce(const Base& base, const MicrofacetAlbedo::Value& value) const;
    Vec3 laterFresnel(const Base& base) const;
    Vec3 reflectedAlbedo(const Base& base, const MicrofacetAlbedo::Value& value) const;
    double leftBelow(const MicrofacetAlbedo::Value& value) const;
    // The share of light that reaches the lobes below the dielectric's microfacets and leaves them again.
    double diffuseShare(const Vec3& l, double facetCosine) const;
    double layersAbove(const Vec3& l) const;
    Vec3 absorbed() const;  // the share that passes the volume
    // Returns what passes by a function of one channel: transmittedChannel() or wholeChannel().
    Vec3 throughMicrofacets(const Vec3& l, double (Bsdf::*channel)(const Vec3&, double) const) const;
    double transmittedChannel(const Vec3& l, double eta) const;
    double bentLight(const Vec3& l, double eta) const;
    double wholeChannel(const Vec3& l, double eta) const;
    void setFilm(Base& base) const;

    const Material& m_;
    Choices choices_;
    Vec3 view_;
    Vec3 coatNormal_;
    Vec2 alpha_{0.0};
    double coatAlpha_ = 0.0;
    double sheenAlpha_ = 0.0;
    Base dielectric_;
    Base metal_;
    const MicrofacetAlbedo* microfacets_ = nullptr;
    const MicrofacetAlbedo* coatMicrofacets_ = nullptr;
    const SheenAlbedo* sheenAlbedo_ = nullptr;
};

// alpha of lobes that the specification makes a mirror (roughness 0), so that they can be integrated.
inline constexpr double kLeastAlpha = 1e-4;

}  // namespace glint::spec
