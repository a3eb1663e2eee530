// The pack of OpenPBR, examples/materials/openpbr: each lobe against formulas in double precision, written
// from the papers that the specification names.
#include "gltf/import.h"
#include "materials/declarations.h"
#include "measure/features/checks.h"
#include "plan/effects.h"
#include "render/harness.h"
#include "render/light_pictures.h"
#include "render/pixel_test.h"
#include "render/scene_builder.h"
#include "support/must.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

const std::string kOpenPbr = GLINT_SOURCE_DIR "/examples/materials/openpbr";

const materials::MaterialModel& openPbr() {
    static const materials::MaterialModel& model = []() -> const materials::MaterialModel& {
        const Result<const materials::MaterialModel*> loaded =
            materials::loadMaterialModel(std::vector{kOpenPbr});
        EXPECT_TRUE(loaded) << toString(loaded.error());
        return **loaded;
    }();
    return model;
}

// A material with the specification's defaults, as a file has that says nothing more.
materials::Material openPbrMaterial() {
    materials::Material material(openPbr());
    material.give("EXAMPLE_materials_openpbr");
    material.give("KHR_materials_emissive_strength");
    material["baseColorFactor"] = {0.8F, 0.8F, 0.8F, 1.0F};
    material["metallicFactor"] = 0.0F;
    material["roughnessFactor"] = 0.3F;
    material["emissiveFactor"] = {1.0F, 1.0F, 1.0F};
    material["emissiveStrength"] = 0.0F;
    return material;
}

// A base that sends no light back.
materials::Material blackOpenPbr() {
    materials::Material material = openPbrMaterial();
    material["metallicFactor"] = 1.0F;
    material["specularWeight"] = 0.0F;
    return material;
}

struct Vector {
    double x, y, z;
};

// Three channels: of a reflectance, or of the BSDF times |n·l|.
using Light = std::array<double, 3>;

double dot(Vector a, Vector b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

Vector normalized(Vector v) {
    const double length = std::sqrt(dot(v, v));
    return {v.x / length, v.y / length, v.z / length};
}

Vector asOnDevice(Vector v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

double dielectric(double cosine, double eta) {
    const double sine2 = (1.0 - cosine * cosine) / (eta * eta);
    if (sine2 >= 1.0) {
        return 1.0;
    }
    const double beyond = std::sqrt(1.0 - sine2);
    const double s = (cosine - eta * beyond) / (cosine + eta * beyond);
    const double p = (eta * cosine - beyond) / (eta * cosine + beyond);
    return 0.5 * (s * s + p * p);
}

// The alphas of a roughness and an anisotropy.
std::pair<double, double> alphas(double roughness, double anisotropy) {
    const double along = roughness * roughness * std::sqrt(2.0 / (1.0 + std::pow(1.0 - anisotropy, 2.0)));
    return {along, (1.0 - anisotropy) * along};
}

using Alphas = std::pair<double, double>;

double ggx(Vector h, Alphas alpha) {
    const double slope = std::pow(h.x / alpha.first, 2.0) + std::pow(h.y / alpha.second, 2.0) + h.z * h.z;
    return 1.0 / (std::numbers::pi * alpha.first * alpha.second * slope * slope);
}

double lambda(Vector v, Alphas alpha) {
    const double slope2 =
        (std::pow(alpha.first * v.x, 2.0) + std::pow(alpha.second * v.y, 2.0)) / (v.z * v.z);
    return 0.5 * (std::sqrt(1.0 + slope2) - 1.0);
}

// G₂ of Smith's model, with heights that are correlated.
double masking(Vector v, Vector l, Alphas alpha) {
    return 1.0 / (1.0 + lambda(v, alpha) + lambda(l, alpha));
}

// A reflection lobe times n·l, without Fresnel; and the cosine at its facet.
std::pair<double, double> reflection(Vector v, Vector l, Alphas alpha) {
    const Vector h = normalized({v.x + l.x, v.y + l.y, v.z + l.z});
    return {ggx(h, alpha) * masking(v, l, alpha) / (4.0 * v.z), dot(v, h)};
}

// Walter et al. (2007), equation 21, times |n·l|, as flux.
double refraction(Vector v, Vector l, Alphas alpha, double eta) {
    Vector h = normalized({v.x + eta * l.x, v.y + eta * l.y, v.z + eta * l.z});
    if (h.z < 0.0) {
        h = {-h.x, -h.y, -h.z};
    }
    const double i = dot(v, h);
    const double o = dot(l, h);
    if (i <= 0.0 || o >= 0.0) {
        return 0.0;
    }
    return (1.0 - dielectric(i, eta)) * i * -o * eta * eta * ggx(h, alpha) * masking(v, l, alpha) /
           (v.z * std::pow(i + eta * o, 2.0));
}

// Energy-preserving Oren and Nayar: Portsmouth, Kutz and Hill (2025), with the exact albedo.
double eon(double color, double r, Vector v, Vector l) {
    constexpr double kPi = std::numbers::pi;
    const double a = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * kPi)) * r);
    const auto albedo = [&](double cosine) {
        const double sine = std::sqrt(1.0 - cosine * cosine);
        const double g = sine * (std::acos(cosine) - sine * cosine) +
                         2.0 / 3.0 * (sine / cosine * (1.0 - sine * sine * sine) - sine);
        return a + r * a * g / kPi;
    };
    const double mean = a * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * kPi)) * r);
    const double s = dot(v, l) - v.z * l.z;
    const double once = color / kPi * a * (1.0 + r * (s > 0.0 ? s / std::max(v.z, l.z) : s));
    const double many = color * color * mean / (1.0 - color * (1.0 - mean));
    return once + many / kPi * (1.0 - albedo(v.z)) * (1.0 - albedo(l.z)) / (1.0 - mean);
}

