#include "oracle/scene/surface.h"

#include "oracle/scene/lobes.h"

#include <array>
#include <numbers>

namespace glint::oracle {

struct LitSurface::Lobes : SurfaceLobes {
    using SurfaceLobes::SurfaceLobes;

    // Returns the sky in a direction. A rough lobe sees the sky's irradiance about it, from the first two
    // orders of spherical harmonics (Ramamoorthi and Hanrahan 2001).
    static Vec3 diffuseSky(const GradientSky& sky, const Vec3& normal) {
        return 0.25 * (2.0 * sky.horizon + sky.zenith + sky.ground) +
               (sky.zenith - sky.ground) * (normal.y / 3.0);
    }
    static Vec3 skyAround(const GradientSky& sky, const Vec3& direction, double lobeRoughness) {
        return glm::mix(sky(direction), diffuseSky(sky, direction), lobeRoughness);
    }
    // Returns the sky over an anisotropic lobe by filtered importance sampling (Křivánek and Colbert 2008):
    // 16 visible normals, by Hammersley's points, each of which sees a lobe whose density at its centre is
    // that of the sample times 16.
    Vec3 skyAroundLobe(const GradientSky& sky) const {
        constexpr unsigned kTaps = 16;
        constexpr std::array kReversed{0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
        const Vec3 v = bsdf.view;
        Vec3 sum(0.0);
        double total = 0.0;
        for (unsigned i = 0; i < kTaps; ++i) {
            const Vec2 u((kReversed[i] + 0.5) / kTaps, (i + 0.5) / kTaps);
            const Vec3 h = glsl::sampleVisibleNormal(v, bsdf.base.alpha, u);
            const Vec3 l = glm::reflect(-v, h);
            if (l.z <= 0.0) {
                continue;
            }
            const double weight = l.z * glsl::ggxVisibility(l, v, bsdf.base.alpha);
            const double density = glsl::visibleNormalPdf(v, h, bsdf.base.alpha) / (4.0 * glm::dot(v, h));
            // (1 + α²) / (4π α²) = 16 density
            const double filled =
                std::min(1.0 / (4.0 * std::numbers::pi * kTaps * std::max(density, 1e-6)), 0.5);
            sum += weight * skyAround(sky, frame * l, std::pow(filled / (1.0 - filled), 0.25));
            total += weight;
        }
        return sum / std::max(total, 1e-12);
    }
    // Returns what the microfacets reflect of the sky, of which rays bring `traced` of the first bounce.
    Vec3 reflection(const GradientSky& sky, double traced) const {
        const Vec3 all = glsl::specularAlbedo(bsdf.base, features());
        const Vec3 first = glsl::singleScatterAlbedo(bsdf.base, features());
        if (has(GLINT_ANISOTROPY)) {
            return first * (1.0 - traced) * skyAroundLobe(sky) + (all - first) * diffuseSky(sky, frame[2]);
        }
        return (all - first * traced) * skyAround(sky, glm::reflect(-view, frame[2]), roughness);
    }
    // Returns the sky behind a thin wall, or where a volume bends the view to as it enters, with one index
    // for each channel.
    Vec3 skyBehind(const GradientSky& sky) const {
        Vec3 behind(0.0);
        for (int channel = 0; channel < 3; ++channel) {
            Vec3 direction = -bsdf.view;
            const double eta = bsdf.base.eta[channel];
            if (!has(GLINT_VOLUME) || !glsl::refracts(eta) ||
                glsl::refractDirection(bsdf.view, Vec3(0.0, 0.0, 1.0), eta, direction)) {
                behind[channel] = skyAround(sky, frame * direction, roughness)[channel];
            }
        }
        return behind;
    }
    Vec3 ambient(const GradientSky& sky) const {
        const double passed = glsl::diffusePassed(bsdf.base);
        const Vec3 n = frame[2];
        Vec3 result = (bsdf.diffuse * passed * diffuseSky(sky, n) + reflection(sky, tracedShare(roughness))) *
                      occlusion;
        if (has(GLINT_TRANSMISSION)) {
            result += bsdf.base.transmitted * skyBehind(sky) * passed;
        }
        if (has(GLINT_DIFFUSE_TRANSMISSION)) {
            result += bsdf.diffuseTransmitted * passed * diffuseSky(sky, -n);
        }
        result *= baseShare();
        if (has(GLINT_SHEEN)) {
            result += bsdf.layers.sheen.color * std::min(bsdf.layers.sheen.albedo, 1.0) * diffuseSky(sky, n) *
                      (occlusion * (1.0 - coat()));
        }
        if (has(GLINT_CLEARCOAT)) {
            const Vec3 direction = glm::reflect(-view, frame * bsdf.layers.clearcoat.normal);
            result += skyAround(sky, direction, std::sqrt(bsdf.layers.clearcoat.alpha)) *
                      (coat() * (1.0 - tracedCoat()) * occlusion);
        }
        return result;
    }

    // Returns the mirror direction about a normal. Below the surface, it is reflected at the surface once
    // more. It leaves the surface by at least a thousandth.
    Vec3 mirrorDirection(const Vec3& normal) const {
        const Vec3 direction = glm::reflect(-view, normal);
        const Vec3 out = side * inputs.point().geometricNormal;
        const double height = glm::dot(direction, out);
        return glm::normalize(direction + out * (std::max(std::abs(height), 1e-3) - height));
    }
};

LitSurface::LitSurface(const Textures& textures, const SurfacePoint& point, const Vec3& incoming,
                       double mirrorRoughness)
    : lobes_(std::make_unique<Lobes>(textures, point, incoming, mirrorRoughness)) {}

LitSurface::~LitSurface() = default;

bool LitSurface::unlit() const {
    return lobes_->inputs.material().isUnlit();
}

Vec3 LitSurface::baseColor() const {
    return Vec3(lobes_->inputs.baseColor());
}

Vec3 LitSurface::emission() const {
    return lobes_->emission;
}

Vec3 LitSurface::normal() const {
    return lobes_->frame[2];
}

Vec3 LitSurface::geometricNormal() const {
    return lobes_->side * lobes_->inputs.point().geometricNormal;
}

Vec3 LitSurface::scattered(const Vec3& toLight) const {
    // A lobe counts if its normal and the triangle agree on which side the light is.
    const Lobes& l = *lobes_;
    const Vec3 light = l.toFrame(toLight);
    const double height = glm::dot(geometricNormal(), toLight);
    const Vec3 base = light.z * height > 0.0 ? glsl::evaluateBase(l.bsdf, l.features(), light) : Vec3(0.0);
    return glsl::addLayersAbove(l.bsdf.layers, l.features(), l.bsdf.view, light, height, base);
}

Vec3 LitSurface::ambient(const GradientSky& sky) const {
    return lobes_->ambient(sky);
}

std::vector<Mirror> LitSurface::mirrors() const {
    const Lobes& l = *lobes_;
    std::vector<Mirror> mirrors;
    if (const double traced = l.tracedShare(l.roughness); traced > 0.0) {
        const Vec3 weight =
            glm::mix(glsl::fresnelSchlick(l.bsdf.base.f0, l.bsdf.base.f90, l.bsdf.view.z),
                     glsl::fresnelSchlick(l.bsdf.base.metalF0, 1.0, l.bsdf.view.z), l.bsdf.base.metallic) *
            (traced * l.baseShare());
        if (weight != Vec3(0.0)) {
            mirrors.push_back({l.mirrorDirection(l.frame[2]), weight});
        }
    }
    if (const double weight = l.tracedCoat() * l.coat(); weight > 0.0) {
        mirrors.push_back({l.mirrorDirection(l.frame * l.bsdf.layers.clearcoat.normal), Vec3(weight)});
    }
    return mirrors;
}

}  // namespace glint::oracle
