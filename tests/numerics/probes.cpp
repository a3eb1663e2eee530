#include "probes.h"

#include "plan/features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint::numerics {
namespace {

void fillDirection(InputSource& in) {
    in.put(in.direction());
}

void fillTransform(InputSource& in) {
    for (int k = 0; k < 15; ++k) {
        in.put(in.coordinate());
    }
}

void fillCounters(InputSource& in) {
    for (int k = 0; k < 5; ++k) {
        in.put(std::floor(in.uniform(0.0, 65536.0)));
    }
}

// The sum cancels but for the rounding of one factor.
void fillSumOfProduct(InputSource& in) {
    const auto b = static_cast<float>(in.uniform(-2.0, 2.0));
    const auto c = static_cast<float>(in.uniform(-2.0, 2.0));
    in.put(in.chance(0.5) ? -static_cast<double>(b) * c : in.uniform(-4.0, 4.0));
    in.put(b);
    in.put(c);
}

void fillProducts(InputSource& in) {
    const auto a = static_cast<float>(in.uniform(-2.0, 2.0));
    const auto b = static_cast<float>(in.uniform(-2.0, 2.0));
    const auto c = static_cast<float>(in.uniform(0.1, 2.0));
    in.put(a);
    in.put(b);
    in.put(c);
    in.put(in.chance(0.5) ? static_cast<double>(a) * b / c : in.uniform(-2.0, 2.0));
}

// Two directions at right angles but for their rounding, or any two.
void fillDirections(InputSource& in) {
    const Vector a = in.direction();
    const Vector b = in.direction();
    const Vector across{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    const double length = std::sqrt(across.x * across.x + across.y * across.y + across.z * across.z);
    in.put(a);
    in.put(length > 1e-3 && in.chance(0.7) ? Vector{across.x / length, across.y / length, across.z / length}
                                           : b);
}

void fillIor(InputSource& in) {
    in.put(in.ior());
}

void fillColour(InputSource& in) {
    for (int k = 0; k < 3; ++k) {
        in.put(in.colour());
    }
}

// Reflectances at normal incidence, and that at grazing, which is no less.
void fillReflectances(InputSource& in) {
    double largest = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double f0 = in.colour();
        in.put(f0);
        largest = std::max(largest, f0);
    }
    in.put(in.chance(0.5) ? 1.0 : largest);
}

void fillSchlick(InputSource& in) {
    fillReflectances(in);
    in.put(in.cosine());
}

// From the denser side half of the time, then often near the critical angle.
void fillCriticalAngle(InputSource& in) {
    const double eta = in.eta();
    if (eta < 1.0 && in.chance(0.5)) {
        const double critical = std::sqrt((1.0 - eta) * (1.0 + eta));
        in.put(std::min(critical * (1.0 + in.pick({-1.0, 1.0}) * in.logUniform(1e-8, 0.1)), 1.0));
    } else {
        in.put(in.cosine());
    }
    in.put(eta);
}

void fillInterface(InputSource& in) {
    fillReflectances(in);
    fillCriticalAngle(in);
}

void fillLobeNormal(InputSource& in) {
    const double alpha = in.alpha();
    in.put(in.chance(0.8) ? in.lobeNormal(alpha) : in.direction());
    in.put(alpha);
}

void fillLobeNormalAnisotropic(InputSource& in) {
    const double alphaX = in.alpha();
    const double alphaY = in.alpha();
    in.put(in.chance(0.8) ? in.lobeNormal(in.chance(0.5) ? alphaX : alphaY) : in.direction());
    in.put(alphaX);
    in.put(alphaY);
}

void fillLightViewAlpha(InputSource& in) {
    in.put(in.upper());
    in.put(in.upper());
    in.put(in.alpha());
}

void fillLightViewAlphas(InputSource& in) {
    in.put(in.chance(0.5) ? in.upper() : in.lower());
    in.put(in.upper());
    in.put(in.alpha());
    in.put(in.alpha());
}

void fillVisibleNormal(InputSource& in) {
    in.put(in.upper());
    in.put(in.alpha());
    in.put(in.alpha());
    in.put(in.sample());
    in.put(in.sample());
}

void fillVisibleNormalPdf(InputSource& in) {
    const double alphaX = in.alpha();
    const double alphaY = in.alpha();
    in.put(in.upper());
    in.put(in.lobeNormal(in.chance(0.5) ? alphaX : alphaY));
    in.put(alphaX);
    in.put(alphaY);
}

// As sheen has them: alpha is the square of a roughness of at least 0.07.
double sheenAlpha(InputSource& in) {
    return in.chance(0.1) ? in.pick({5e-3, 1.0}) : in.logUniform(5e-3, 1.0);
}

void fillSheenDistribution(InputSource& in) {
    in.put(in.chance(0.5) ? in.uniform() : 1.0 - in.logUniform(1e-8, 1.0));
    in.put(sheenAlpha(in));
}

void fillSheenVisibility(InputSource& in) {
    in.put(in.cosine());
    in.put(in.cosine());
    in.put(sheenAlpha(in));
}

void fillFilm(InputSource& in) {
    in.put(in.cosine());
    fillColour(in);
    in.put(in.chance(0.2) ? in.pick({1.0, 1.3, 1.8}) : in.uniform(1.0, 3.0));
    in.put(in.chance(0.2) ? in.pick({0.0, 1e-3, 15.0, 30.0, 1e4}) : in.logUniform(1.0, 1e4));
}

void fillRefraction(InputSource& in) {
    const double alpha = in.alpha();
    in.put(in.upper());
    in.put(in.chance(0.7) ? in.lobeNormal(alpha) : in.upper());
    in.put(in.eta());
}

void fillRefracted(InputSource& in) {
    const Vector view = in.upper();
    const double alphaX = in.alpha();
    const double alphaY = in.alpha();
    const double eta = in.eta(1.1e-4);  // kMinIndexStep, and room for rounding
    in.put(view);
    in.put(in.refracted(view, in.chance(0.5) ? alphaX : alphaY, eta));
    in.put(alphaX);
    in.put(alphaY);
    in.put(eta);
}

void fillThin(InputSource& in) {
    const Vector view = in.upper();
    const double alphaX = in.alpha();
    const double alphaY = in.alpha();
    Vector light = in.mirrored(view, in.chance(0.5) ? alphaX : alphaY);
    light.z = -light.z;
    in.put(view);
    in.put(light);
    in.put(alphaX);
    in.put(alphaY);
}

void fillVolume(InputSource& in) {
    for (int k = 0; k < 3; ++k) {
        in.put(in.chance(0.2) ? in.pick({0.0, 1e18, 1.0}) : in.logUniform(1e-6, 1e4));
    }
    in.put(in.chance(0.1) ? in.pick({0.0, 1e5}) : in.logUniform(1e-6, 1e5));
}

void fillDispersion(InputSource& in) {
    in.put(std::max(in.ior(), 1.0));
    in.put(in.uniform(0.0, 2.0));
}

// A coat whose normal leans from z, and light that mirrors the view about it.
void fillClearcoat(InputSource& in) {
    const double alpha = in.alpha();
    const Vector n = in.chance(0.3) ? Vector{} : in.lobeNormal(in.uniform(0.0, 0.5) + 1e-6);
    const Vector view = in.upper();
    const Vector jitter = in.lobeNormal(alpha);
    Vector h{n.x + jitter.x, n.y + jitter.y, n.z + jitter.z - 1.0};
    const double length = std::sqrt(h.x * h.x + h.y * h.y + h.z * h.z);
    h = {h.x / length, h.y / length, h.z / length};
    const double twice = 2.0 * (view.x * h.x + view.y * h.y + view.z * h.z);
    in.put(n);
    in.put(view);
    in.put(in.chance(0.8) ? Vector{twice * h.x - view.x, twice * h.y - view.y, twice * h.z - view.z}
                          : in.upper());
    in.put(alpha);
}

void fillVector(InputSource& in) {
    const Vector v = in.direction();
    const double length = in.logUniform(1e-15, 1e15);
    in.put({v.x * length, v.y * length, v.z * length});
}

void fillNormalTransform(InputSource& in) {
    for (int k = 0; k < 9; ++k) {
        in.put(in.coordinate());
    }
    in.put(in.direction());
}

// A triangle under a transform that turns, scales by 0.1 to 10 along each axis and moves.
void fillPlane(InputSource& in) {
    in.put(in.direction());
    for (int k = 0; k < 12; ++k) {
        in.put(in.coordinate());
    }
    const Vector turn = in.direction();
    const double angle = in.uniform(0.0, 3.0);
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    const double n[3] = {turn.x, turn.y, turn.z};
    const double across[3][3] = {{0.0, -n[2], n[1]}, {n[2], 0.0, -n[0]}, {-n[1], n[0], 0.0}};
    const double scale[3] = {in.logUniform(0.1, 10.0), in.logUniform(0.1, 10.0), in.logUniform(0.1, 10.0)};
    double rotation[3][3];
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            rotation[row][column] =
                (row == column ? c : 0.0) + s * across[row][column] + (1.0 - c) * n[row] * n[column];
            in.put(rotation[row][column] * scale[column]);
        }
        in.put(in.coordinate());
    }
    // Cofactors of a rotation times a scale: each column by the other two scales.
    for (const auto& row : rotation) {
        for (int column = 0; column < 3; ++column) {
            in.put(row[column] * scale[(column + 1) % 3] * scale[(column + 2) % 3]);
        }
    }
}

