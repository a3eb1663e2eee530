#include "oracle/scene/renderer.h"

#include "oracle/light.h"
#include "oracle/scene/inputs.h"

namespace glint::oracle {
namespace {

// Below this cosine, light and normals count as near a tangent plane.
constexpr double kGrazing = 1e-3;

// Rec. 709.
double luminanceOf(const Vec3& color) {
    return glm::dot(color, Vec3(0.2126, 0.7152, 0.0722));
}

CameraLight certainly(const Vec3& light) {
    return {light, Vec3(0.0), {light}};
}

void note(Path* path, const std::optional<SurfacePoint>& point) {
    if (path != nullptr) {
        path->triangles.push_back(point ? point->triangle : Path::kNothing);
        if (point) {
            path->materials.push_back(point->material);
        }
    }
}

}  // namespace

struct SceneRenderer::Direct {
    Vec3 unshadowed{0.0};
    bool visible = false;
};

SceneRenderer::SceneRenderer(const gltf::Scene& scene, const RendererSettings& settings)
    : textures_(scene, settings.srgb),
      settings_(settings),
      geometry_(scene,
                [this](const SurfacePoint& point) { return Inputs(textures_, point).passesAlphaMask(); }) {}

std::vector<SceneRenderer::Direct> SceneRenderer::directLights(const LitSurface& surface,
                                                               const Vec3& position, Path* path) const {
    std::vector<Direct> all;
    for (const gltf::Light& light : scene().lights) {
        if (!light.shown) {
            continue;
        }
        const LightCap cap = lightCap(light, {}, position);
        Direct direct{surface.scattered(cap.direction) * irradianceFrom(light, position), false};
        if (path != nullptr) {
            path->grazing = path->grazing || std::abs(glm::dot(surface.normal(), cap.direction)) < kGrazing ||
                            std::abs(glm::dot(surface.geometricNormal(), cap.direction)) < kGrazing;
        }
        if (luminanceOf(direct.unshadowed) > 0.0) {
            direct.visible = geometry_.visible({position, cap.direction}, cap.centerDistance);
            all.push_back(direct);
            if (path != nullptr) {
                path->visible.push_back(direct.visible);
            }
        }
    }
    return all;
}

CameraLight SceneRenderer::seenInMirror(const Ray& ray, Path* path) const {
    const std::optional<SurfacePoint> point = geometry_.closest(ray);
    note(path, point);
    if (!point) {
        return certainly(settings_.sky(ray.direction));
    }
    const LitSurface surface(textures_, *point, ray.direction, -1.0);
    if (surface.unlit()) {
        return certainly(surface.baseColor());
    }
    const Vec3 certain = surface.emission() + surface.ambient(settings_.sky);
    double total = 0.0;
    const std::vector<Direct> lights = directLights(surface, point->position, path);
    for (const Direct& light : lights) {
        total += luminanceOf(light.unshadowed);
    }
    if (lights.empty()) {
        return certainly(certain);
    }
    CameraLight result{certain, Vec3(0.0)};
    Vec3 square(0.0);
    for (const Direct& light : lights) {
        const Vec3 reaching = light.visible ? light.unshadowed : Vec3(0.0);
        const double chance = luminanceOf(light.unshadowed) / total;
        result.mean += reaching;
        square += reaching * reaching / chance;
        if (path != nullptr) {
            result.outcomes.push_back(certain + reaching / chance);
        }
    }
    const Vec3 sum = result.mean - certain;
    result.variance = glm::max(square - sum * sum, Vec3(0.0));
    return result;
}

CameraLight SceneRenderer::radiance(const Ray& ray, Path* path) const {
    const std::optional<SurfacePoint> point = geometry_.closest(ray);
    note(path, point);
    if (!point) {
        return certainly(settings_.sky(ray.direction));
    }
    const LitSurface surface(textures_, *point, ray.direction, settings_.mirrorRoughness);
    if (path != nullptr) {
        path->grazing = glm::dot(surface.normal(), -ray.direction) < kGrazing;
    }
    if (surface.unlit()) {
        return certainly(surface.baseColor());
    }
    Vec3 certain = surface.emission() + surface.ambient(settings_.sky);
    for (const Direct& light : directLights(surface, point->position, path)) {
        certain += light.visible ? light.unshadowed : Vec3(0.0);
    }
    CameraLight result = reflected(surface.mirrors(), point->position, path);
    result.mean += certain;
    for (Vec3& outcome : result.outcomes) {
        outcome += certain;
    }
    return result;
}

CameraLight SceneRenderer::reflected(const std::vector<Mirror>& mirrors, const Vec3& position,
                                     Path* path) const {
    // The cosine of the angle within which one ray serves coat and base.
    constexpr double kTogether = 0.99996;
    Vec3 weights(0.0);
    bool together = true;
    for (const Mirror& mirror : mirrors) {
        weights += mirror.weight;
        together = together && glm::dot(mirror.direction, mirrors.front().direction) > kTogether;
    }
    CameraLight result;
    Vec3 square(0.0);  // of a ray for each
    for (const Mirror& mirror : mirrors) {
        const CameraLight seen = seenInMirror({position, mirror.direction}, path);
        const double chance = luminanceOf(mirror.weight) / luminanceOf(weights);
        result.mean += mirror.weight * seen.mean;
        square += mirror.weight * mirror.weight * (seen.variance + seen.mean * seen.mean) / chance;
        result.variance = glm::max(result.variance, weights * weights * seen.variance);
        for (const Vec3& outcome : seen.outcomes) {
            result.outcomes.push_back((together ? weights : mirror.weight / chance) * outcome);
        }
    }
    if (!together) {
        result.variance = glm::max(square - result.mean * result.mean, Vec3(0.0));
    }
    return result;
}

}  // namespace glint::oracle
