#include "domains.h"
#include "materials/material_model.h"

#include <algorithm>
#include <cmath>

namespace glint::numerics {

void fillIor(InputSource& in) {
    in.put(in.ior());
}

namespace {

void fillColour(InputSource& in) {
    for (int k = 0; k < 3; ++k) {
        in.put(in.colour());
    }
}

// Writes reflectances at normal incidence, and one at grazing, which is not smaller.
void fillReflectances(InputSource& in) {
    double largest = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double f0 = in.colour();
        in.put(f0);
        largest = std::max(largest, f0);
    }
    in.put(in.chance(0.5) ? 1.0 : largest);
}

}  // namespace

void fillSchlick(InputSource& in) {
    fillReflectances(in);
    in.put(in.cosine());
}

// Half of the inputs come from the denser side, and are then often near the critical angle.
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

namespace {

// Returns alpha as sheen has it: the square of a roughness of at least 0.07.
double sheenAlpha(InputSource& in) {
    return in.chance(0.1) ? in.pick({5e-3, 1.0}) : in.logUniform(5e-3, 1.0);
}

}  // namespace

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

// Writes a coat whose normal leans away from z, and light that mirrors the view about it.
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

void fillCosineAlpha(InputSource& in) {
    in.put(in.cosine());
    in.put(in.alpha());
}

void fillAlpha(InputSource& in) {
    in.put(in.alpha());
}

// Writes the alphas of an anisotropic lobe, the larger one first.
void fillAlphas(InputSource& in) {
    const double across = in.alpha();
    in.put(in.chance(0.2) ? across : std::max(in.alpha(), across));
    in.put(across);
}

void fillViewAlphas(InputSource& in) {
    in.put(in.upper());
    fillAlphas(in);
}

void fillCosineSheenAlpha(InputSource& in) {
    in.put(in.cosine());
    in.put(sheenAlpha(in));
}

namespace {

// A material as evaluateSurface() makes it: metal, diffuse and transmitted light share the energy.
struct GivenMaterial {
    double alphaX = 1.0;
    double alphaY = 1.0;
    double eta = 1.5;
    double metal = 0.0;
};

GivenMaterial putMaterial(InputSource& in, std::uint32_t without = 0) {
    // The bits cover all lobes except Unlit and SpecularGlossiness.
    const auto lobes = static_cast<std::uint32_t>(in.uniform(0.0, 2048.0)) * 4U;
    in.put(in.chance(0.3) ? 0U : lobes & ~without);
    GivenMaterial material;
    // KHR_materials_anisotropy: the alpha along the direction is the larger one.
    material.alphaY = in.alpha();
    material.alphaX = in.chance(0.5) ? material.alphaY : std::max(in.alpha(), material.alphaY);
    material.eta = in.eta();
    const double metal = in.chance(0.5) ? in.pick({0.0, 1.0}) : in.uniform();
    const double transmitted = in.chance(0.5) ? in.pick({0.0, 1.0}) : in.uniform();
    const double through = in.chance(0.5) ? in.pick({0.0, 1.0}) : in.uniform();
    material.metal = metal;
    for (int k = 0; k < 3; ++k) {
        const double colour = in.colour();
        in.put(metal == 1.0 ? colour : 0.04);
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

// The metal of a material that has both bases; of others nothing reads it.
void putMetal(InputSource& in, const GivenMaterial& material) {
    in.put({in.colour(), in.colour(), in.colour()});
    in.put(material.metal);
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
    putMetal(in, material);
}

}  // namespace

void fillBsdf(InputSource& in) {
    putMaterialViewLight(in, 0);
}

// The same, with the light above the surface.
void fillBsdfReflection(InputSource& in) {
    const GivenMaterial material = putMaterial(in);
    const Vector view = in.upper();
    in.put(view);
    in.put(in.chance(0.3) ? in.upper()
                          : in.mirrored(view, in.chance(0.5) ? material.alphaX : material.alphaY));
    putMetal(in, material);
}

void fillBsdfWithoutSheen(InputSource& in) {
    putMaterialViewLight(
        in, static_cast<std::uint32_t>(materials::builtinMaterialModel().mask("sheen").shared()));
}

void fillBsdfSample(InputSource& in) {
    const GivenMaterial material = putMaterial(in);
    in.put(in.upper());
    for (int k = 0; k < 3; ++k) {
        in.put(in.sample());
    }
    putMetal(in, material);
}

}  // namespace glint::numerics