void fillFootprint(InputSource& in) {
    in.put(in.logUniform(1e-6, 1e3));
    in.put(in.pick({-1.0, 1.0}) * in.cosine());
}

// Triangles that are no slivers, 1e-3 to 1e3 wide, with a texture that they do not squeeze into a line.
void fillTriangle(InputSource& in) {
    const double width = in.logUniform(1e-3, 1e3);
    in.put(width * in.logUniform(1e-4, 1e2));
    const double turn = in.uniform(0.2, 2.9);
    const double height = in.uniform(0.3, 3.0);
    const double tilt = in.uniform(0.0, 2.0 * std::numbers::pi);
    in.put({width * std::cos(tilt), width * std::sin(tilt), 0.0});
    in.put({width * height * std::cos(turn + tilt), width * height * std::sin(turn + tilt), 0.0});
    const double uvWidth = in.logUniform(1e-3, 10.0);
    in.put(uvWidth * std::cos(turn));
    in.put(uvWidth * std::sin(turn));
    in.put(-uvWidth * height * std::sin(turn));
    in.put(uvWidth * height * std::cos(turn));
    in.put(std::exp2(std::floor(in.uniform(0.0, 14.0))));
    in.put(std::exp2(std::floor(in.uniform(0.0, 14.0))));
}

