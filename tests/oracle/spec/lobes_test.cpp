// Compares the oracle's own functions with closed forms, with each other, and with numbers from elsewhere.
#include "oracle/spec/lobes.h"

#include "oracle/spec/albedo.h"
#include "oracle/spec/directions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

using namespace glint::spec;

// Facets with the density of isotropic Trowbridge-Reitz, whatever alpha is: a mapping that directions.h does
// not use.
template <typename Function>
double overFacets(double alpha, const Function& f) {
    return midpoints(256, 256, 0.0, [&](const Vec2& point) {
        // More points in the tail, which visible normals weigh more.
        const double tail = std::pow(1.0 - point.x, 3.0);
        const double tangent2 = alpha * alpha * (1.0 - tail) / tail;
        const double cosine = 1.0 / std::sqrt(1.0 + tangent2);
        const Vec3 h = polarDirection(cosine, 2.0 * kPi * point.y);
        const double density =
            squared(alpha / (squared(alpha) * cosine * cosine + 1.0 - cosine * cosine)) * cosine / kPi;
        return f(h) / density * 3.0 * squared(1.0 - point.x);
    });
}

TEST(SpecLobes, FacetsCoverTheSurface) {
    for (const Vec2 alpha : {Vec2(0.04), Vec2(0.3), Vec2(1.0), Vec2(0.8, 0.2), Vec2(1.0, 0.09)}) {
        const double area = overFacets(std::sqrt(alpha.x * alpha.y),
                                       [&](const Vec3& h) { return distribution(h, alpha) * h.z; });
        EXPECT_NEAR(area, 1.0, 2e-3) << alpha.x << ", " << alpha.y;
    }
}

TEST(SpecLobes, VisibleNormalsHaveADensityOfOne) {
    for (const double cosine : {0.95, 0.5, 0.1}) {
        for (const Vec2 alpha : {Vec2(0.3), Vec2(0.9), Vec2(0.7, 0.25)}) {
            const Vec3 v = polarDirection(cosine, 0.3);
            EXPECT_NEAR(overFacets(std::sqrt(alpha.x * alpha.y),
                                   [&](const Vec3& h) { return visibleNormalDensity(v, h, alpha); }),
                        1.0, 5e-3)
                << cosine << ", " << alpha.x;
            // The mapping has that density: it integrates something else as the plain mapping does.
            const auto f = [](const Vec3& h) { return squared(h.z) + 0.5 * h.x; };
            const double mapped = midpoints(
                256, 512, 0.0, [&](const Vec2& point) { return f(visibleNormal(v, alpha, point)); });
            const double plain = overFacets(std::sqrt(alpha.x * alpha.y), [&](const Vec3& h) {
                return f(h) * visibleNormalDensity(v, h, alpha);
            });
            EXPECT_NEAR(mapped, plain, 5e-3) << cosine << ", " << alpha.x;
        }
    }
}

// Two changes of variables, one of which knows nothing of the lobe.
TEST(SpecLobes, QuadraturesAgree) {
    const Vec3 v = polarDirection(0.4, 0.3);
    for (const Vec2 alpha : {Vec2(0.4), Vec2(1.0), Vec2(0.9, 0.4)}) {
        const auto lobe = [&](const Vec3& l) {
            return distribution(glm::normalize(v + l), alpha) *
                   visibility(l, v, alpha, Masking::HeightCorrelated) * l.z;
        };
        const double byCosine = midpoints(256, 512, 0.0, [&](const Vec2& point) {
            const Direction d = cosineDirection(point);
            return lobe(d.l) * d.solidAngle;
        });
        const double byNormals = midpoints(128, 256, 0.0, [&](const Vec2& point) {
            const Direction d = reflectedDirection(v, alpha, point);
            return d.l.z > 0.0 ? lobe(d.l) * d.solidAngle : 0.0;
        });
        EXPECT_NEAR(byNormals, byCosine, 1e-3) << alpha.x;
    }
}