// Fuzz times n·l: Zeltner, Burley and Chiang (2022), with the fits of its coefficients that MaterialX has. A
// clamped cosine is transformed by the inverse of a matrix, here in the plane of the view.
double fuzz(Vector v, Vector l, double roughness) {
    const double x = v.z;
    const double y = roughness;
    const double spread = y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y));
    const double centre = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y);
    const double offset =
        y * (0.000654023 + (-0.0207818 + 0.119681 * y) * y) / (1.26264 + y * (-1.92021 + y));
    const double albedo =
        std::exp(-0.5 * std::pow((x - centre) / spread, 2.0)) / (spread * std::sqrt(2.0 * std::numbers::pi)) +
        offset;
    const double a = (2.58126 * x + 0.813703 * y) * y / (1.0 + 0.310327 * x * x + 2.60994 * x * y);
    const double b = std::sqrt(1.0 - x) * (y - 1.0) * y * y * y /
                     (0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y);
    const double sine = std::hypot(v.x, v.y);
    const double along = (v.x * l.x + v.y * l.y) / sine;
    const double across = (v.x * l.y - v.y * l.x) / sine;
    const Vector back{a * along + b * l.z, a * across, l.z};
    const double length = std::sqrt(dot(back, back));
    const double determinant = a * a;
    return albedo * (back.z / length) / std::numbers::pi * determinant / std::pow(length, 3.0);
}

