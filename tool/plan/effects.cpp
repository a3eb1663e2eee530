#include "plan/effects.h"

#include "plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace glint {

namespace {

using package::Effect;

struct Finding {
    bool usable = false;
    std::string reason;
};

// A material as some primitive has it.
struct Surface {
    const Material* material = nullptr;
    const PrimitiveInputs* primitive = nullptr;
};

// Returns each material of the primitives once for each set of UV sets that it is used with, in the order of
// materials.
std::vector<Surface> surfacesOf(std::span<const Material> materials,
                                std::span<const PrimitiveInputs> primitives) {
    std::map<std::tuple<int, bool, bool>, const PrimitiveInputs*> found;
    for (const PrimitiveInputs& primitive : primitives) {
        found.try_emplace({primitive.material, primitive.hasTexCoords0, primitive.hasTexCoords1}, &primitive);
    }
    std::vector<Surface> surfaces;
    for (const auto& [key, primitive] : found) {
        surfaces.push_back({&materials[static_cast<std::size_t>(primitive->material)], primitive});
    }
    return surfaces;
}

std::string nameOf(const Material& material) {
    return material.name.empty() ? "a material without a name"
                                 : fmt::format("material \"{}\"", material.name);
}

std::string filledIn(std::string text, std::string_view placeholder, double value) {
    if (const std::size_t place = text.find(placeholder); place != std::string::npos) {
        text.replace(place, placeholder.size(), fmt::format("{:.3g}", value));
    }
    return text;
}

// Evaluates the declared behaviours of one surface.
class SurfaceBehaviour {
public:
    explicit SurfaceBehaviour(const Surface& surface)
        : material_(*surface.material),
          key_(makeKey(material_, *surface.primitive, {.alpha = AlphaPolicy::Tested})),
          facts_(material_, *surface.primitive, options_, key_),
          factors_(material_, *surface.primitive, options_, key_, MaterialFacts::Textures::Ignored) {}

    // Returns why the surface may behave so, or an empty text. A rougher reflection than `limit` does not
    // count.
    std::string why(Behaviour behaviour, double limit) const {
        for (const BehaviourRule& rule : material_.model().behaviours) {
            if (rule.does != behaviour || !holds(rule)) {
                continue;
            }
            if (!rule.roughness) {
                const double value = rule.value ? rule.value->number(factors_).of[0].high : 0.0;
                return rule.text.empty() ? std::string(kDefaultText) : filledIn(rule.text, "{}", value);
            }
            const double factor = rule.roughness->number(factors_).of[0].low;
            if (rule.roughness->number(facts_).of[0].low <= limit) {
                const bool byTexture = factor > limit && !rule.textureText.empty();
                return filledIn(filledIn(byTexture ? rule.textureText : rule.text, "{}", factor), "{limit}",
                                limit);
            }
        }
        return {};
    }

    double leastRoughness() const {
        double least = kUnlimited;
        for (const BehaviourRule& rule : material_.model().behaviours) {
            if (rule.roughness && holds(rule)) {
                least = std::min(least, rule.roughness->number(factors_).of[0].low);
            }
        }
        return least;
    }

private:
    static constexpr std::string_view kDefaultText = "scatters light diffusely";

    bool holds(const BehaviourRule& rule) const {
        return material_.reads(rule.object) && rule.when.holds(facts_) != Certainty::False;
    }

    const Material& material_;
    KeyOptions options_{};
    FeatureMask key_;
    MaterialFacts facts_;
    MaterialFacts factors_;
};

// Finds the first lit surface for which why(surface) gives a reason.
template <typename Why>
Finding findSurface(std::span<const Surface> surfaces, const std::string& none, const Why& why) {
    bool anyLit = false;
    for (const Surface& surface : surfaces) {
        if (surface.material->isUnlit()) {
            continue;
        }
        anyLit = true;
        if (const std::string reason = why(surface); !reason.empty()) {
            return {true, fmt::format("{} {}", nameOf(*surface.material), reason)};
        }
    }
    return {false, surfaces.empty() ? "nothing has a surface" : anyLit ? none : "every material is unlit"};
}

Finding find(Effect effect, std::span<const Surface> surfaces, const SceneLights& lights,
             const EffectRequest& request) {
    const double limit = request.maxReflectionRoughness;
    const auto behaves = [&](Behaviour behaviour, const std::string& none) {
        return findSurface(surfaces, none, [&](const Surface& surface) {
            return SurfaceBehaviour(surface).why(behaviour, limit);
        });
    };
    const auto always = [&](const char* reason) {
        return findSurface(surfaces, "", [reason](const Surface&) { return std::string(reason); });
    };
    switch (effect) {
        case package::kEffectShadow:
            return lights.lit ? always("is lit by punctual lights") : Finding{false, "no light shines"};
        case package::kEffectAmbientOcclusion:
            return always("is lit by the sky");
        case package::kEffectReflection:
            return behaves(Behaviour::Reflects,
                           fmt::format("no surface is smoother than the roughness limit {:.3g}", limit));
        case package::kEffectRefraction:
            return behaves(Behaviour::Transmits, "no material transmits light");
        default:
            return behaves(Behaviour::Scatters, "no material scatters light diffusely");
    }
}

// These effects refine the sky's light. Every lit surface could use them, and no file asks for them.
constexpr std::uint32_t kRefinements = package::kEffectAmbientOcclusion | package::kEffectIndirectDiffuse;

}  // namespace

bool sendsRays(package::Effect effect, const Material& material, const PrimitiveInputs& primitive,
               float maxReflectionRoughness) {
    const Surface alone[] = {{&material, &primitive}};
    EffectRequest request;
    request.maxReflectionRoughness = maxReflectionRoughness;
    return package::effectInfo(effect).kind == package::EffectKind::Rays &&
           find(effect, alone, {}, request).usable;
}

double leastRoughness(const Material& material, const PrimitiveInputs& primitive) {
    return SurfaceBehaviour({&material, &primitive}).leastRoughness();
}

EffectPlan decideEffects(std::span<const Material> materials, std::span<const PrimitiveInputs> primitives,
                         const SceneLights& lights, const EffectRequest& request) {
    const std::vector<Surface> surfaces = surfacesOf(materials, primitives);
    EffectPlan plan;
    plan.effects = 0;
    for (const package::EffectInfo& info : package::kEffects) {
        Finding finding = find(info.effect, surfaces, lights, request);
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
