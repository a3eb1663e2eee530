#include "quadrature.h"

#include <cmath>
#include <numbers>

namespace glint::numerics {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kHalfTurn = std::numbers::pi;

// Samples a visible GGX normal with a warped disc: Heitz, "Sampling the GGX Distribution of Visible Normals"
// (2018).
dvec3 visibleNormal(const dvec3& v, const dvec2& alpha, double u1, double u2) {
    const dvec3 stretched = glm::normalize(dvec3(alpha.x * v.x, alpha.y * v.y, v.z));
    const double across = std::hypot(stretched.x, stretched.y);
    const dvec3 t1 = across > 0.0 ? dvec3(-stretched.y, stretched.x, 0.0) / across : dvec3(1.0, 0.0, 0.0);
    const dvec3 t2 = glm::cross(stretched, t1);
    const double radius = std::sqrt(u1);
    const double x = radius * std::cos(2.0 * kHalfTurn * u2);
    const double half = 0.5 * (1.0 + stretched.z);
    const double y = (1.0 - half) * std::sqrt(1.0 - x * x) + half * radius * std::sin(2.0 * kHalfTurn * u2);
    const dvec3 n = x * t1 + y * t2 + std::sqrt(std::max(0.0, 1.0 - x * x - y * y)) * stretched;
    return glm::normalize(dvec3(alpha.x * n.x, alpha.y * n.y, std::max(n.z, 1e-12)));
}

// The density of visibleNormal(): G₁(v) D(h) (v·h) / (n·v), with the tangents of Walter et al. 2007.
double visibleNormalDensity(const dvec3& v, const dvec3& h, const dvec2& alpha) {
    const double vDotH = glm::dot(v, h);
    if (h.z <= 0.0 || vDotH <= 0.0) {
        return 0.0;
    }
    const double slopeX = h.x / (h.z * alpha.x);
    const double slopeY = h.y / (h.z * alpha.y);
    const double slopes = 1.0 + slopeX * slopeX + slopeY * slopeY;
    const double cosine4 = h.z * h.z * h.z * h.z;
    const double distribution = 1.0 / (kHalfTurn * alpha.x * alpha.y * cosine4 * slopes * slopes);
    const double viewX = alpha.x * v.x;
    const double viewY = alpha.y * v.y;
    // G₁ / (n·v), with n·v multiplied in.
    const double masking = 2.0 / (v.z + std::sqrt(v.z * v.z + viewX * viewX + viewY * viewY));
    return masking * distribution * vDotH;
}

// The golden points of the plane (Roberts 2018), which are even for any number of points.
dvec2 golden(int index) {
    constexpr double kPlastic = 1.32471795724474602596;
    const double n = index + 0.5;
    return {glm::fract(0.5 + n / kPlastic), glm::fract(0.5 + n / (kPlastic * kPlastic))};
}

glm::dmat3 frameOf(const dvec3& normal) {
    const dvec3 helper = std::abs(normal.x) < 0.7 ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 1.0, 0.0);
    const dvec3 tangent = glm::normalize(helper - normal * glm::dot(helper, normal));
    return {tangent, glm::cross(normal, tangent), normal};
}

dvec3 mirrored(const dvec3& v) {
    return {v.x, v.y, -v.z};
}

}  // namespace

dvec3 direction(double cosine, double phi) {
    const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

void Quadrature::addReflection(const dvec2& alpha, const dvec3& normal) {
    const glm::dmat3 frame = normal.z >= 1.0 ? glm::dmat3(1.0) : frameOf(normal);
    const dvec3 view = view_ * frame;
    if (view.z > 0.0) {
        places_.push_back({Kind::Reflection, alpha, 1.0, frame, view});
    }
}

void Quadrature::addThinTransmission(const dvec2& alpha) {
    places_.push_back({Kind::ThinTransmission, alpha, 1.0, glm::dmat3(1.0), view_});
}

void Quadrature::addRefraction(const dvec2& alpha, double eta) {
    places_.push_back({Kind::Refraction, alpha, eta, glm::dmat3(1.0), view_});
}

double Quadrature::density(const Place& place, const dvec3& light) {
    const dvec3 l = place.kind == Kind::ThinTransmission ? mirrored(light) : light * place.frame;
    if (place.kind == Kind::Refraction) {
        dvec3 h = place.view + place.eta * l;
        const double size = glm::length(h);
        h *= (h.z < 0.0 ? -1.0 : 1.0) / size;
        const double lDotH = -glm::dot(l, h);
        return lDotH > 0.0 ? visibleNormalDensity(place.view, h, place.alpha) * place.eta * place.eta *
                                 lDotH / (size * size)
                           : 0.0;
    }
    const dvec3 sum = place.view + l;
    const double size = glm::length(sum);
    if (size <= 0.0 || sum.z <= 0.0) {
        return 0.0;
    }
    return visibleNormalDensity(place.view, sum / size, place.alpha) / (2.0 * size);  // v·h = |v + l| / 2
}

dvec3 Quadrature::sample(const Place& place, double u1, double u2) {
    const dvec3 h = visibleNormal(place.view, place.alpha, u1, u2);
    const double cosine = glm::dot(place.view, h);
    if (place.kind == Kind::Refraction) {
        const double squared = 1.0 - (1.0 - cosine * cosine) / (place.eta * place.eta);
        return squared > 0.0 ? (cosine / place.eta - std::sqrt(squared)) * h - place.view / place.eta
                             : dvec3(0.0);
    }
    const dvec3 l = 2.0 * cosine * h - place.view;
    return place.kind == Kind::ThinTransmission ? mirrored(l) : place.frame * l;
}

double Quadrature::density(const dvec3& light) const {
    double sum = std::abs(light.z) / kHalfTurn;
    for (const Place& place : places_) {
        sum += density(place, light);
    }
    return sum;
}

dvec3 Quadrature::integrate(const std::function<dvec3(const dvec3&)>& f, int points) const {
    dvec3 sum(0.0);
    const auto add = [&](const dvec3& light) {
        if (light.z != 0.0) {
            sum += f(light) / density(light);
        }
    };
    for (int i = 0; i < points; ++i) {
        const dvec2 u = golden(i);
        for (const double side : {1.0, -1.0}) {
            const double radius = std::sqrt(u.x);
            const double phi = 2.0 * kHalfTurn * u.y;
            add({radius * std::cos(phi), radius * std::sin(phi), side * std::sqrt(1.0 - u.x)});
        }
        for (const Place& place : places_) {
            add(sample(place, u.x, u.y));
        }
    }
    return sum / static_cast<double>(points);
}

}  // namespace glint::numerics
