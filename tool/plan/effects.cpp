#include "plan/effects.h"

#include "plan/key.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

struct Finding {
    bool usable = false;
    std::string reason;
};

// A material as some primitive has it.
struct Surface {
    const materials::Material* material = nullptr;
    const materials::PrimitiveInputs* primitive = nullptr;
};

// Returns each material of the primitives, in the order of materials: once for each set of UV sets that it is
// used with, and for each known content of its textures there.
std::vector<Surface> surfacesOf(std::span<const materials::Material> materials,
                                std::span<const materials::PrimitiveInputs> primitives) {
    using Seen = std::vector<std::pair<int, std::array<materials::ValueInterval, 4>>>;
    std::map<std::tuple<int, bool, bool, Seen>, const materials::PrimitiveInputs*> found;
    for (const materials::PrimitiveInputs& primitive : primitives) {
        Seen seen;
        for (const materials::SeenTexture& texture : primitive.seen) {
            seen.emplace_back(texture.slot, texture.content.of);
        }
        found.try_emplace(
            {primitive.material, primitive.hasTexCoords0, primitive.hasTexCoords1, std::move(seen)},
            &primitive);
    }
    std::vector<Surface> surfaces;
    surfaces.reserve(found.size());
    for (const auto& [key, primitive] : found) {
        surfaces.push_back({&materials[static_cast<std::size_t>(primitive->material)], primitive});
    }
    return surfaces;
}

std::string nameOf(const materials::Material& material) {
    return material.name.empty() ? "a material without a name"
                                 : fmt::format("material \"{}\"", material.name);
}

std::string filledIn(std::string text, std::string_view placeholder, double value) {
    if (const std::size_t place = text.find(placeholder); place != std::string::npos) {
        text.replace(place, placeholder.size(), fmt::format("{:.3g}", value));
    }
    return text;
}

// Returns whether a condition or number may depend on the features of a key.
bool readsKey(const materials::MaterialModel& model, const materials::Expression& expression) {
    using materials::Fact;
    constexpr Fact kOfKeys[] = {Fact::ReadsTexCoord0, Fact::ReadsTexCoord1, Fact::MovesTextures,
                                Fact::NeedsTangents,  Fact::TurnsTangents,  Fact::ChangesOpacity,
                                Fact::ModelOfPack};
    return std::ranges::any_of(expression.symbols(), [&](int symbol) {
        return (symbol >= model.symbolOfFeature(0) && symbol < model.symbolOfTexture(0)) ||
               std::ranges::any_of(kOfKeys, [&](Fact fact) { return symbol == model.symbolOf(fact); });
    });
}

// Evaluates the declared behaviours of one surface. Its key is made only if one of them asks for it, because
// few do.
class SurfaceBehaviour {
public:
    explicit SurfaceBehaviour(const Surface& surface)
        : material_(*surface.material),
          primitive_(*surface.primitive),
          facts_(material_, *surface.primitive, options_, key_),
          blind_(material_, *surface.primitive, options_, key_, materials::MaterialFacts::Textures::Unknown),
          factors_(material_, *surface.primitive, options_, key_,
                   materials::MaterialFacts::Textures::Ignored) {}

