// Compares Fresnel reflectance, refraction, volumes and films with the laws of optics.
#include "materials.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace glint::numerics {
namespace {

constexpr std::array kIors{1.0, 1.0 + 1e-7, 1.0001, 1.01, 1.33, 1.5, 2.42, 3.0};
constexpr glm::dvec3 kUp(0.0, 0.0, 1.0);

// Returns the square with its error, as the functions of an interface take it.
glm::dvec2 squared(double cosine) {
    return glsl::exactSquare(glm::dvec2(cosine, 0.0));
}

TEST(Fresnel, SchlickHasItsEnds) {
    const glm::dvec3 f0(0.04, 0.5, 1.0);
    EXPECT_EQ(glsl::fresnelSchlick(f0, 1.0, 1.0), f0);
    EXPECT_EQ(glsl::fresnelSchlick(f0, 1.0, 0.0), glm::dvec3(1.0));
    EXPECT_EQ(glsl::fresnelSchlick(f0, 0.25, 0.0), glm::dvec3(0.25));
}

TEST(Fresnel, DielectricsAtNormalIncidence) {
    EXPECT_NEAR(glsl::dielectricF0(1.5), 0.04, 1e-15);
    EXPECT_NEAR(glsl::dielectricF0(1.33), 0.020059, 1e-6);
    EXPECT_EQ(glsl::dielectricF0(1.0), 0.0);
    EXPECT_EQ(glsl::dielectricF0(0.0), 1.0);
}

TEST(Fresnel, WhatPassesIsWhatIsNotReflected) {
    for (const double eta : {0.4, 0.75, 1.0, 1.5}) {
        for (int step = 0; step <= 64; ++step) {
            const double cosine = step / 64.0;
            const glm::dvec3 f0(0.04, 0.2, 0.1);
            const double reflected = glsl::largest(glsl::fresnelInterface(f0, 1.0, squared(cosine), eta));
            EXPECT_NEAR(glsl::interfacePassed(f0, 1.0, squared(cosine), eta), 1.0 - reflected, 1e-14)
                << "eta " << eta << ", cosine " << cosine;
        }
    }
}

TEST(Refraction, FollowsSnell) {
    for (const double ior : kIors) {
        for (const double eta : {ior, 1.0 / ior}) {
            for (int step = 0; step < 32; ++step) {
                const double sine = step / 32.0;
                const double sineBeyond = sine / eta;
                glm::dvec3 l(0.0);
                const glm::dvec3 view(sine, 0.0, std::sqrt(1.0 - sine * sine));
                ASSERT_EQ(glsl::refractDirection(view, kUp, eta, l), sineBeyond < 1.0)
                    << "eta " << eta << ", sine " << sine;
                if (sineBeyond < 1.0) {
                    EXPECT_NEAR(l.x, -sineBeyond, 1e-12) << "eta " << eta << ", sine " << sine;
                    EXPECT_NEAR(l.y, 0.0, 1e-15);
                    EXPECT_LT(l.z, 0.0);
                }
            }
        }
    }
}

// Tests both sides of the critical angle, as close as double precision allows.
TEST(Refraction, EndsAtTheCriticalAngle) {
    for (const double ior : {1.01, 1.33, 1.5, 2.42, 3.0}) {
        const double eta = 1.0 / ior;
        const double critical = std::sqrt((1.0 - eta) * (1.0 + eta));
        for (const double step : {1e-3, 1e-6, 1e-9, 1e-12}) {
            const double passing = critical * (1.0 + step);
            const double reflecting = critical * (1.0 - step);
            const glm::dvec3 f0(glsl::dielectricF0(ior));
            EXPECT_GT(glsl::refractedCosine2(squared(passing), eta), 0.0) << ior << ' ' << step;
            EXPECT_LT(glsl::refractedCosine2(squared(reflecting), eta), 0.0) << ior << ' ' << step;
            EXPECT_LT(glsl::fresnelInterface(f0, 1.0, squared(passing), eta).x, 1.0) << ior << ' ' << step;
            EXPECT_EQ(glsl::fresnelInterface(f0, 1.0, squared(reflecting), eta).x, 1.0) << ior << ' ' << step;
            EXPECT_EQ(glsl::interfacePassed(f0, 1.0, squared(reflecting), eta), 0.0) << ior << ' ' << step;
            glm::dvec3 l(0.0);
            EXPECT_TRUE(
                glsl::refractDirection({std::sqrt(1.0 - passing * passing), 0.0, passing}, kUp, eta, l));
            EXPECT_FALSE(glsl::refractDirection({std::sqrt(1.0 - reflecting * reflecting), 0.0, reflecting},
                                                kUp, eta, l));
        }
    }
}

// Clear glass neither loses nor makes light, whatever its index, from either side and at any angle.
TEST(Transmission, SmoothGlassKeepsAllLight) {
    for (const double ior : kIors) {
        for (const bool leaves : {false, true}) {
            for (const glsl::uint volume : {0U, static_cast<glsl::uint>(GLINT_VOLUME)}) {
                TestMaterial glass = makeMaterial(1e-3);
                glass.lobes = GLINT_TRANSMISSION | volume;
                glass.bsdf.base.f0 = glm::dvec3(glsl::dielectricF0(ior));
                glass.bsdf.base.transmitted = glm::dvec3(1.0);
                glass.bsdf.base.eta = glm::dvec3(leaves ? 1.0 / ior : ior);
                for (const double cosine : {0.05, 0.2, 0.5, 0.9, 1.0}) {
                    const double sum = albedo(glass.seenFrom(direction(cosine, 0.3)), 8000).y;
                    EXPECT_NEAR(sum, 1.0, 0.01) << "ior " << ior << (leaves ? ", leaving" : ", entering")
                                                << ", lobes " << glass.lobes << ", cosine " << cosine;
                    EXPECT_LE(sum, 1.001) << "ior " << ior << (leaves ? ", leaving" : ", entering")
                                          << ", lobes " << glass.lobes << ", cosine " << cosine;
                }
            }
        }
    }
}

TEST(Transmission, RoughGlassMakesNoLight) {
    for (const double ior : kIors) {
        for (const bool leaves : {false, true}) {
            for (const double alpha : {0.05, 0.3, 1.0}) {
                TestMaterial glass = makeMaterial(alpha);
                glass.lobes = GLINT_TRANSMISSION | GLINT_VOLUME;
                glass.bsdf.base.f0 = glm::dvec3(glsl::dielectricF0(ior));
                glass.bsdf.base.transmitted = glm::dvec3(1.0);
                glass.bsdf.base.eta = glm::dvec3(leaves ? 1.0 / ior : ior);
                for (const double cosine : {0.01, 0.3, 1.0}) {
                    // At grazing the sum has an error: it knows no facets that are mirrored at the plane.
                    const double most = leaves && cosine < 0.1 ? 1.02 : 1.002;
                    EXPECT_LE(albedo(glass.seenFrom(direction(cosine, 0.3)), 8000).y, most)
                        << "ior " << ior << (leaves ? ", leaving" : ", entering") << ", alpha " << alpha
                        << ", cosine " << cosine;
                }
            }
        }
    }
}

TEST(Volume, TransmittanceIsThatOfBeerAndLambert) {
    const glm::dvec3 colour(0.2, 0.5, 0.9);
    const double distance = 0.25;
    const glm::dvec3 absorption = -glm::log(colour) / distance;
    EXPECT_LT(glm::length(glsl::volumeTransmittance(absorption, distance) - colour), 1e-14);
    EXPECT_LT(glm::length(glsl::volumeTransmittance(absorption, 2.0 * distance) - colour * colour), 1e-14);
    EXPECT_EQ(glsl::volumeTransmittance(absorption, 0.0), glm::dvec3(1.0));
    EXPECT_EQ(glsl::volumeTransmittance(glm::dvec3(1e18), 1e5), glm::dvec3(0.0));
    EXPECT_EQ(glsl::volumeTransmittance(glm::dvec3(0.0), 1e5), glm::dvec3(1.0));
}

// The Abbe number is (n_d - 1) / (n_F - n_C), and the extension's value is 20 over it.
TEST(Volume, DispersionSpreadsByTheAbbeNumber) {
    for (const double abbe : {20.0, 32.0, 64.0}) {
        const glm::dvec3 ior = glsl::dispersedIor(1.5, 20.0 / abbe);
        EXPECT_NEAR((ior.y - 1.0) / (ior.z - ior.x), abbe, 1e-9);
        EXPECT_EQ(ior.y, 1.5);
    }
    EXPECT_EQ(glsl::dispersedIor(1.5, 0.0), glm::dvec3(1.5));
}

TEST(Film, OfNoThicknessIsTheBareSurfaceUpToSchlicksAir) {
    for (int step = 1; step <= 20; ++step) {
        const double cosine = step / 20.0;
        for (const double f0 : {0.02, 0.04, 0.5, 0.95}) {
            const double film = glsl::iridescentFresnel(cosine, glm::dvec3(f0), 1.8, 0.0).x;
            const double bare = glsl::fresnelSchlick(glm::dvec3(f0), 1.0, cosine).x;
            // With Schlick's approximation even a film of air reflects (1 - cosine)⁵, and the two amplitudes
            // at most add. Below 1e-5 the product of reflectances is limited, and the second order adds some.
            const double air = std::pow(1.0 - cosine, 5);
            const double interference = 2.0 * std::sqrt(std::max(air * bare, 1e-5)) + 0.01;
            EXPECT_GE(film, bare - interference) << "f0 " << f0 << ", cosine " << cosine;
            EXPECT_LE(film, bare + air + interference) << "f0 " << f0 << ", cosine " << cosine;
        }
    }
}

TEST(Film, ReflectsBetweenNothingAndAll) {
    Engine engine(7);
    for (int i = 0; i < 100000; ++i) {
        const glm::dvec3 film =
            glsl::iridescentFresnel(uniform(engine, 1e-7, 1.0), colour(engine), uniform(engine, 1.0, 3.0),
                                    uniform(engine, 0.0, 10000.0));
        ASSERT_GE(std::min({film.x, film.y, film.z}), 0.0);
        ASSERT_LE(largestOf(film), 1.0);
    }
}

}  // namespace
}  // namespace glint::numerics