// The colour of a spectrum by its path difference in nanometres and a phase for each channel: the Gaussians
// of Belcour and Barla (2017), as in the text of KHR_materials_iridescence.
Light filmColor(double path, const Light& shift) {
    const double phase = 2.0 * std::numbers::pi * path * 1e-9;
    const auto gaussian = [&](double value, double position, double variance, double turn) {
        return value * std::sqrt(2.0 * std::numbers::pi * variance) * std::cos(position * phase + turn) *
               std::exp(-variance * phase * phase) / 1.0685e-7;
    };
    const double x = gaussian(5.4856e-13, 1.6810e6, 4.3278e9, shift[0]) +
                     gaussian(9.7470e-14, 2.2399e6, 4.5282e9, shift[0]);
    const double y = gaussian(4.4201e-13, 1.7953e6, 9.3046e9, shift[1]);
    const double z = gaussian(5.2481e-13, 2.2084e6, 6.6121e9, shift[2]);
    return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

// A film, given the reflectance of its outer side, and for each channel that of its inner side and whether
// the base is the rarer one. `path` is the difference of the first order's path.
Light film(double outer, const Light& inner, const std::array<bool, 3>& isRarer, double path) {
    Light once{};
    Light twice{};
    for (std::size_t i = 0; i < 3; ++i) {
        once[i] = std::numbers::pi * (isRarer[i] ? 2.0 : 1.0);
        twice[i] = 2.0 * once[i];
    }
    const Light first = filmColor(path, once);
    const Light second = filmColor(2.0 * path, twice);
    Light reflected{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double both = outer * inner[i];
        const double series = (1.0 - outer) * (1.0 - outer) * inner[i] / (1.0 - both);
        const double order = series - (1.0 - outer);
        reflected[i] = outer + series + 2.0 * order * (std::sqrt(both) * first[i] + both * second[i]);
        reflected[i] = std::clamp(reflected[i], 0.0, 1.0);
    }
    return reflected;
}

double cosineWithin(double cosine, double ior) {
    return std::sqrt(1.0 - (1.0 - cosine * cosine) / (ior * ior));
}

Light filmOnDielectric(double cosine, double ior, double thickness, double base) {
    const double within = cosineWithin(cosine, ior);
    const double inner = dielectric(within, base / ior);
    const bool isRarer = base < ior;
    return film(dielectric(cosine, ior), {inner, inner, inner}, {isRarer, isRarer, isRarer},
                2.0 * ior * thickness * within);
}

Light filmOnMetal(double cosine, double ior, double thickness, const Light& f0) {
    const auto schlick = [](double normal, double c) {
        return normal + (1.0 - normal) * std::pow(1.0 - c, 5.0);
    };
    const auto between = [](double n) { return std::pow((n - 1.0) / (n + 1.0), 2.0); };
    const double within = cosineWithin(cosine, ior);
    Light inner{};
    std::array<bool, 3> isRarer{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double base = (1.0 + std::sqrt(f0[i])) / (1.0 - std::sqrt(f0[i]));
        inner[i] = schlick(between(base / ior), within);
        isRarer[i] = base < ior;
    }
    return film(schlick(between(ior), cosine), inner, isRarer, 2.0 * ior * thickness * within);
}

// The share of light that white microfacets do not send up at once, by quadrature over their normals.
double lossOf(Vector v, Alphas alpha) {
    constexpr int kSteps = 100;
    double reflected = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        // Steep facets are rare, but lose the most: the steps get narrower towards them.
        const double t = (i + 0.5) / kSteps;
        const double steeper = std::pow(t, 4.0);
        const double slope = std::sqrt((1.0 - steeper) / steeper);
        for (int k = 0; k < kSteps; ++k) {
            const double azimuth = 2.0 * std::numbers::pi * (k + 0.5) / kSteps;
            const Vector h = normalized(
                {alpha.first * slope * std::cos(azimuth), alpha.second * slope * std::sin(azimuth), 1.0});
            const double c = dot(v, h);
            const Vector l{2.0 * c * h.x - v.x, 2.0 * c * h.y - v.y, 2.0 * c * h.z - v.z};
            if (c > 0.0 && l.z > 0.0) {
                reflected += 4.0 * std::pow(t, 3.0) * masking(v, l, alpha) * c / (v.z * h.z);
            }
        }
    }
    return 1.0 - reflected / (kSteps * kSteps);
}

// Light of later bounces between facets, times n·l: Kulla and Conty (2017), "Revisiting Physically Based
// Shading at Imageworks".
class LaterBounces {
public:
    LaterBounces(Alphas alpha, const std::function<Light(double cosine)>& fresnel)
        : azimuths_(alpha.first == alpha.second ? 1 : 8) {
        double meanLoss = 0.0;
        Light mean{};
        for (int i = 0; i < kCosines; ++i) {
            const double cosine = (i + 0.5) / kCosines;
            const double share = 2.0 * cosine / kCosines;
            for (int k = 0; k < azimuths_; ++k) {
                const double azimuth = std::numbers::pi / 2.0 * (k + 0.5) / azimuths_;
                const double sine = std::sqrt(1.0 - cosine * cosine);
                losses_.push_back(
                    lossOf({sine * std::cos(azimuth), sine * std::sin(azimuth), cosine}, alpha));
                meanLoss += share * losses_.back() / azimuths_;
            }
            const Light here = fresnel(cosine);
            for (std::size_t k = 0; k < 3; ++k) {
                mean[k] += share * here[k];
            }
        }
        for (std::size_t k = 0; k < 3; ++k) {
            colors_[k] = mean[k] * mean[k] * (1.0 - meanLoss) / (1.0 - mean[k] * meanLoss) / meanLoss;
        }
    }