void fillLight(InputSource& in) {
    const Vector axis = in.direction();
    const double outer = std::cos(in.uniform(0.01, 1.5));
    const double inner = outer + (1.0 - outer) * in.uniform();
    const double scale = 1.0 / std::max(0.001, inner - outer);
    const Vector position{in.uniform(-100.0, 100.0), in.uniform(-100.0, 100.0), in.uniform(-100.0, 100.0)};
    const Vector away = in.direction();
    const double distance = in.chance(0.05) ? in.pick({0.0, 1e-4, 1e-3}) : in.logUniform(1e-2, 1e4);
    in.put(position);
    in.put(in.pick({0.0, 1.0, 2.0}));
    in.put(axis);
    in.put(in.chance(0.5) ? 0.0 : distance * in.logUniform(0.1, 1e3));
    for (int k = 0; k < 3; ++k) {
        in.put(in.colour());
    }
    in.put(scale);
    in.put(-outer * scale);
    in.put({position.x + distance * away.x, position.y + distance * away.y, position.z + distance * away.z});
}

void fillSamples(InputSource& in) {
    in.put(std::floor(in.uniform(0.0, 1e6)));
    in.put(in.logUniform(1e-3, 1e3));
    in.put(100000.0);
    in.put(in.chance(0.5) ? in.pick({0.0, 1.0}) : in.logUniform(1e-4, 1.0));
}

void fillCosineAlpha(InputSource& in) {
    in.put(in.cosine());
    in.put(in.alpha());
}

void fillAlpha(InputSource& in) {
    in.put(in.alpha());
}

void fillCosineSheenAlpha(InputSource& in) {
    in.put(in.cosine());
    in.put(sheenAlpha(in));
}

// A material as evaluateSurface() makes them: energy is shared between metal, diffuse and transmitted light.
struct GivenMaterial {
    double alphaX = 1.0;
    double alphaY = 1.0;
    double eta = 1.5;
};

