#include "oracle/reference.h"

#include "oracle/light.h"
#include "oracle/shading.h"

namespace glint::oracle {

Vec3 Reference::radiance(const Ray& ray, double mirrorRoughness) const {
    const std::optional<Hit> hit = world_.closest(ray, Faces::Culled);
    return hit ? surface(ray, *hit, mirrorRoughness) : Vec3(0.0);
}

Vec3 Reference::surface(const Ray& ray, const Hit& hit, double mirrorRoughness) const {
    const materials::Material& material = scene_.materials[static_cast<std::size_t>(hit.material)];
    const Shading shading(material, hit, ray.direction);
    if (shading.unlit()) {
        return shading.baseColor();
    }
    Vec3 result = shading.emission();
    for (const gltf::Light& light : scene_.lights) {
        if (!light.shown) {
            continue;
        }
        const LightCap cap = lightCap(light, {}, hit.position);
        const Vec3 reflected = shading.scattered(cap.direction) * irradianceFrom(light, hit.position);
        if (reflected != Vec3(0.0) && world_.visible({hit.position, cap.direction}, cap.centerDistance)) {
            result += reflected;
        }
    }
    if (material["roughnessFactor"] <= mirrorRoughness) {
        Vec3 direction;
        const Vec3 weight = shading.mirrored(direction);
        result += weight * radiance({hit.position, direction}, -1.0);
    }
    return result;
}

}  // namespace glint::oracle
