#include "oracle/refraction.h"

#include <algorithm>

namespace glint::oracle {
namespace {

// Follows one wavelength and takes every branch.
class Walk {
public:
    Walk(const World& world, const DielectricOf& dielectricOf, const HitRadiance& hitRadiance,
         const SkyRadiance& sky, const RefractionSettings& settings, int channel)
        : world_(world),
          dielectricOf_(dielectricOf),
          hitRadiance_(hitRadiance),
          sky_(sky),
          settings_(settings),
          channel_(channel) {}

    double radiance = 0.0;
    double square = 0.0;
    double left = 0.0;

    // Adds the light that a ray finds. `medium` is null in air. `chance` is the product of Fresnel's shares
    // since the first interface; `weight` is the absorption times the first interface's share.
    void follow(const Ray& ray, const Dielectric* medium, double chance, double weight, int interfaces) {
        const std::optional<Hit> hit = world_.closest(ray, Faces::All);
        if (hit && medium != nullptr) {
            weight *= std::exp(-medium->absorption[channel_] * hit->distance);
        }
        const Dielectric* surface = hit ? dielectricOf_(hit->material) : nullptr;
        if (surface == nullptr) {
            const double light = hit ? hitRadiance_(*hit, ray)[channel_] : sky_(ray.direction)[channel_];
            radiance += chance * weight * light;
            square += chance * weight * weight * light * light;
            return;
        }
        if (interfaces >= settings_.maxInterfaces || chance * weight < settings_.minWeight) {
            left += chance * weight;
            return;
        }
        const double from = medium != nullptr ? medium->ior[channel_] : 1.0;
        const double to = hit->front ? surface->ior[channel_] : 1.0;
        const Vec3 normal = hit->front ? hit->normal : -hit->normal;
        const double cosine = -glm::dot(ray.direction, normal);
        const double reflects = reflectance(settings_.fresnel, from, to, cosine, surface->schlickIor);
        const Vec3 mirrored = ray.direction + 2.0 * cosine * normal;
        follow({hit->position, mirrored}, medium, chance * reflects, weight, interfaces + 1);
        Vec3 onward;
        if (reflects < 1.0 && refracted(ray.direction, normal, from, to, onward)) {
            follow({hit->position, onward}, hit->front ? surface : nullptr, chance * (1.0 - reflects), weight,
                   interfaces + 1);
        }
    }

private:
    const World& world_;
    const DielectricOf& dielectricOf_;
    const HitRadiance& hitRadiance_;
    const SkyRadiance& sky_;
    const RefractionSettings& settings_;
    int channel_;
};

}  // namespace

double reflectance(Fresnel fresnel, double from, double to, double cosine, double schlickIor) {
    const double sine2 = squared(from / to) * (1.0 - cosine * cosine);
    if (sine2 >= 1.0) {
        return 1.0;
    }
    const double other = std::sqrt(1.0 - sine2);
    if (fresnel == Fresnel::Schlick) {
        const double f0 = schlickIor > 0.0 ? squared((schlickIor - 1.0) / (schlickIor + 1.0))
                                           : squared((to - from) / (to + from));
        const double thinner = from > to ? other : cosine;
        return f0 + (1.0 - f0) * std::pow(1.0 - thinner, 5.0);
    }
    const double parallel = (to * cosine - from * other) / (to * cosine + from * other);
    const double perpendicular = (from * cosine - to * other) / (from * cosine + to * other);
    return 0.5 * (squared(parallel) + squared(perpendicular));
}

bool refracted(const Vec3& direction, const Vec3& normal, double from, double to, Vec3& result) {
    const double cosine = -glm::dot(direction, normal);
    const Vec3 tangential = (from / to) * (direction + cosine * normal);
    const double sine2 = glm::dot(tangential, tangential);
    if (sine2 >= 1.0) {
        return false;
    }
    result = glm::normalize(tangential - std::sqrt(1.0 - sine2) * normal);
    return true;
}

Vec3 absorptionOf(const Vec3& attenuationColor, double attenuationDistance) {
    return -glm::log(attenuationColor) / attenuationDistance;
}

RefractedLight refractedLight(const World& world, const Ray& ray, const Hit& hit,
                              const DielectricOf& dielectricOf, const HitRadiance& hitRadiance,
                              const SkyRadiance& sky, const RefractionSettings& settings) {
    RefractedLight result;
    const Dielectric* medium = dielectricOf(hit.material);
    for (int channel = 0; channel < 3; ++channel) {
        Walk walk(world, dielectricOf, hitRadiance, sky, settings, channel);
        const double ior = medium->ior[channel];
        const double reflects =
            reflectance(settings.fresnel, 1.0, ior, -glm::dot(ray.direction, hit.normal), medium->schlickIor);
        Vec3 inward;
        if (refracted(ray.direction, hit.normal, 1.0, ior, inward)) {
            walk.follow({hit.position, inward}, medium, 1.0, 1.0 - reflects, 1);
        }
        result.radiance[channel] = walk.radiance;
        result.square[channel] = walk.square;
        result.left[channel] = walk.left;
    }
    return result;
}

}  // namespace glint::oracle
