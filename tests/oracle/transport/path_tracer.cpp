#include "oracle/transport/path_tracer.h"

#include "oracle/scene/inputs.h"

#include <algorithm>

namespace glint::oracle {
namespace {

// Lights beyond this number are chosen at random, this many at each vertex.
constexpr std::size_t kLampsAtOnce = 8;
// Below this throughput a path without roulette ends; the light that is lost is this share of the brightest.
constexpr double kLeastThroughput = 1e-9;
// Light that is trapped between interfaces of glass ends after so many.
constexpr std::uint32_t kMostInterfaces = 1000;
// A ray to a place of a light ends this share of the distance before it.
constexpr double kBeforeLight = 1e-7;

double largestOf(const Vec3& v) {
    return std::max({v.x, v.y, v.z});
}

// Veach's power heuristic with exponent 2, for the strategy with the first density. An infinite density is
// that of a single direction.
double powerWeight(double own, double other) {
    if (other <= 0.0) {
        return 1.0;
    }
    const double ratio = other / own;
    return 1.0 / (1.0 + ratio * ratio);
}

Vec3 cubePoint(Random& random) {
    const double x = random.next();
    const double y = random.next();
    return {x, y, random.next()};
}

double solidAngleOf(double halfAngle) {
    return 4.0 * kPi * squared(std::sin(0.5 * halfAngle));
}

}  // namespace

// The state of a path between two surfaces.
struct PathTracer::Walk {
    Ray ray;
    Vec3 throughput{1.0};
    Media media;
    Vec3 from{0.0};  // the surface that chose the direction
    double density =
        0.0;  // with which it did; 0: the camera, or light that no surface could have chosen instead
    bool overBlend = false;  // the ray has passed a surface of BLEND since
    // With ShadowThrough::Glass: a surface behind the glass has chosen light through it on a straight line.
    bool covered = false;
    bool throughGlass = false;  // the ray has passed glass since that surface
};

// A surface at which light is gathered.
struct PathTracer::Vertex {
    const SurfacePoint& point;
    const PathSurface& surface;
    const Media& media;  // in which the path arrived
    bool covered;        // as in Walk

