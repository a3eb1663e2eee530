#include "oracle/transport/path_surface.h"

#include "oracle/scene/lobes.h"

namespace glint::oracle {

struct PathSurface::Lobes {
    Surroundings around;
    SurfaceLobes surface;

    Lobes(const Textures& textures, const SurfacePoint& point, const Vec3& incoming,
          const Surroundings& given)
        : around(given), surface(textures, point, incoming, -1.0, &around) {}
};

PathSurface::PathSurface(const Textures& textures, const SurfacePoint& point, const Vec3& incoming,
                         const Vec3& outsideIor, bool nested)
    : lobes_(std::make_unique<Lobes>(textures, point, incoming, Surroundings{outsideIor, nested})) {}

PathSurface::~PathSurface() = default;

bool PathSurface::unlit() const {
    return lobes_->surface.inputs.material().isUnlit();
}

Vec3 PathSurface::baseColor() const {
    return Vec3(lobes_->surface.inputs.baseColor());
}

Vec3 PathSurface::emission() const {
    return lobes_->surface.emission;
}

Vec3 PathSurface::scattered(const Vec3& toLight) const {
    // A lobe counts if its normal and the triangle agree on which side the light is.
    const SurfaceLobes& l = lobes_->surface;
    const Vec3 light = l.toFrame(toLight);
    const double height = glm::dot(geometricNormal(), toLight);
    const Vec3 base = light.z * height > 0.0 ? glsl::evaluateBase(l.bsdf, l.features(), light) : Vec3(0.0);
    return glsl::addLayersAbove(l.bsdf.layers, l.features(), l.bsdf.view, light, height, base);
}

double PathSurface::density(const Vec3& direction) const {
    const SurfaceLobes& l = lobes_->surface;
    return glsl::bsdfPdf(l.bsdf, l.features(), l.toFrame(direction));
}

PathSample PathSurface::sample(const Vec3& point, bool reflectsBelow) const {
    const SurfaceLobes& l = lobes_->surface;
    const glsl::BsdfSample chosen = glsl::sampleBsdf(l.bsdf, l.features(), point);
    if (!(chosen.pdf > 0.0)) {
        return {};
    }
    PathSample result;
    result.direction = glm::normalize(l.frame * chosen.direction);
    result.density = chosen.pdf;
    result.weight = scattered(result.direction) / chosen.pdf;
    const double height = glm::dot(result.direction, geometricNormal());
    // A layer with a normal of its own reflects light to the far side of the base, too.
    using namespace glsl;  // transmits() is a macro
    const bool passes = chosen.direction.z < 0.0 && transmits(l.features());
    if (reflectsBelow && (passes ? height > 0.0 : height < 0.0)) {
        result.below = true;
        result.direction -= 2.0 * height * geometricNormal();
        result.weight = chosen.weight;
    }
    return result;
}

bool PathSurface::clear() const {
    return !unlit() && lobes_->surface.has(GLINT_TRANSMISSION);
}

bool PathSurface::volume() const {
    return !unlit() && lobes_->surface.has(GLINT_VOLUME);
}

Vec3 PathSurface::straightThrough() const {
    const SurfaceLobes& l = lobes_->surface;
    return l.bsdf.base.transmitted *
           (glsl::schlickPassed(l.bsdf.base.f0, l.bsdf.base.f90, l.bsdf.view.z) * l.baseShare());
}

Vec3 PathSurface::geometricNormal() const {
    return lobes_->surface.side * lobes_->surface.inputs.point().geometricNormal;
}

}  // namespace glint::oracle
