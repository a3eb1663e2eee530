#include "oracle/spec/sky.h"

#include "oracle/spec/directions.h"

#include <algorithm>
#include <cmath>

namespace glint::spec {
namespace {

// Columns about an axis whose x is as near to `along` as it can be.
glm::dmat3 frameAlong(const Vec3& axis, const Vec3& along) {
    const Vec3 x = glm::normalize(along - axis * glm::dot(axis, along));
    return {x, glm::cross(axis, x), axis};
}

}  // namespace

Vec3 Terms::sum() const {
    return specular + multiple + diffuse + diffuseTransmitted + transmitted + sheen + coat + emission;
}

Terms& Terms::operator+=(const Terms& other) {
    specular += other.specular;
    multiple += other.multiple;
    diffuse += other.diffuse;
    diffuseTransmitted += other.diffuseTransmitted;
    transmitted += other.transmitted;
    sheen += other.sheen;
    coat += other.coat;
    emission += other.emission;
    return *this;
}

Terms Terms::operator/(double count) const {
    return {specular / count,    multiple / count, diffuse / count, diffuseTransmitted / count,
            transmitted / count, sheen / count,    coat / count,    emission / count};
}

Surface::Surface(const Material& material, const Choices& choices, Albedos& albedos, const Point& point)
    : material_(material),
      meshNormal_(point.frame[2]),
      frame_(baseFrame(point)),
      bsdf_(material, choices, albedos, glm::transpose(frame_) * point.view,
            glm::transpose(frame_) * coatNormal(point)) {}

// glTF 2.0, section 3.9.3, and KHR_materials_anisotropy: the direction is in the space of the mesh's
// tangents.
glm::dmat3 Surface::baseFrame(const Point& point) const {
    const Vec3 normal = glm::normalize(point.frame * material_.normal);
    const Vec2& d = material_.anisotropyDirection;
    return frameAlong(normal, d.x * point.frame[0] + d.y * point.frame[1]);
}

// KHR_materials_clearcoat: without a texture of its own the coat has the mesh's normal.
Vec3 Surface::coatNormal(const Point& point) const {
    return glm::normalize(point.frame * material_.clearcoatNormal);
}

Vec3 Surface::integrateSpecular(const Map& map, int points) const {
    return midpoints(points, 2 * points, Vec3(0.0), [&](const Vec2& point) {
        const Direction d = reflectedDirection(bsdf_.view(), bsdf_.alpha(), point);
        return d.l.z > 0.0 ? bsdf_.specular(d.l) * world(map, d.l) * d.solidAngle : Vec3(0.0);
    });
}

Vec3 Surface::integrateCoat(const Map& map, int points) const {
    const glm::dmat3 coat = oracle::frameAbout(bsdf_.coatNormal());
    const Vec3 view = glm::transpose(coat) * bsdf_.view();
    if (material_.clearcoat <= 0.0 || view.z <= 0.0) {
        return Vec3(0.0);
    }
    return midpoints(points, 2 * points, Vec3(0.0), [&](const Vec2& point) {
        const Direction d = reflectedDirection(view, Vec2(bsdf_.coatAlpha()), point);
        const Vec3 l = coat * d.l;
        return d.solidAngle > 0.0 ? bsdf_.coat(l) * world(map, l) * d.solidAngle : Vec3(0.0);
    });
}

Vec3 Surface::integrateTransmitted(const Map& map, int points) const {
    if (material_.transmission <= 0.0) {
        return Vec3(0.0);
    }
    if (bsdf_.straight()) {
        return bsdf_.straightWeight() * world(map, -bsdf_.view());
    }
    const auto through = [&](double eta) {
        return midpoints(points, 2 * points, Vec3(0.0), [&](const Vec2& point) {
            Direction d;
            if (material_.volume) {
                d = refractedDirection(bsdf_.view(), bsdf_.alpha(), eta, point);
            } else {
                d = reflectedDirection(bsdf_.view(), bsdf_.alpha(), point);
                d.l.z = -d.l.z;
            }
            return d.l.z < 0.0 && d.solidAngle > 0.0 ? bsdf_.transmitted(d.l) * world(map, d.l) * d.solidAngle
                                                     : Vec3(0.0);
        });
    };
    const Vec3 iors = bsdf_.iors();
    Vec3 light = through(iors.y);
    if (material_.volume && material_.dispersion > 0.0) {
        light.x = through(iors.x).x;
        light.z = through(iors.z).z;
    }
    return light;
}

Terms Surface::underMap(const Map& map, const Quality& quality) const {
    const int points = quality.points;
    Terms terms = midpoints(points, 2 * points, Terms{}, [&](const Vec2& point) {
        const Direction d = cosineDirection(point);
        const Vec3 light = world(map, d.l) * d.solidAngle;
        const Vec3 far(d.l.x, d.l.y, -d.l.z);
        Terms here;
        here.multiple = bsdf_.multiple(d.l) * light;
        here.diffuse = bsdf_.diffuse(d.l) * light;
        here.sheen = bsdf_.sheen(d.l) * light;
        if (material_.diffuseTransmission > 0.0) {
            here.diffuseTransmitted = bsdf_.diffuseTransmitted(far) * world(map, far) * d.solidAngle;
        }
        return here;
    });
    terms.specular = integrateSpecular(map, points);
    terms.coat = integrateCoat(map, points);
    terms.transmitted = integrateTransmitted(map, points);
    // glTF 2.0, section 3.9.3: occlusion concerns light from all around, here that from outside.
    for (Vec3* outside : {&terms.specular, &terms.multiple, &terms.diffuse, &terms.sheen, &terms.coat}) {
        *outside *= material_.occlusion;
    }
    terms.emission = bsdf_.emission();
    return terms;
}

Vec3 Surface::underLights(std::span<const Light> lights) const {
    Vec3 sum = bsdf_.emission();
    for (const Light& light : lights) {
        const Vec3 l = glm::transpose(frame_) * light.direction;
        // Light that the mesh's surface and a lobe's normal see on different sides does not arrive.
        const double height = glm::dot(meshNormal_, light.direction);
        if (l.z * height > 0.0) {
            sum += bsdf_.base(l) * light.irradiance;
        }
        if (glm::dot(bsdf_.coatNormal(), l) * height > 0.0) {
            sum += bsdf_.coat(l) * light.irradiance;
        }
    }
    return sum;
}

// The map behind the surface where a smooth one would show it, as blurred as by a reflection.
Vec3 Surface::skyBehind(const Sky& sky) const {
    const Vec3 iors = bsdf_.iors();
    Vec3 light(0.0);
    for (int channel = 0; channel < 3; ++channel) {
        const double eta = material_.dispersion > 0.0 ? iors[channel] : iors.y;
        Vec3 direction = -bsdf_.view();
        if (material_.volume && !bsdf_.straight()) {
            const double cosine = bsdf_.view().z;
            const double refracted = std::sqrt(std::max(1.0 - (1.0 - cosine * cosine) / (eta * eta), 0.0));
            direction = glm::normalize(Vec3(-bsdf_.view().x / eta, -bsdf_.view().y / eta, -refracted));
        }
        light[channel] =
            levelMean(sky.map, toWorld(direction), std::sqrt(material_.alpha().x), sky.levels)[channel];
    }
    return light;
}

Terms Surface::underSky(const Sky& sky, const Quality& quality) const {
    const Vec3& view = bsdf_.view();
    const Vec3 mirror = toWorld(Vec3(-view.x, -view.y, view.z));
    const bool traced = sky.transport == Transport::Traced;
    const double roughness = std::sqrt(material_.alpha().x);
    const Bsdf::Albedo albedo = bsdf_.albedo();
    const double layers = (1.0 - bsdf_.coatWeight()) * bsdf_.belowSheenOfView();
    const double dielectric = (1.0 - material_.metallic) * (1.0 - material_.transmission);
    const double kept = material_.specularGlossiness ? 1.0 - largest(material_.specularColor) : 1.0;
    const auto around = [&](const Vec3& normal) {
        return traced && sky.diffuseRays ? cosineMean(sky.map, normal)
                                         : sky.harmonics.irradianceOverPi(normal);
    };
    const Vec3 normal = frame_[2];
    Terms terms;
    terms.diffuse = material_.baseColor * around(normal) *
                    (dielectric * (1.0 - material_.diffuseTransmission) * kept * albedo.below * layers);
    terms.diffuseTransmitted = material_.diffuseTransmissionColor *
                               glm::exp(-material_.absorption * material_.thickness) * around(-normal) *
                               (dielectric * material_.diffuseTransmission * albedo.below * layers);
    const Vec3 lobe = levelMean(sky.map, mirror, roughness, sky.levels);
    terms.multiple = (albedo.reflected - albedo.once) * lobe * layers;
    if (material_.anisotropy > 0.0) {
        // Directions of the lobe itself stand in for its integral; later bounces are taken to be diffuse.
        terms.multiple = (albedo.reflected - albedo.once) * around(normal) * layers;
        terms.specular = integrateSpecular(sky.map, quality.points);
    } else if (!traced) {
        terms.specular = albedo.once * lobe * layers;
    } else if (roughness <= sky.mirrorRoughness) {
        terms.specular = albedo.once * sky.map.at(mirror) * layers;
    } else {
        terms.specular = integrateSpecular(sky.map, quality.points);
    }
    if (material_.clearcoat > 0.0) {
        const Vec3& n = bsdf_.coatNormal();
        const Vec3 direction = toWorld(2.0 * glm::dot(n, view) * n - view);
        const double coatRoughness = std::sqrt(bsdf_.coatAlpha());
        if (!traced) {
            terms.coat = bsdf_.coatWeight() * levelMean(sky.map, direction, coatRoughness, sky.levels);
        } else if (coatRoughness <= sky.mirrorRoughness) {
            terms.coat = bsdf_.coatWeight() * sky.map.at(direction);
        } else {
            terms.coat = integrateCoat(sky.map, quality.points);
        }
    }
    terms.sheen = material_.sheenColor * sky.harmonics.irradianceOverPi(normal) *
                  (bsdf_.sheenAlbedoOfView() * (1.0 - bsdf_.coatWeight()));
    if (material_.transmission > 0.0) {
        if (traced) {
            terms.transmitted = integrateTransmitted(sky.map, quality.points);
            if (bsdf_.compensated()) {
                // What facets block leaves in the end as the rest does: the lobe keeps its shape, and all
                // that is not reflected passes.
                static const Map white(8, 4, [](const Vec3&) { return Vec3(1.0); });
                const Vec3 once = integrateTransmitted(white, quality.points);
                const Vec3 all = material_.baseColor * ((1.0 - material_.metallic) * material_.transmission *
                                                        layers * std::max(albedo.below, 0.0));
                for (int i = 0; i < 3; ++i) {
                    terms.transmitted[i] *= once[i] > 0.0 ? all[i] / once[i] : 0.0;
                }
            }
        } else {
            const Vec3 through = material_.baseColor * glm::exp(-material_.absorption * material_.thickness);
            const double lost = bsdf_.compensated() ? 0.0 : albedo.lost;
            terms.transmitted = through * skyBehind(sky) *
                                ((1.0 - material_.metallic) * material_.transmission * layers *
                                 std::max(albedo.below - lost, 0.0));
        }
    }
    terms.emission = bsdf_.emission();
    // Occlusion dims what comes from the map's means; rays find their own occluders.
    terms.multiple *= material_.occlusion;
    terms.sheen *= material_.occlusion;
    if (!traced) {
        terms.specular *= material_.occlusion;
        terms.coat *= material_.occlusion;
    }
    if (!traced || !sky.diffuseRays) {
        terms.diffuse *= material_.occlusion;
    }
    return terms;
}

}  // namespace glint::spec
