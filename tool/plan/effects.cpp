#include "plan/effects.h"

#include <fmt/format.h>

#include <algorithm>

namespace glint {

namespace {

using package::Effect;

struct Finding {
    bool usable = false;
    std::string reason;
};

std::string nameOf(const Material& material) {
    return material.name.empty() ? "a material without a name"
                                 : fmt::format("material \"{}\"", material.name);
}

bool hasTexture(const Material& material, TextureSlot slot) {
    return material.texture(slot).texture >= 0;
}

// Returns whether no channel of a linear factor is above 0.
template <typename Color>
bool isBlack(const Color& color) {
    return color[0] <= 0.0F && color[1] <= 0.0F && color[2] <= 0.0F;
}

// Finds the first material for which `test` holds; its reason becomes the reason of the decision.
template <typename Test>
Finding findMaterial(std::span<const Material* const> materials, const std::string& none, const Test& test) {
    for (const Material* const material : materials) {
        if (material->unlit) {
            continue;
        }
        if (std::string why = test(*material); !why.empty()) {
            return {true, fmt::format("{} {}", nameOf(*material), why)};
        }
    }
    const bool unlit =
        std::ranges::all_of(materials, [](const Material* material) { return material->unlit; });
    return {false, materials.empty() ? "nothing has a surface" : unlit ? "every material is unlit" : none};
}

bool isMetal(const Material& material) {
    return material.metallicFactor >= 1.0F && !hasTexture(material, TextureSlot::MetallicRoughness) &&
           !material.specularGlossiness.given;
}

// Returns whether the microfacets of a material can reflect at all; an extension may take that away.
bool reflects(const Material& material) {
    if (material.specularGlossiness.given) {
        return !isBlack(material.specularGlossiness.specularFactor);
    }
    if (material.metallicFactor > 0.0F && !isBlack(material.baseColorFactor)) {
        return true;
    }
    // At grazing angles the whole specular factor is reflected, whatever its colour and the index of
    // refraction.
    return material.specular.factor > 0.0F;
}

std::string smoothness(const Material& material, float limit) {
    // A texture may make the surface smoother than its factor, but not rougher.
    const bool glossy = material.specularGlossiness.given;
    const float roughness =
        glossy ? 1.0F - material.specularGlossiness.glossinessFactor : material.roughnessFactor;
    const bool textured = hasTexture(material, TextureSlot::MetallicRoughness);
    const bool varies = textured && (glossy ? false : roughness > 0.0F);
    if (reflects(material) && (roughness <= limit || (glossy && textured && roughness <= limit))) {
        return fmt::format("has the roughness {:.3g}, at most {:.3g}", roughness, limit);
    }
    if (reflects(material) && varies) {
        return fmt::format("has a texture of roughness, which may be at most {:.3g}", limit);
    }
    const Clearcoat& coat = material.clearcoat;
    if (coat.factor > 0.0F &&
        (coat.roughnessFactor <= limit || hasTexture(material, TextureSlot::ClearcoatRoughness))) {
        return fmt::format("has a coat of roughness {:.3g}", coat.roughnessFactor);
    }
    return {};
}

std::string transmission(const Material& material) {
    if (material.transmission.factor > 0.0F && !isMetal(material) && !isBlack(material.baseColorFactor)) {
        return fmt::format("transmits {:.3g} of the light", material.transmission.factor);
    }
    return {};
}

std::string diffuse(const Material& material) {
    const bool base =
        !isMetal(material) && !isBlack(material.baseColorFactor) && material.transmission.factor < 1.0F;
    const bool back = material.diffuseTransmission.factor > 0.0F &&
                      !isBlack(material.diffuseTransmission.colorFactor) && !isMetal(material);
    return base || back ? "scatters light diffusely" : std::string();
}

Finding findShadow(std::span<const Material* const> materials, const SceneLights& lights) {
    if (!lights.lit) {
        return {false, "no light shines"};
    }
    return findMaterial(materials, "",
                        [](const Material&) { return std::string("is lit by punctual lights"); });
}

Finding find(Effect effect, std::span<const Material* const> materials, const SceneLights& lights,
             const EffectRequest& request) {
    switch (effect) {
        case package::kEffectShadow:
            return findShadow(materials, lights);
        case package::kEffectAmbientOcclusion:
            return findMaterial(materials, "",
                                [](const Material&) { return std::string("is lit by the sky"); });
        case package::kEffectReflection:
            return findMaterial(materials,
                                fmt::format("no surface is smoother than the roughness limit {:.3g}",
                                            request.maxReflectionRoughness),
                                [&](const Material& material) {
                                    return smoothness(material, request.maxReflectionRoughness);
                                });
        case package::kEffectRefraction:
            return findMaterial(materials, "no material transmits light", transmission);
        default:
            return findMaterial(materials, "no material scatters light diffusely", diffuse);
    }
}

// These effects refine the sky's light. Every lit surface could use them, and no file asks for them.
constexpr std::uint32_t kRefinements = package::kEffectAmbientOcclusion | package::kEffectIndirectDiffuse;

}  // namespace

bool sendsRays(package::Effect effect, const Material& material, float maxReflectionRoughness) {
    const Material* const alone[] = {&material};
    EffectRequest request;
    request.maxReflectionRoughness = maxReflectionRoughness;
    return package::effectInfo(effect).kind == package::EffectKind::Rays &&
           find(effect, alone, {}, request).usable;
}

EffectPlan decideEffects(std::span<const Material* const> materials, const SceneLights& lights,
                         const EffectRequest& request) {
    EffectPlan plan;
    plan.effects = 0;
    for (const package::EffectInfo& info : package::kEffects) {
        Finding finding = find(info.effect, materials, lights, request);
        EffectDecision decision{info.effect, false, finding.usable, std::move(finding.reason)};
        const bool named = (request.named & info.effect) != 0;
        const bool refines = (kRefinements & info.effect) != 0;
        decision.chosen = named || (request.automatic && decision.usable && !refines);
        if (named) {
            decision.reason = (decision.usable ? "asked for: " : "asked for, though ") + decision.reason;
        } else if (!request.automatic) {
            decision.reason = "not asked for";
        } else if (decision.usable && refines) {
            decision.reason = "refines the sky's light; no file asks for it, so it has to be named";
        }
        if (decision.chosen) {
            plan.effects |= info.effect;
        }
        plan.decisions.push_back(std::move(decision));
    }
    return plan;
}

}  // namespace glint