GivenMaterial putMaterial(InputSource& in, std::uint32_t without = 0) {
    // All lobes but Unlit and SpecularGlossiness, by their bits.
    const auto lobes = static_cast<std::uint32_t>(in.uniform(0.0, 2048.0)) * 4U;
    in.put(in.chance(0.3) ? 0U : lobes & ~without);
    GivenMaterial material;
    material.alphaX = in.alpha();
    material.alphaY = in.chance(0.5) ? material.alphaX : in.alpha();
    material.eta = in.eta();
    const double metal = in.chance(0.5) ? in.pick({0.0, 1.0}) : in.uniform();
    const double transmitted = in.chance(0.5) ? in.pick({0.0, 1.0}) : in.uniform();
    const double through = in.chance(0.5) ? in.pick({0.0, 1.0}) : in.uniform();
    for (int k = 0; k < 3; ++k) {
        in.put(0.04 * (1.0 - metal) + metal * in.colour());
    }
    for (int k = 0; k < 3; ++k) {
        in.put((1.0 - metal) * (1.0 - transmitted) * (1.0 - through) * in.colour());
    }
    in.put(1.0);
    in.put(material.alphaX);
    in.put(material.alphaY);
    for (int k = 0; k < 3; ++k) {
        in.put((1.0 - metal) * transmitted * in.colour());
    }
    const double spread = in.chance(0.5) ? 0.0 : (material.eta - 1.0) * in.uniform(0.0, 0.05);
    in.put({material.eta - spread, material.eta, material.eta + spread});
    for (int k = 0; k < 3; ++k) {
        in.put((1.0 - metal) * (1.0 - transmitted) * through * in.colour());
    }
    in.put(in.colour());
    in.put(in.alpha());
    in.put(in.chance(0.5) ? Vector{} : in.lobeNormal(in.logUniform(1e-6, 1e-3)));
    for (int k = 0; k < 3; ++k) {
        in.put(in.colour());
    }
    in.put(sheenAlpha(in));
    return material;
}

void putMaterialViewLight(InputSource& in, std::uint32_t without) {
    const GivenMaterial material = putMaterial(in, without);
    const Vector view = in.upper();
    in.put(view);
    const double alpha = in.chance(0.5) ? material.alphaX : material.alphaY;
    Vector mirrored = in.mirrored(view, alpha);
    if (in.chance(0.3)) {
        mirrored.z = -mirrored.z;
    }
    in.put(in.chance(0.3)   ? in.direction()
           : in.chance(0.6) ? mirrored
                            : in.refracted(view, alpha, material.eta));
}

void fillBsdf(InputSource& in) {
    putMaterialViewLight(in, 0);
}

void fillBsdfWithoutSheen(InputSource& in) {
    constexpr std::uint32_t kSheen = 1U << static_cast<unsigned>(Feature::Sheen);
    putMaterialViewLight(in, kSheen);
}

void fillBsdfSample(InputSource& in) {
    putMaterial(in);
    in.put(in.upper());
    for (int k = 0; k < 3; ++k) {
        in.put(in.sample());
    }
}