    Light operator()(Vector v, Vector l) const {
        const double light = lossAt(v) * lossAt(l) * l.z / std::numbers::pi;
        return {colors_[0] * light, colors_[1] * light, colors_[2] * light};
    }

private:
    static constexpr int kCosines = 64;

    // Linear between the middles of cells, of which each quarter of the circle has the same.
    double lossAt(Vector direction) const {
        const double azimuth = std::atan2(std::abs(direction.y), std::abs(direction.x));
        const auto [row, rowShare] = placeOf(direction.z * kCosines, kCosines);
        const auto [column, columnShare] = placeOf(azimuth / (std::numbers::pi / 2.0) * azimuths_, azimuths_);
        double loss = 0.0;
        for (const int i : {0, 1}) {
            for (const int k : {0, 1}) {
                const int last = azimuths_ - 1;
                const int cell = (row + i) * azimuths_ + std::min(column + k, last);
                loss += (i == 1 ? rowShare : 1.0 - rowShare) * (k == 1 ? columnShare : 1.0 - columnShare) *
                        losses_[static_cast<std::size_t>(cell)];
            }
        }
        return loss;
    }

    static std::pair<int, double> placeOf(double place, int cells) {
        const double held = std::clamp(place - 0.5, 0.0, cells - 1.0);
        const int first = std::min(static_cast<int>(held), std::max(cells - 2, 0));
        return {first, held - first};
    }

    int azimuths_;
    std::vector<double> losses_;  // by cosine, then by azimuth
    Light colors_{};
};

// All light that facets of a metal send back.
std::function<Light(Vector v, Vector l)> metalLobe(Alphas alpha,
                                                   std::function<Light(double cosine)> fresnel) {
    const LaterBounces later(alpha, fresnel);
    return [=](Vector v, Vector l) {
        const auto [lobe, cosine] = reflection(v, l, alpha);
        const Light once = fresnel(cosine);
        Light light = later(v, l);
        for (std::size_t i = 0; i < 3; ++i) {
            light[i] += lobe * once[i];
        }
        return light;
    };
}

class QuietObserver final : public measure::Observer {
public:
    using measure::Observer::report;
    void report(const Diagnostic& diagnostic) const override {
        ADD_FAILURE() << toString(diagnostic);
    }
    void progress(std::string_view /*text*/) const override {}
    void detail(std::string_view /*text*/) const override {}
};

struct LobeCase {
    std::string name;
    materials::Material material;
    std::function<Light(Vector v, Vector l)> expected;
    double tolerance = 1e-4;  // of the larger of the value and `least`
    double least = 1e-3;
    enum { Anywhere, Behind, AtMirror, OffMirror } lights = Anywhere;
};

Light gray(double value) {
    return {value, value, value};
}