    bool beyond(const Vec3& direction) const {
        return glm::dot(direction, surface.geometricNormal()) < 0.0;
    }
    // Returns whether the surface only passes light on in a direction: through clear glass, or within it.
    bool passesOn(const Vec3& direction) const {
        return surface.clear() && (beyond(direction) || (surface.volume() && !point.front));
    }
};

PathTracer::PathTracer(const gltf::Scene& scene, PathSky sky, const PathSettings& settings)
    : textures_(scene, settings.srgb),
      sky_(std::move(sky)),
      settings_(settings),
      geometry_(scene,
                [this](const SurfacePoint& point) { return Inputs(textures_, point).passesAlphaMask(); }),
      emissive_(scene, geometry_) {
    for (const materials::Material& material : scene.materials) {
        media_.push_back(mediumOf(material));
    }
    for (const gltf::Light& light : scene.lights) {
        if (light.shines()) {
            lamps_.push_back(&light);
        }
    }
}

double PathTracer::alphaAt(const SurfacePoint& point) const {
    const materials::Material& material = scene().materials[static_cast<std::size_t>(point.material)];
    return material.alphaMode == materials::AlphaMode::Blend
               ? std::clamp(Inputs(textures_, point).baseColor().a, 0.0, 1.0)
               : 1.0;
}

LightCap PathTracer::capOf(const gltf::Light& light, const Vec3& position) const {
    return lightCap(light, settings_.sizes, position);
}

// Goes to the next surface that the path meets. Surfaces of BLEND are there with the probability of their
// alpha.
std::optional<SurfacePoint> PathTracer::next(Walk& walk, Random& random, PathNotes* notes) const {
    for (;;) {
        const std::optional<SurfacePoint> point =
            geometry_.closest(walk.ray, walk.media.empty() ? Backs::None : Backs::OfVolumes, kInfinity);
        walk.throughput *= walk.media.transmittance(point ? point->distance : kInfinity);
        if (!point) {
            return std::nullopt;
        }
        const double alpha = alphaAt(*point);
        if (notes != nullptr && alpha < 1.0) {
            notes->blended = true;
        }
        if (alpha >= 1.0 || random.next() < alpha) {
            return point;
        }
        walk.ray.origin = point->position;
        walk.overBlend = true;
    }
}

PathTracer::Arrival PathTracer::arriving(const Vertex& vertex, const Vec3& direction, double distance,
                                         Backs backs) const {
    const bool ownGlass = vertex.passesOn(direction);
    if (ownGlass && vertex.covered) {
        return {};
    }
    Media media = vertex.media;
    if (vertex.beyond(direction) && vertex.surface.volume()) {
        media.cross(vertex.point);
    }
    // The path itself follows what its own glass passes on.
    const bool throughGlass = settings_.shadowThrough == ShadowThrough::Glass && !ownGlass;
    Arrival arrival{Vec3(1.0), false};
    Ray ray{vertex.point.position, direction};
    for (;;) {
        const Backs seen = backs == Backs::None && !media.empty() ? Backs::OfVolumes : backs;
        const std::optional<SurfacePoint> point = geometry_.closest(ray, seen, distance);
        arrival.share *= media.transmittance(point ? point->distance : distance);
        if (!point) {
            return arrival;
        }
        const double alpha = settings_.shadowThrough == ShadowThrough::Opaque ? 1.0 : alphaAt(*point);
        Vec3 passed(1.0 - alpha);
        if (throughGlass && alpha > 0.0) {
            bool nested = false;
            const Vec3 outside = media.outside(*point, nested);
            const PathSurface surface(textures_, *point, direction, outside, nested);
            if (surface.clear()) {
                passed += alpha * surface.straightThrough();
                arrival.throughGlass = true;
                if (surface.volume()) {
                    media.cross(*point);
                }
            }
        }
        arrival.share *= passed;
        if (arrival.share == Vec3(0.0)) {
            return {};
        }
        ray.origin = point->position;
        distance -= point->distance;
    }
}

Vec3 PathTracer::lampLight(const Vertex& vertex, const gltf::Light& light, Random& random) const {
    const LightCap cap = capOf(light, vertex.point.position);
    Vec3 direction = cap.direction;
    double density = 0.0;
    if (cap.halfAngle > 0.0) {
        const double x = random.next();
        direction = frameAbout(cap.direction) * capDirection({x, random.next()}, cap.halfAngle);
        density = 1.0 / solidAngleOf(cap.halfAngle);
    }
    const Vec3 scattered = vertex.surface.scattered(direction);
    if (scattered == Vec3(0.0)) {
        return Vec3(0.0);
    }
    const Arrival arrival = arriving(vertex, direction, cap.distanceAlong(direction), Backs::All);
    if (arrival.share == Vec3(0.0)) {
        return Vec3(0.0);
    }
    const double weight = density > 0.0 ? powerWeight(density, vertex.surface.density(direction)) : 1.0;
    return weight * cap.overFacing() * scattered * arrival.share *
           irradianceFrom(light, vertex.point.position);
}

Vec3 PathTracer::lampsFound(const Vertex& vertex, const PathSample& sample) const {
    Vec3 sum(0.0);
    if (settings_.sizes.radius <= 0.0 && settings_.sizes.sunDiameter <= 0.0) {
        return sum;
    }
    for (const gltf::Light* light : lamps_) {
        const LightCap cap = capOf(*light, vertex.point.position);
        if (cap.halfAngle <= 0.0 || glm::dot(cap.direction, sample.direction) < std::cos(cap.halfAngle)) {
            continue;
        }
        // lampLight() weighs as if it always took this light, too.
        const double density = 1.0 / solidAngleOf(cap.halfAngle);
        const Arrival arrival =
            arriving(vertex, sample.direction, cap.distanceAlong(sample.direction), Backs::All);
        sum += (powerWeight(sample.density, density) * density * cap.overFacing()) * sample.weight *
               arrival.share * irradianceFrom(*light, vertex.point.position);
    }
    return sum;
}

Vec3 PathTracer::triangleLight(const Vertex& vertex, Random& random) const {
    const EmissiveTriangles::Place place = emissive_.sample(cubePoint(random));
    const SurfacePoint at = geometry_.pointAt(place.triangle, place.u, place.v, Vec3(0.0, 0.0, 1.0));
    const Vec3 to = at.position - vertex.point.position;
    const double distance = glm::length(to);
    if (distance <= 0.0) {
        return Vec3(0.0);
    }
    const Vec3 direction = to / distance;
    const SurfacePoint seen = geometry_.pointAt(place.triangle, place.u, place.v, direction);
    const double cosine = std::abs(glm::dot(seen.geometricNormal, direction));
    if ((!seen.front && !geometry_.triangle(place.triangle).doubleSided) || cosine <= 0.0 ||
        !geometry_.exists(seen)) {
        return Vec3(0.0);
    }
    const Vec3 scattered = vertex.surface.scattered(direction);
    const double alpha = alphaAt(seen);
    if (scattered == Vec3(0.0) || alpha <= 0.0) {
        return Vec3(0.0);
    }
    const Arrival arrival = arriving(vertex, direction, distance * (1.0 - kBeforeLight), Backs::None);
    if (arrival.share == Vec3(0.0)) {
        return Vec3(0.0);
    }
    const PathSurface light(textures_, seen, direction, Vec3(1.0), false);
    const double density = emissive_.density(place.triangle) * distance * distance / cosine;
    const double weight =
        arrival.throughGlass ? 1.0 : powerWeight(density, vertex.surface.density(direction));
    return (weight * alpha / density) * scattered * arrival.share * light.emission();
}

Vec3 PathTracer::skyLight(const Vertex& vertex, Random& random) const {
    const Vec3 direction = sky_.sample(cubePoint(random));
    const Vec3 scattered = vertex.surface.scattered(direction);
    if (scattered == Vec3(0.0)) {
        return Vec3(0.0);
    }
    const Arrival arrival = arriving(vertex, direction, kInfinity, Backs::None);
    if (arrival.share == Vec3(0.0)) {
        return Vec3(0.0);
    }
    const double density = sky_.density(direction);
    const double weight =
        arrival.throughGlass ? 1.0 : powerWeight(density, vertex.surface.density(direction));
    return (weight / density) * scattered * arrival.share * sky_.radiance(direction);
}

Vec3 PathTracer::chosenLight(const Vertex& vertex, Random& random) const {
    Vec3 sum(0.0);
    if (lamps_.size() <= kLampsAtOnce) {
        for (const gltf::Light* light : lamps_) {
            sum += lampLight(vertex, *light, random);
        }
    } else {
        const double scale = static_cast<double>(lamps_.size()) / static_cast<double>(kLampsAtOnce);
        for (std::size_t i = 0; i < kLampsAtOnce; ++i) {
            const auto chosen = static_cast<std::size_t>(random.next() * static_cast<double>(lamps_.size()));
            sum += scale * lampLight(vertex, *lamps_[chosen], random);
        }
    }
    if (!emissive_.empty()) {
        sum += triangleLight(vertex, random);
    }
    if (!sky_.black()) {
        sum += skyLight(vertex, random);
    }
    return sum;
}

// The emission of a surface that a path finds. The surface before could have chosen it, unless rays to lights
// do not pass what the path has passed.
Vec3 PathTracer::emitted(const Walk& walk, const SurfacePoint& point, const PathSurface& surface) const {
    const Vec3 emission = surface.emission();
    if (emission == Vec3(0.0) || (walk.covered && walk.throughGlass)) {
        return Vec3(0.0);
    }
    if (walk.density <= 0.0 || (walk.overBlend && settings_.shadowThrough == ShadowThrough::Opaque)) {
        return emission;
    }
    const Vec3 to = point.position - walk.from;
    const double cosine = std::abs(glm::dot(point.geometricNormal, walk.ray.direction));
    const double density = emissive_.density(point.triangle) * glm::dot(to, to) / std::max(cosine, 1e-300);
    return powerWeight(walk.density, density) * emission;
}

Vec3 PathTracer::skyAlong(const Walk& walk) const {
    const Vec3 light = sky_.radiance(walk.ray.direction);
    if (light == Vec3(0.0) || (walk.covered && walk.throughGlass)) {
        return Vec3(0.0);
    }
    if (walk.density <= 0.0 || (walk.overBlend && settings_.shadowThrough == ShadowThrough::Opaque)) {
        return light;
    }
    return powerWeight(walk.density, sky_.density(walk.ray.direction)) * light;
}

Vec3 PathTracer::radiance(const Ray& ray, Random& random, PathNotes* notes) const {
    Walk walk{.ray = ray, .media = Media(media_)};
    Vec3 sum(0.0);
    std::uint32_t bounces = 0;     // surfaces that scattered the path, clear glass left out
    std::uint32_t interfaces = 0;  // of clear glass in a row
    for (std::uint32_t scatterings = 0;; ++scatterings) {
        const std::optional<SurfacePoint> point = next(walk, random, notes);
        if (!point) {
            return sum + walk.throughput * skyAlong(walk);
        }
        bool nested = false;
        const Vec3 outside = walk.media.outside(*point, nested);
        const PathSurface surface(textures_, *point, walk.ray.direction, outside, nested);
        if (notes != nullptr) {
            notes->material = notes->material < 0 ? point->material : notes->material;
            notes->glass = notes->glass || surface.clear();
        }
        if (surface.unlit()) {
            return sum + walk.throughput * surface.baseColor();
        }
        sum += walk.throughput * emitted(walk, *point, surface);
        // The last ray only looks for light, beyond glass, too.
        const bool last = settings_.bounces != kUnlimited && bounces > settings_.bounces;
        if (last && !surface.clear()) {
            return sum;
        }
        const Vertex vertex{*point, surface, walk.media, walk.covered};
        if (!last) {
            sum += walk.throughput * chosenLight(vertex, random);
        }

        const PathSample sample = surface.sample(cubePoint(random), settings_.reflectsBelow);
        if (sample.density <= 0.0 || sample.weight == Vec3(0.0)) {
            return sum;
        }
        const bool passesOn = vertex.passesOn(sample.direction);
        if ((last && !passesOn) || (passesOn && ++interfaces > kMostInterfaces)) {
            return sum;
        }
        if (!last && !sample.below) {
            sum += walk.throughput * lampsFound(vertex, sample);
        }
        if (!passesOn) {
            ++bounces;
            interfaces = 0;
        }
        if (settings_.shadowThrough == ShadowThrough::Glass) {
            walk.throughGlass = passesOn;
            walk.covered = walk.covered || !passesOn;
        }
        if (vertex.beyond(sample.direction) && surface.volume()) {
            walk.media.cross(*point);
        }
        walk.throughput *= sample.weight;
        // No ray to a light has this light.
        walk.density = last || sample.below ? 0.0 : sample.density;
        walk.from = point->position;
        walk.overBlend = false;
        walk.ray = {point->position, sample.direction};
        if (largestOf(walk.throughput) < kLeastThroughput) {
            return sum;
        }
        if (scatterings + 1 >= settings_.rouletteFrom) {
            const double goesOn = std::clamp(largestOf(walk.throughput), 0.05, 0.95);
            if (random.next() >= goesOn) {
                return sum;
            }
            walk.throughput /= goesOn;
        }
    }
}

}  // namespace glint::oracle