// At alpha 1 facets are a hemisphere: D = 1/π, and E(μ) = 1 - μ ln(1 + 1/μ).
TEST(SpecLobes, AlbedoOfTheRoughestFacets) {
    const MicrofacetAlbedo albedo(Vec2(1.0), Masking::HeightCorrelated);
    for (const double cosine : {0.05, 0.2, 0.5, 0.8, 1.0}) {
        EXPECT_NEAR(albedo.at(polarDirection(cosine, 0.3)).whole(), 1.0 - cosine * std::log1p(1.0 / cosine),
                    2e-3)
            << cosine;
    }
    EXPECT_NEAR(albedo.mean().whole(), 1.0 - 2.0 * (2.0 * std::log(2.0) - 0.5) / 3.0, 1e-3);
}

// From an independent program, four digits after the decimal point: rows of alpha, columns of n·v.
TEST(SpecLobes, AlbedosOfAnotherProgram) {
    constexpr double kCosines[] = {0.1, 0.25, 0.5, 0.75, 1.0};
    constexpr double kAlphas[] = {0.01, 0.0625, 0.25, 0.5625};
    constexpr double kAlbedos[4][5] = {{0.994126, 0.999094, 0.999737, 0.999858, 0.999908},
                                       {0.896768, 0.961567, 0.988323, 0.993810, 0.995679},
                                       {0.891623, 0.840082, 0.857264, 0.891533, 0.915810},
                                       {0.848356, 0.744456, 0.663176, 0.632885, 0.626886}};
    constexpr double kMeans[] = {0.999496, 0.987252, 0.882324, 0.656201};
    for (std::size_t i = 0; i < 4; ++i) {
        const MicrofacetAlbedo albedo(Vec2(kAlphas[i]), Masking::HeightCorrelated);
        for (std::size_t j = 0; j < 5; ++j) {
            EXPECT_NEAR(albedo.at(polarDirection(kCosines[j], 0.3)).whole(), kAlbedos[i][j], 1.5e-3)
                << kAlphas[i] << ", " << kCosines[j];
        }
        EXPECT_NEAR(albedo.mean().whole(), kMeans[i], 1e-3) << kAlphas[i];
    }
}

// Schlick's weight of a mirror is that of the view.
TEST(SpecLobes, SchlickShareOfASmoothLobe) {
    const MicrofacetAlbedo albedo(Vec2(1e-3), Masking::HeightCorrelated);
    for (const double cosine : {0.2, 0.5, 0.9}) {
        EXPECT_NEAR(albedo.at(polarDirection(cosine, 0.3)).weighted, std::pow(1.0 - cosine, 5.0), 2e-3)
            << cosine;
    }
}

// The index of 1.5 gives the appendix's 0.04.
TEST(SpecLobes, ReflectanceOfGlass) {
    EXPECT_NEAR(reflectanceOfIor(1.5), 0.04, 1e-15);
    EXPECT_EQ(reflectanceOfIor(0.0), 1.0);
    EXPECT_EQ(schlickWeight(1.0), 0.0);
    EXPECT_EQ(schlickWeight(0.0), 1.0);
}

TEST(SpecLobes, DispersionSpreadsAboutGreen) {
    // An Abbe number of 20 is a dispersion of 1: n_F - n_C = (n_d - 1) / 20.
    const Vec3 iors = dispersedIors(1.6, 1.0);
    EXPECT_NEAR(iors.z - iors.x, 0.6 / 20.0, 1e-15);
    EXPECT_EQ(iors.y, 1.6);
}

// A film that is as thick as many wavelengths shows the sum of all reflections without interference, and one
// of the index of air shows its base.
TEST(SpecLobes, FilmsAtTheirLimits) {
    const Vec3 base(0.04, 0.3, 0.8);
    const double r12 = squared(0.5 / 2.5);
    const Vec3 thick = filmFresnel(1.5, base, 1e6, 1.0);
    for (int i = 0; i < 3; ++i) {
        const double root = std::sqrt(base[i] + 1e-4);
        const double ior = (1.0 + root) / (1.0 - root);
        const double r23 = squared((ior - 1.5) / (ior + 1.5));
        EXPECT_NEAR(thick[i], r12 + squared(1.0 - r12) * r23 / (1.0 - r12 * r23), 2e-3) << i;
    }
    const Vec3 air = filmFresnel(1.0, base, 400.0, 1.0);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(air[i], base[i], 1e-2) << i;
    }
}