std::vector<LobeCase> lobeCases() {
    std::vector<LobeCase> cases;
    {
        materials::Material rough = openPbrMaterial();
        rough["specularWeight"] = 0.0F;
        rough["baseColorFactor"] = {0.9F, 0.5F, 0.1F, 1.0F};
        rough["baseDiffuseRoughness"] = 0.7F;
        cases.push_back({"diffuse", rough,
                         [](Vector v, Vector l) {
                             return Light{eon(0.9F, 0.7F, v, l) * l.z, eon(0.5F, 0.7F, v, l) * l.z,
                                          eon(0.1F, 0.7F, v, l) * l.z};
                         },
                         2e-3});  // the fit of the albedo
    }
    {
        materials::Material metal = openPbrMaterial();
        metal["metallicFactor"] = 1.0F;
        metal["roughnessFactor"] = 0.25F;
        metal["specularRoughnessAnisotropy"] = 0.5F;
        metal["baseColorFactor"] = {0.9F, 0.6F, 0.3F, 1.0F};
        metal["specularColor"] = {0.5F, 0.8F, 1.0F};
        metal["specularWeight"] = 0.9F;
        const auto fresnel = [](double cosine) {
            const auto tinted = [cosine](double f0, double tint) {
                const auto schlick = [f0](double x) { return f0 + (1.0 - f0) * std::pow(1.0 - x, 5.0); };
                const double edge = 1.0 / 7.0;
                const double dip = schlick(edge) * (1.0 - tint) / (edge * std::pow(1.0 - edge, 6.0));
                return 0.9F * (schlick(cosine) - dip * cosine * std::pow(1.0 - cosine, 6.0));
            };
            return Light{tinted(0.9F, 0.5F), tinted(0.6F, 0.8F), tinted(0.3F, 1.0)};
        };
        cases.push_back(
            {"F82-tint", metal, metalLobe(alphas(0.25F, 0.5F), fresnel), 3e-4, 1.0, LobeCase::AtMirror});
    }
    {
        materials::Material coat = blackOpenPbr();
        coat["coatWeight"] = 0.75F;
        coat["coatRoughness"] = 0.4F;
        coat["coatRoughnessAnisotropy"] = 0.6F;
        coat["coatIor"] = 1.7F;
        cases.push_back({"coat", coat, [](Vector v, Vector l) {
                             const auto [lobe, cosine] = reflection(v, l, alphas(0.4F, 0.6F));
                             return gray(0.75 * lobe * dielectric(cosine, 1.7F));
                         }});
    }
    {
        materials::Material glass = openPbrMaterial();
        glass["transmissionWeight"] = 1.0F;
        glass["transmissionColor"] = {1.0F, 0.5F, 0.25F};
        glass["roughnessFactor"] = 0.4F;
        glass["specularIor"] = 1.6F;
        cases.push_back({"refraction", glass,
                         [](Vector v, Vector l) {
                             const double value = refraction(v, l, alphas(0.4F, 0.0), 1.6F);
                             return Light{value, 0.5 * value, 0.25 * value};
                         },
                         1e-4, 1e-3, LobeCase::Behind});
        glass["transmissionDispersionScale"] = 0.5F;
        cases.push_back({"dispersion", glass,
                         [](Vector v, Vector l) {
                             Light light{};
                             const double wavelengths[] = {620.0, 540.0, 450.0};
                             const double tints[] = {1.0, 0.5, 0.25};
                             for (std::size_t i = 0; i < 3; ++i) {
                                 // Cauchy's formula, with an Abbe number of 40.
                                 const double b =
                                     (1.6F - 1.0) / (40.0 * (std::pow(486.1, -2.0) - std::pow(656.3, -2.0)));
                                 const double ior =
                                     1.6F + b * (std::pow(wavelengths[i], -2.0) - std::pow(587.6, -2.0));
                                 light[i] = tints[i] * refraction(v, l, alphas(0.4F, 0.0), ior);
                             }
                             return light;
                         },
                         1e-4, 1e-3, LobeCase::Behind});
    }
    {
        // The series of reflections between both sides of a sheet.
        materials::Material sheet = openPbrMaterial();
        sheet["transmissionWeight"] = 1.0F;
        sheet["transmissionColor"] = {0.8F, 0.8F, 0.8F};
        sheet["geometryThinWalled"] = 1.0F;
        sheet["roughnessFactor"] = 0.5F;
        cases.push_back({"thin wall", sheet,
                         [](Vector v, Vector l) {
                             const auto [lobe, cosine] = reflection(v, {l.x, l.y, -l.z}, alphas(0.5, 0.0));
                             const double r = dielectric(cosine, 1.5);
                             double passed = 0.0;
                             for (int order = 0; order < 20; ++order) {
                                 passed += (1.0 - r) * (1.0 - r) * std::pow(r * 0.8F, 2.0 * order) * 0.8F;
                             }
                             return gray(passed * lobe);
                         },
                         1e-4, 1e-3, LobeCase::Behind});
    }
    {
        // A thin sheet of subsurface scattering: 3/4 of the light goes on.
        materials::Material paper = openPbrMaterial();
        paper["specularWeight"] = 0.0F;
        paper["subsurfaceWeight"] = 1.0F;
        paper["subsurfaceColor"] = {0.5F, 0.5F, 0.5F};
        paper["subsurfaceScatterAnisotropy"] = 0.5F;
        paper["geometryThinWalled"] = 1.0F;
        cases.push_back({"sheet of subsurface", paper,
                         [](Vector, Vector l) { return gray(0.75 * 0.5 * -l.z / std::numbers::pi); }, 1e-4,
                         1e-3, LobeCase::Behind});
    }
    {
        // A smooth, coloured coat, which darkens what is below: away from the mirror direction, by its
        // Fresnel reflectance. The tolerance is that of the albedo's fit.
        materials::Material varnish = openPbrMaterial();
        varnish["specularWeight"] = 0.0F;
        varnish["baseColorFactor"] = {0.5F, 0.5F, 0.5F, 1.0F};
        varnish["coatWeight"] = 1.0F;
        varnish["coatIor"] = 1.5F;
        varnish["coatColor"] = {0.25F, 0.25F, 0.25F};
        cases.push_back(
            {"darkening and absorption", varnish,
             [](Vector v, Vector l) {
                 // The reflectance of the inner side, by quadrature: r_b is 1 for a base without gloss.
                 double mean = 0.0;
                 constexpr int kSteps = 2000;
                 for (int i = 0; i < kSteps; ++i) {
                     const double c = (i + 0.5) / kSteps;
                     mean += 2.0 * c * dielectric(c, 1.5) / kSteps;
                 }
                 const double inner = 1.0 - (1.0 - mean) / (1.5 * 1.5);
                 const double darkening = (1.0 - inner) / (1.0 - 0.5 * inner);
                 const auto within = [](double c) { return std::sqrt(1.0 - (1.0 - c * c) / 2.25); };
                 const double tint = std::pow(0.25, 0.5 * (1.0 / within(v.z) + 1.0 / within(l.z)));
                 return gray((1.0 - dielectric(v.z, 1.5)) * darkening * tint * 0.5 * l.z / std::numbers::pi);
             },
             6e-3, 1e-3, LobeCase::OffMirror});
    }
    for (const float roughness : {0.15F, 0.5F, 1.0F}) {
        materials::Material velvet = blackOpenPbr();
        velvet["fuzzWeight"] = 0.75F;
        velvet["fuzzColor"] = {1.0F, 0.5F, 0.25F};
        velvet["fuzzRoughness"] = roughness;
        cases.push_back({fmt::format("fuzz of roughness {}", roughness), velvet,
                         [roughness](Vector v, Vector l) {
                             const double value = 0.75 * fuzz(v, l, roughness);
                             return Light{value, 0.5 * value, 0.25 * value};
                         },
                         1e-5});
    }
    // Near the mirror direction, the light of later bounces is below the tolerance.
    for (const float ior : {1.3F, 1.9F}) {
        materials::Material soap = openPbrMaterial();
        soap["baseColorFactor"] = {0.0F, 0.0F, 0.0F, 1.0F};
        soap["roughnessFactor"] = 0.15F;
        soap["thinFilmWeight"] = 0.75F;
        soap["thinFilmThickness"] = 0.4F;
        soap["thinFilmIor"] = ior;
        cases.push_back({fmt::format("film of index {} on a dielectric", ior), soap,
                         [ior](Vector v, Vector l) {
                             const auto [lobe, cosine] = reflection(v, l, alphas(0.15F, 0.0));
                             Light light = filmOnDielectric(cosine, ior, 400.0, 1.5);
                             for (double& channel : light) {
                                 channel = lobe * (0.25 * dielectric(cosine, 1.5) + 0.75 * channel);
                             }
                             return light;
                         },
                         1e-4, 1.0, LobeCase::AtMirror});
    }
    {
        materials::Material anodised = openPbrMaterial();
        anodised["metallicFactor"] = 1.0F;
        anodised["roughnessFactor"] = 0.15F;
        anodised["baseColorFactor"] = {0.9F, 0.6F, 0.3F, 1.0F};
        anodised["thinFilmWeight"] = 0.75F;
        anodised["thinFilmThickness"] = 0.4F;
        anodised["thinFilmIor"] = 1.6F;
        const auto fresnel = [](double cosine) {
            const Light f0{0.9F, 0.6F, 0.3F};
            Light light = filmOnMetal(cosine, 1.6F, 400.0, f0);
            for (std::size_t i = 0; i < 3; ++i) {
                const double bare = f0[i] + (1.0 - f0[i]) * std::pow(1.0 - cosine, 5.0);
                light[i] = 0.25 * bare + 0.75 * light[i];
            }
            return light;
        };
        cases.push_back({"film on metal", anodised, metalLobe(alphas(0.15F, 0.0), fresnel), 5e-5, 1.0,
                         LobeCase::AtMirror});
    }
    return cases;
}