    // Returns why the surface may behave so, or an empty text. A rougher reflection than `limit` does not
    // count.
    std::string why(materials::Behaviour behaviour, double limit) const {
        for (const int index : rules()) {
            const materials::BehaviourRule& rule = ruleAt(index);
            if (rule.does != behaviour || !holds(rule)) {
                continue;
            }
            if (!rule.roughness) {
                const double value = rule.value ? rule.value->number(factors_).of[0].high : 0.0;
                return filledIn(rule.text, "{}", value);
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

    // Returns which textures keep the reflection rougher than `limit`, in words, or an empty text if it is
    // rougher with any contents.
    std::string roughenedBy(double limit) const {
        for (const int index : rules()) {
            const materials::BehaviourRule& rule = ruleAt(index);
            if (rule.roughness && holds(rule) && rule.roughness->number(blind_).of[0].low <= limit &&
                rule.roughness->number(facts_).of[0].low > limit) {
                return whatTexturesHold(material_, primitive_, *rule.roughness, HeldBy::All);
            }
        }
        return {};
    }

    bool has(int feature) const {
        return feature < 0 || key().has(material_.model().features[static_cast<std::size_t>(feature)].bit);
    }

    double leastRoughness() const {
        double least = materials::kUnlimited;
        for (const int index : rules()) {
            const materials::BehaviourRule& rule = ruleAt(index);
            if (rule.roughness && holds(rule)) {
                least = std::min(least, rule.roughness->number(factors_).of[0].low);
            }
        }
        return least;
    }

private:
    const materials::BehaviourRule& ruleAt(int index) const {
        return material_.model().behaviours[static_cast<std::size_t>(index)];
    }
    // Returns the rules of what the material has, in their order.
    std::vector<int> rules() const {
        const materials::MaterialModel& model = material_.model();
        std::vector<int> rules = model.commonBehaviours;
        for (const int object : material_.given) {
            const std::vector<int>& own = model.objects[static_cast<std::size_t>(object)].behaviours;
            rules.insert(rules.end(), own.begin(), own.end());
        }
        std::ranges::sort(rules);
        return rules;
    }
    const materials::FeatureMask& key() const {
        if (!hasKey_) {
            key_ = makeKey(material_, primitive_, {.alpha = package::AlphaPolicy::Tested});
            hasKey_ = true;
        }
        return key_;
    }
    bool holds(const materials::BehaviourRule& rule) const {
        if (!material_.reads(rule.object)) {
            return false;
        }
        const materials::MaterialModel& model = material_.model();
        if (readsKey(model, rule.when) || (rule.roughness && readsKey(model, *rule.roughness)) ||
            (rule.value && readsKey(model, *rule.value))) {
            key();
        }
        return rule.when.holds(facts_) != materials::Certainty::False;
    }

    const materials::Material& material_;
    const materials::PrimitiveInputs& primitive_;
    materials::KeyOptions options_{};
    mutable bool hasKey_ = false;
    mutable materials::FeatureMask key_;  // the facts read it
    materials::MaterialFacts facts_;
    materials::MaterialFacts blind_;  // ignores the contents of textures
    materials::MaterialFacts factors_;
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

// Returns the first surface that is rough by its textures alone, as an addition to a reason.
std::string roughTextures(std::span<const Surface> surfaces, double limit) {
    for (const Surface& surface : surfaces) {
        if (surface.material->isUnlit()) {
            continue;
        }
        if (const std::string held = SurfaceBehaviour(surface).roughenedBy(limit); !held.empty()) {
            return fmt::format(" (by what textures hold: {}: {})", nameOf(*surface.material), held);
        }
    }
    return {};
}

// Returns the first surface whose model samples directions itself, as an addition to a reason: the effect of
// surfaces that scatter sends its rays, whatever its lobes are.
std::string sampledModel(std::span<const Surface> surfaces) {
    for (const Surface& surface : surfaces) {
        const materials::MaterialModel& model = surface.material->model();
        const auto sender =
            std::ranges::find_if(model.effects, [](const materials::EffectDeclaration& effect) {
                return effect.kind == package::EffectInfo::Kind::Rays && !effect.call.byAll &&
                       effect.call.behaviour == materials::Behaviour::Scatters;
            });
        const SurfaceBehaviour behaviour(surface);
        const auto code = std::ranges::find_if(model.code, [&](const materials::FeatureCode& one) {
            return one.isSampled && behaviour.has(one.feature);
        });
        if (sender != model.effects.end() && code != model.code.end()) {
            return fmt::format(" ({} has the model {}, whose rays are those of {})",
                               nameOf(*surface.material), code->name, sender->name);
        }
    }
    return {};
}

Finding find(const materials::EffectDeclaration& effect, std::span<const Surface> surfaces,
             const SceneLights& lights, const EffectRequest& request) {
    const double limit = request.maxReflectionRoughness;
    const materials::EffectCall& call = effect.call;
    if (call.lights && !lights.lit) {
        return {false, "no light shines"};
    }
    Finding finding =
        findSurface(surfaces, filledIn(call.otherwise, "{limit}", limit), [&](const Surface& surface) {
            return call.byAll ? call.because : SurfaceBehaviour(surface).why(call.behaviour, limit);
        });
    if (!finding.usable && !call.byAll && call.behaviour == materials::Behaviour::Reflects) {
        finding.reason += roughTextures(surfaces, limit);
    }
    if (!finding.usable && !call.byAll && call.behaviour != materials::Behaviour::Scatters) {
        finding.reason += sampledModel(surfaces);
    }
    return finding;
}

const materials::MaterialModel& modelOf(std::span<const materials::Material> materials) {
    return materials.empty() ? materials::builtinMaterialModel() : materials.front().model();
}

// Returns the bits of the effects that the user requests.
std::uint32_t namedEffects(const EffectRequest& request, const materials::MaterialModel& model) {
    std::uint32_t named = request.named;
    for (const std::string& name : request.ofPacks) {
        named |= findEffect(model.effects, name);
    }
    return named;
}

}  // namespace

std::uint32_t builtinEffects(std::initializer_list<std::string_view> names) {
    std::uint32_t bits = 0;
    for (const std::string_view name : names) {
        bits |= materials::findEffect(materials::builtinMaterialModel().effects, name);
    }
    return bits;
}

bool sendsRays(const materials::EffectDeclaration& effect, const materials::Material& material,
               const materials::PrimitiveInputs& primitive, float maxReflectionRoughness) {
    const Surface alone[] = {{&material, &primitive}};
    EffectRequest request;
    request.maxReflectionRoughness = maxReflectionRoughness;
    return effect.kind == package::EffectInfo::Kind::Rays && find(effect, alone, {}, request).usable;
}

bool isEmitter(const materials::Material& material, const materials::PrimitiveInputs& primitive) {
    const SurfaceBehaviour behaviour({&material, &primitive});
    if (material.isUnlit() || behaviour.why(materials::Behaviour::Emits, 0.0).empty()) {
        return false;
    }
    return std::ranges::none_of(material.model().code, [&](const materials::FeatureCode& code) {
        return code.isOfPack && !(code.emission.empty() && code.coordinates.empty()) &&
               behaviour.has(code.feature);
    });
}

bool passesLight(const materials::Material& material, const materials::PrimitiveInputs& primitive) {
    return !material.isUnlit() &&
           !SurfaceBehaviour({&material, &primitive}).why(materials::Behaviour::Transmits, 1.0).empty();
}

double leastRoughness(const materials::Material& material, const materials::PrimitiveInputs& primitive) {
    return SurfaceBehaviour({&material, &primitive}).leastRoughness();
}

EffectPlan decideEffects(std::span<const materials::Material> materials,
                         std::span<const materials::PrimitiveInputs> primitives, const SceneLights& lights,
                         const EffectRequest& request) {
    const std::vector<Surface> surfaces = surfacesOf(materials, primitives);
    const materials::MaterialModel& model = modelOf(materials);
    const std::uint32_t allNamed = namedEffects(request, model);
    EffectPlan plan;
    for (std::size_t i = 0; i < model.effects.size(); ++i) {
        const materials::EffectDeclaration& effect = model.effects[i];
        const package::EffectInfo info = infoOf(effect, i);
        Finding finding = find(effect, surfaces, lights, request);
        const bool named = (allNamed & info.effect) != 0;
        // Every lit surface could use these effects, and no file requests them.
        const bool refines = !effect.refines.empty();
        EffectDecision decision{info.effect, effect.name,    named && request.named != package::kAllEffects,
                                false,       finding.usable, std::move(finding.reason)};
        decision.chosen = named || (request.automatic && decision.usable && !refines);
        if (named) {
            decision.reason = (decision.usable ? "asked for: " : "asked for, though ") + decision.reason;
        } else if (!request.automatic) {
            decision.reason = "not asked for";
        } else if (decision.usable && refines) {
            decision.reason =
                fmt::format("refines {}; no file asks for it, so it has to be named", effect.refines);
        }
        if (decision.chosen) {
            plan.effects.add(info);
        }
        plan.decisions.push_back(std::move(decision));
    }
    return plan;
}

}  // namespace glint::compiler
