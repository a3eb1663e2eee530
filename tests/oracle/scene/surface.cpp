#include "oracle/scene/surface.h"

#include "oracle/scene/lobes.h"

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
    // KHR_materials_anisotropy, implementation notes: the normal bends towards the view.
    Vec3 reflectedView() const {
        Vec3 normal = frame[2];
        if (has(GLINT_ANISOTROPY)) {
            const Vec3 across = glm::cross(glm::cross(frame[1], view), frame[1]);
            const double bend = (bsdf.alpha.x - bsdf.alpha.y) * (1.0 - squared(roughness));
            normal = glm::normalize(glm::mix(normal, glm::normalize(across), bend));
        }
        return glm::reflect(-view, normal);
    }
    // Returns the sky behind a thin wall, or where a volume bends the view to as it enters, with one index
    // for each channel.
    Vec3 skyBehind(const GradientSky& sky) const {
        Vec3 behind(0.0);
        for (int channel = 0; channel < 3; ++channel) {
            Vec3 direction = -bsdf.view;
            const double eta = bsdf.eta[channel];
            if (!has(GLINT_VOLUME) || !glsl::refracts(eta) ||
                glsl::refractDirection(bsdf.view, Vec3(0.0, 0.0, 1.0), eta, direction)) {
                behind[channel] = skyAround(sky, frame * direction, roughness)[channel];
            }
        }
        return behind;
    }
    Vec3 ambient(const GradientSky& sky) const {
        const Vec3 all = glsl::specularAlbedo(bsdf, features(), bsdf.viewLoss, bsdf.viewBias);
        const Vec3 first = glsl::singleScatterAlbedo(bsdf, features(), bsdf.viewLoss, bsdf.viewBias);
        const Vec3 passed3 = glsl::specularPassed(bsdf, bsdf.viewLoss, bsdf.viewBias);
        const double passed = std::max(std::min({passed3.x, passed3.y, passed3.z}), 0.0);
        const Vec3 n = frame[2];
        Vec3 result = (bsdf.diffuse * passed * diffuseSky(sky, n) +
                       (all - first * tracedShare(roughness)) * skyAround(sky, reflectedView(), roughness)) *
                      occlusion;
        if (has(GLINT_TRANSMISSION)) {
            result += bsdf.transmitted * skyBehind(sky) * passed;
        }
        if (has(GLINT_DIFFUSE_TRANSMISSION)) {
            result += bsdf.diffuseTransmitted * passed * diffuseSky(sky, -n);
        }
        result *= baseShare();
        if (has(GLINT_SHEEN)) {
            result += bsdf.sheenColor * std::min(bsdf.sheenAlbedo, 1.0) * diffuseSky(sky, n) *
                      (occlusion * (1.0 - coat()));
        }
        if (has(GLINT_CLEARCOAT)) {
            const Vec3 direction = glm::reflect(-view, frame * bsdf.clearcoatNormal);
            result += skyAround(sky, direction, std::sqrt(bsdf.clearcoatAlpha)) *
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
    return lobes_->inputs.material().unlit;
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
    Vec3 result(0.0);
    if (light.z * height > 0.0) {
        result = glsl::evaluateBelowCoat(l.bsdf, l.features(), light) * (1.0 - l.coat());
    }
    if (l.has(GLINT_CLEARCOAT) && height > 0.0) {
        result += glsl::evaluateCoat(l.bsdf, light);
    }
    return result;
}

Vec3 LitSurface::ambient(const GradientSky& sky) const {
    return lobes_->ambient(sky);
}

std::vector<Mirror> LitSurface::mirrors() const {
    const Lobes& l = *lobes_;
    std::vector<Mirror> mirrors;
    if (const double traced = l.tracedShare(l.roughness); traced > 0.0) {
        const Vec3 weight =
            glm::mix(glsl::fresnelSchlick(l.bsdf.f0, l.bsdf.f90, l.bsdf.view.z),
                     glsl::fresnelSchlick(l.bsdf.metalF0, 1.0, l.bsdf.view.z), l.bsdf.metallic) *
            (traced * l.baseShare());
        if (weight != Vec3(0.0)) {
            mirrors.push_back({l.mirrorDirection(l.frame[2]), weight});
        }
    }
    if (const double weight = l.tracedCoat() * l.coat(); weight > 0.0) {
        mirrors.push_back({l.mirrorDirection(l.frame * l.bsdf.clearcoatNormal), Vec3(weight)});
    }
    return mirrors;
}

}  // namespace glint::oracle