TEST(OpenPbr, LobesAreThoseOfDoublePrecision) {
    const std::vector<LobeCase> cases = lobeCases();
    measure::CheckedScene checked = must(measure::makeCheckedScene(openPbr(), 16));
    ASSERT_GE(checked.scene.materials.size(), cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) {
        checked.scene.materials[i] = cases[i].material;
    }
    measure::CheckMaterialsOptions options;
    options.packs = {kOpenPbr};
    const auto evaluator = must(measure::FeatureEvaluator::create(checked.scene, options, QuietObserver()));
    constexpr std::size_t kDraws = 4000;
    std::vector<compiler::FeatureKernelInput> inputs;
    std::vector<std::pair<Vector, Vector>> directions;
    for (std::size_t i = 0; i < cases.size() * kDraws; ++i) {
        const LobeCase& one = cases[i / kDraws];
        const auto direction = [&](std::uint32_t stream, double least) {
            const std::array<double, 3> u = measure::randomNumbers(i, stream);
            const double z = least + (1.0 - least) * u[0];
            const double radius = std::sqrt(1.0 - z * z);
            const double azimuth = 2.0 * std::numbers::pi * u[1];
            return Vector{radius * std::cos(azimuth), radius * std::sin(azimuth), z};
        };
        const bool atMirror = one.lights == LobeCase::AtMirror;
        const Vector view = asOnDevice(direction(1, atMirror ? 0.5 : 0.1));
        Vector light = direction(2, atMirror ? 0.99 : 0.1);
        if (atMirror) {
            const double twice = 2.0 * dot(view, light);
            light = {twice * light.x - view.x, twice * light.y - view.y, twice * light.z - view.z};
        }
        light.z = one.lights == LobeCase::Behind ? -light.z : light.z;
        light = asOnDevice(light);
        directions.emplace_back(view, light);
        compiler::FeatureKernelInput& input = inputs.emplace_back();
        input.geometry = static_cast<std::uint32_t>(i / kDraws);
        input.place[0] = input.place[1] = 0.25F;
        const double both[2][3] = {{view.x, view.y, view.z}, {light.x, light.y, light.z}};
        for (int k = 0; k < 3; ++k) {
            input.view[k] = static_cast<float>(both[0][k]);
            input.light[k] = static_cast<float>(both[1][k]);
        }
    }
    const auto outputs = must(evaluator->run(inputs));
    for (std::size_t c = 0; c < cases.size(); ++c) {
        double worst = 0.0;
        double brightest = 0.0;
        for (std::size_t i = c * kDraws; i < (c + 1) * kDraws; ++i) {
            const auto& [view, light] = directions[i];
            const Vector half = normalized({view.x + light.x, view.y + light.y, view.z + light.z});
            if (cases[c].lights == LobeCase::OffMirror && half.z > 0.98) {
                continue;
            }
            const Light expected = cases[c].expected(view, light);
            for (std::size_t k = 0; k < 3; ++k) {
                const double scale = std::max(expected[k], cases[c].least);
                worst = std::max(worst, std::abs(outputs.at(i).whole[k] - expected[k]) / scale);
                brightest = std::max(brightest, expected[k]);
            }
        }
        RecordProperty(fmt::format("worst_of_{}", c), fmt::format("{}: {:.2g}", cases[c].name, worst));
        EXPECT_LE(worst, cases[c].tolerance) << cases[c].name;
        EXPECT_GT(brightest, 2.0 * cases[c].least) << cases[c].name;
    }
}