// Half a wavelength of green light between the two reflections: a film whose base is denser reflects least
// where they cancel, with an index of the root of the base's.
TEST(SpecLobes, FilmsCancelGreen) {
    const Vec3 base(reflectanceOfIor(1.5 * 1.5));
    const double quarter = 545.0 / 4.0 / 1.5;
    EXPECT_LT(filmFresnel(1.5, base, quarter, 1.0).y, 0.02);
    EXPECT_GT(filmFresnel(1.5, base, 2.0 * quarter, 1.0).y, 0.1);
}

TEST(SpecLobes, RefractionPassesAllLightThatFacetsLetThrough) {
    // By cosines and by visible normals, without Fresnel: Walter et al. lose only what Smith's masking hides.
    const Vec3 v = polarDirection(0.7, 0.3);
    const Vec2 alpha(0.4);
    const double eta = 1.5;
    const auto lobe = [&](const Vec3& l) {
        Vec3 h = -glm::normalize(v + eta * l);
        h = h.z < 0.0 ? -h : h;
        const double vh = glm::dot(v, h);
        const double lh = glm::dot(l, h);
        return vh > 0.0 && lh < 0.0 ? -lh * vh * 4.0 * visibility(l, v, alpha, Masking::HeightCorrelated) *
                                          eta * eta * distribution(h, alpha) / squared(vh + eta * lh) * -l.z
                                    : 0.0;
    };
    const double byCosine = midpoints(512, 1024, 0.0, [&](const Vec2& point) {
        const Direction d = cosineDirection(point);
        return lobe({d.l.x, d.l.y, -d.l.z}) * d.solidAngle;
    });
    const double byNormals = midpoints(128, 256, 0.0, [&](const Vec2& point) {
        const Direction d = refractedDirection(v, alpha, eta, point);
        return d.solidAngle > 0.0 && d.l.z < 0.0 ? lobe(d.l) * d.solidAngle : 0.0;
    });
    EXPECT_NEAR(byNormals, byCosine, 2e-3);
    EXPECT_LT(byNormals, 1.0);
    EXPECT_GT(byNormals, 0.9);
}

// The fit of the masking is published for roughnesses down to 0.07 (Estevez and Kulla 2017).
TEST(SpecLobes, SheenReflectsLessThanItReceivesWhereItIsRough) {
    const SheenAlbedo rough(1.0);
    const SheenAlbedo smooth(0.09);
    for (const double cosine : {0.1, 0.3, 0.6, 1.0}) {
        EXPECT_GT(rough.at(cosine), 0.0);
        EXPECT_LT(rough.at(cosine), 1.0);
        EXPECT_LT(smooth.at(cosine), 1.0);
    }
    // A smooth cloth reflects at its rim only.
    EXPECT_GT(smooth.at(0.1), 10.0 * smooth.at(1.0));
}

// Nothing in this folder reads the shaders, or anything of the tool that could.
TEST(SpecOracle, SharesNothingWithTheShaders) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(GLINT_SOURCE_DIR "/tests/oracle/spec")) {
        std::ifstream file(entry.path());
        const std::string name = entry.path().filename().string();
        const bool onDevice = name.starts_with("device") || name.starts_with("comparison") ||
                              name.starts_with("table") || name.starts_with("spec_");
        for (std::string line; std::getline(file, line);) {
            if (!line.starts_with("#include \"")) {
                continue;
            }
            ++files;
            const std::string path = line.substr(10, line.find('"', 10) - 10);
            const bool own = path.starts_with("oracle/spec/") || path == "oracle/vectors.h";
            EXPECT_TRUE(own || (onDevice && (path == "render/harness.h" ||
                                             path == "unit/gltf/gltf_builder.h" || path == "base/files.h" ||
                                             path == "support/effect_bits.h" || path == "support/must.h")))
                << name << " includes " << path;
        }
    }
    EXPECT_GT(files, 20);
}

}  // namespace