constexpr Probe kProbes[] = {
    {.name = "BuildBasis",
     .function = "buildBasis",
     .inputs = 3,
     .outputs = 6,
     .fill = fillDirection,
     .bounds = kVectorBounds,
     .textbook = "TextbookBuildBasis",
     .textbookAgainstItself = true},
    {.name = "Octahedral",
     .function = "octahedralDecode(octahedralEncode)",
     .inputs = 3,
     .outputs = 3,
     .fill = fillDirection,
     .bounds = kVectorBounds,
     .textbook = "TextbookOctahedral"},
    {.name = "TransformPoint",
     .function = "transformPoint",
     .inputs = 15,
     .outputs = 3,
     .fill = fillTransform,
     .bounds = kVectorBounds,
     .hasScale = true},
    {.name = "RandomUnit",
     .function = "randomUnit",
     .inputs = 5,
     .outputs = 1,
     .fill = fillCounters,
     .bounds = {0.0, 0.0, 0.0}},
    {.name = "AddProduct",
     .function = "addProduct",
     .inputs = 3,
     .outputs = 1,
     .fill = fillSumOfProduct,
     .textbook = "TextbookAddProduct"},
    {.name = "DifferenceOfProducts",
     .function = "differenceOfProducts",
     .inputs = 4,
     .outputs = 1,
     .fill = fillProducts,
     .textbook = "TextbookDifferenceOfProducts"},
    {.name = "AccurateDot",
     .function = "accurateDot",
     .inputs = 6,
     .outputs = 1,
     .fill = fillDirections,
     .bounds = {1e-4, 1e-6, 1e-7},
     .textbook = "TextbookAccurateDot"},
    {.name = "RefractedCosine2",
     .function = "refractedCosine2 (root)",
     .inputs = 2,
     .outputs = 1,
     .fill = fillCriticalAngle,
     .undecidedShare = 1e-4,
     .textbook = "TextbookRefractedCosine2"},
    {.name = "DielectricF0", .function = "dielectricF0", .inputs = 1, .outputs = 1, .fill = fillIor},
    {.name = "FresnelSchlick",
     .function = "fresnelSchlick",
     .inputs = 5,
     .outputs = 3,
     .fill = fillSchlick,
     .textbook = "TextbookFresnelSchlick"},
    {.name = "FresnelInterface",
     .function = "fresnelInterface",
     .inputs = 6,
     .outputs = 3,
     .fill = fillInterface,
     .undecidedShare = 1e-4,
     .textbook = "TextbookFresnelInterface"},
    {.name = "InterfacePassed",
     .function = "interfacePassed",
     .inputs = 6,
     .outputs = 1,
     .fill = fillInterface,
     .undecidedShare = 1e-4,
     .textbook = "TextbookInterfacePassed"},
    {.name = "SchlickF0",
     .function = "schlickF0",
     .inputs = 5,
     .outputs = 3,
     .fill = fillSchlick,
     .bounds = {1e-4, 1e-6, 0.1}},
    {.name = "GgxDistribution",
     .function = "ggxDistribution",
     .inputs = 4,
     .outputs = 1,
     .fill = fillLobeNormal,
     .hasScale = true,
     .textbook = "TextbookGgxDistribution"},
    {.name = "GgxDistributionAnisotropic",
     .function = "ggxDistribution, anisotropic",
     .inputs = 5,
     .outputs = 1,
     .fill = fillLobeNormalAnisotropic,
     .hasScale = true},
    {.name = "GgxVisibility",
     .function = "ggxVisibility",
     .inputs = 7,
     .outputs = 1,
     .fill = fillLightViewAlpha,
     .textbook = "TextbookGgxVisibility"},
    {.name = "GgxVisibilityAnisotropic",
     .function = "ggxVisibility, anisotropic",
     .inputs = 8,
     .outputs = 1,
     .fill = fillLightViewAlphas},
    {.name = "SampleVisibleNormal",
     .function = "sampleVisibleNormal",
     .inputs = 7,
     .outputs = 3,
     .fill = fillVisibleNormal,
     .bounds = kVectorBounds,
     .hasScale = true},
    {.name = "VisibleNormalPdf",
     .function = "visibleNormalPdf",
     .inputs = 8,
     .outputs = 1,
     .fill = fillVisibleNormalPdf,
     .hasScale = true},
    {.name = "SheenDistribution",
     .function = "sheenDistribution",
     .inputs = 2,
     .outputs = 1,
     .fill = fillSheenDistribution},
    {.name = "SheenVisibility",
     .function = "sheenVisibility",
     .inputs = 3,
     .outputs = 1,
     .fill = fillSheenVisibility},
    {.name = "IridescentFresnel",
     .function = "iridescentFresnel",
     .inputs = 6,
     .outputs = 3,
     .fill = fillFilm,
     // Interference cancels: errors count against full reflectance. Near grazing the series of internal
     // reflections magnifies them, by 1e4 at most.
     .bounds = {1e-3, 1e-6, 1.0},
     .undecidedShare = 1e-4},
    {.name = "RefractDirection",
     .function = "refractDirection",
     .inputs = 7,
     .outputs = 3,
     .fill = fillRefraction,
     // Near the critical angle the direction moves by the root of what rounding moves the cosine.
     .bounds = {1e-3, 1e-6, 1.0},
     .undecidedShare = 1e-4},
    {.name = "RefractedTransmission",
     .function = "refractedTransmission",
     .inputs = 9,
     .outputs = 1,
     .fill = fillRefracted,
     // The cosine of facets seen from the side is a difference; there little light passes.
     .bounds = {1e-4, 1e-6, 1e-2},
     .hasScale = true,
     .undecidedShare = 1e-4,
     .textbook = "TextbookRefractedTransmission"},
    {.name = "ThinTransmission",
     .function = "thinTransmission",
     .inputs = 8,
     .outputs = 2,
     .fill = fillThin,
     .undecidedShare = 1e-4},
    {.name = "VolumeTransmittance",
     .function = "volumeTransmittance",
     .inputs = 4,
     .outputs = 3,
     .fill = fillVolume},
    {.name = "DispersedIor", .function = "dispersedIor", .inputs = 2, .outputs = 3, .fill = fillDispersion},
    {.name = "ClearcoatLobe",
     .function = "clearcoatLobe",
     .inputs = 10,
     .outputs = 1,
     .fill = fillClearcoat,
     .undecidedShare = 1e-4,
     .textbook = "TextbookClearcoatLobe"},
    {.name = "DirectionOr",
     .function = "directionOr",
     .inputs = 3,
     .outputs = 3,
     .fill = fillVector,
     .bounds = kVectorBounds},
    {.name = "TransformNormal",
     .function = "transformNormal",
     .inputs = 12,
     .outputs = 3,
     .fill = fillNormalTransform,
     .bounds = kVectorBounds,
     .hasScale = true},
    {.name = "PlaneError", .function = "planeError", .inputs = 36, .outputs = 1, .fill = fillPlane},
    {.name = "ConeFootprint", .function = "coneFootprint", .inputs = 2, .outputs = 1, .fill = fillFootprint},
    {.name = "ConeLod",
     .function = "coneLod (levels)",
     .inputs = 13,
     .outputs = 1,
     .fill = fillTriangle,
     .bounds = kVectorBounds},
    {.name = "SampleLight",
     .function = "sampleLight (irradiance)",
     .inputs = 16,
     .outputs = 3,
     .fill = fillLight,
     // A cone as sharp as 1 / 1000 magnifies what its cosine rounds by as much.
     .bounds = {5e-4, 1e-6, 1.0},
     .hasScale = true},
    {.name = "SampleLightDirection",
     .function = "sampleLight (direction)",
     .inputs = 16,
     .outputs = 3,
     .fill = fillLight,
     .bounds = kVectorBounds},
    {.name = "RunningMean",
     .function = "includeSample (100,000 times)",
     .inputs = 4,
     .outputs = 1,
     .fill = fillSamples,
     .bounds = {1e-6, 1e-6, 1e-6},
     .textbook = "TextbookRunningMean",
     .inputLimit = 128},
    {.name = "GgxAlbedo",
     .function = "ggxAlbedo",
     .inputs = 2,
     .outputs = 2,
     .fill = fillCosineAlpha,
     .bounds = {1e-4, 1e-6, 1e-2}},
    {.name = "GgxMeanAlbedo",
     .function = "ggxMeanAlbedo",
     .inputs = 1,
     .outputs = 2,
     .fill = fillAlpha,
     .bounds = {1e-4, 1e-6, 1e-2}},
    {.name = "SheenAlbedo",
     .function = "sheenAlbedo",
     .inputs = 2,
     .outputs = 1,
     .fill = fillCosineSheenAlpha},
    {.name = "EvaluateBsdf",
     .function = "evaluateBsdf, all lobes but sheen",
     .inputs = 34,
     .outputs = 3,
     .fill = fillBsdfWithoutSheen,
     .hasScale = true},
    {.name = "EvaluateUnderSheen",
     .function = "evaluateBsdf, all lobes",
     .inputs = 34,
     .outputs = 3,
     .fill = fillBsdf,
     // What white sheen leaves for the base near grazing is a difference, 1 - E of nearly 0.
     .bounds = {1e-2, 1e-6, 1e-2},
     .hasScale = true},
    {.name = "BsdfPdf",
     .function = "bsdfPdf, all lobes",
     .inputs = 34,
     .outputs = 1,
     .fill = fillBsdf,
     // Chances are differences near grazing, under sheen, and near the critical angle. Samples follow them as
     // they are: what must hold is the next row.
     .bounds = {1e-3, 1e-6, 1e-2},
     .hasScale = true,
     .undecidedShare = 1e-4},
    {.name = "SampleBsdf",
     .function = "sampleBsdf (weight pdf / value)",
     .inputs = 34,
     .outputs = 1,
     .fill = fillBsdfSample},
};

}  // namespace

std::span<const Probe> allProbes() {
    return kProbes;
}

}  // namespace glint::numerics