struct Furnace {
    std::array<gltf::Float3, 3> sky;  // zenith, horizon, below
    compiler::SkyLight skyLight = compiler::SkyLight::Off;
};

// A small picture of a scene under a sky, without other lights.
LinearImage underSky(gltf::Scene scene, const Furnace& furnace) {
    addDirectionalLight(scene, {0, 0, -1}, 0.0F);  // a scene without lights would get some
    RenderSetup setup = defaultSetup(scene, 9, 9);
    setup.frame.sky = {furnace.sky[0], furnace.sky[1], furnace.sky[2]};
    setup.samples = 16;
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.maxBounces = 4;
    settings.skyLight = furnace.skyLight;
    settings.effects = {false, compiler::builtinEffects({"shadow", "indirect-diffuse"})};
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.bounces = 4;
    const LoadedScene loaded(scene, settings);
    LinearImage image = loaded.render(options, setup);
    EXPECT_FALSE(image.pixels.empty());
    image.pixels.resize(81);
    return image;
}

const std::array<gltf::Float3, 3> kWhiteSky{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};

// Light goes straight through a box without gloss, and loses what Beer and Lambert say on the way.
TEST(OpenPbr, AMediumAbsorbsOverTheWay) {
    materials::Material medium = openPbrMaterial();
    medium["specularWeight"] = 0.0F;
    medium["transmissionWeight"] = 1.0F;
    medium["transmissionColor"] = {0.5F, 0.7F, 0.9F};
    medium["transmissionDepth"] = 2.0F;
    medium.doubleSided = true;
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, medium, {-8, -8, -4}, {16, 0, 0}, {0, 16, 0});
    addQuad(scene, medium, {-8, -8, -7}, {0, 16, 0}, {16, 0, 0});
    const Pixel middle = at(underSky(scene, {kWhiteSky}), 4, 4);
    const float colors[] = {0.5F, 0.7F, 0.9F};
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(middle[k], std::pow(colors[k], 1.5), 2e-3);  // three metres of a depth of two
    }
}

// Rays of primary surfaces follow the samples of a model that has any: a mirror shows what is above it.
// Samples of the sky share its light with these rays.
TEST(OpenPbr, PrimarySurfacesFollowTheirOwnSamples) {
    materials::Material metal = openPbrMaterial();
    metal["metallicFactor"] = 1.0F;
    metal["roughnessFactor"] = 0.0F;
    metal["baseColorFactor"] = {1.0F, 1.0F, 1.0F, 1.0F};
    gltf::Scene mirror = sceneWithCamera();
    addQuad(mirror, metal, {-8, -8, 4}, {16, 0, 0}, {0, 16, -16});
    const Pixel seen = at(underSky(mirror, {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}}), 4, 4);
    EXPECT_NEAR(seen[0], 1.0, 0.03);
    EXPECT_NEAR(seen[1], 0.0, 0.03);
    EXPECT_NEAR(seen[2], 0.0, 1e-3);
    metal["roughnessFactor"] = 0.6F;
    gltf::Scene rough = sceneWithCamera();
    addQuad(rough, metal, {-8, -8, -4}, {16, 0, 0}, {0, 16, 0});
    for (const compiler::SkyLight skyLight : {compiler::SkyLight::Off, compiler::SkyLight::On}) {
        EXPECT_NEAR(meanOf(underSky(rough, {kWhiteSky, skyLight})), 1.0, 0.02) << static_cast<int>(skyLight);
    }
}

// A lamp's triangles are lights, and what has no luminance is none.
TEST(OpenPbr, EmissionIsALight) {
    gltf::ImportOptions import;
    import.materialModel = &openPbr();
    const gltf::Scene scene = must(importScene(kOpenPbr + "/scene.gltf", import));
    EXPECT_TRUE(scene.warnings.empty()) << toString(scene.warnings.front());
    int lamps = 0;
    for (const materials::Material& material : scene.materials) {
        const bool isEmitter = compiler::isEmitter(material, {});
        EXPECT_EQ(isEmitter, material.name == "Lamp") << material.name;
        lamps += isEmitter ? 1 : 0;
    }
    EXPECT_EQ(lamps, 1);
}

}  // namespace
