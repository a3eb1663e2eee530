#include "emit/effects.h"

#include "emit/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace glint::compiler {

namespace mustache = kainjow::mustache;

namespace {

// Each effect has pairs of dimensions of the sequence (hit/sequence.glsl) of its own. Those below belong to
// Glint's shaders.
constexpr std::size_t kFirstPair = 1024;
constexpr std::size_t kPairsOfEffect = 4;

// At rest, or at a time of an animation.
bool isLit(const gltf::Scene& scene) {
    return std::ranges::any_of(scene.lights,
                               [](const gltf::Light& light) { return light.shines() || light.canShine; });
}

}  // namespace

EffectPlan planEffects(const gltf::SceneList& scenes, const CompileSettings& settings) {
    const bool lit = settings.addsLight || settings.emissiveLights == EmissiveLights::On ||
                     settings.skyLight == SkyLight::On || std::ranges::any_of(scenes.scenes(), isLit);
    EffectPlan plan = decideEffects(scenes.materials(), scenes.primitives(), {lit}, settings.effects);
    if (settings.passes == package::Passes::Steps) {
        // The host decides which surfaces send rays. What hits need of the effects is their shadow rays.
        const bool lights = settings.answer == package::HitAnswer::Radiance;
        const std::vector<materials::EffectDeclaration>& declared =
            scenes.materials().empty() ? materials::builtinMaterialModel().effects
                                       : scenes.materials().front().model().effects;
        plan.effects = effectSetOf(declared, lights ? plan.effects.lights : 0U);
        for (EffectDecision& decision : plan.decisions) {
            if (decision.chosen && (plan.effects.all & decision.effect) == 0) {
                decision.chosen = false;
                decision.reason = "the steps of a host's own rays have no effects but the shadows of hits";
            }
        }
    }
    return plan;
}

std::string effectDefines(const materials::MaterialModel& model, const package::EffectSet& effects) {
    std::string text;
    std::string bits;
    for (std::size_t i = 0; i < model.effects.size(); ++i) {
        const materials::EffectDeclaration& effect = model.effects[i];
        const package::Effect bit = infoOf(effect, i).effect;
        text += fmt::format("#define GLINT_EFFECT_{} {}\n", effect.macro(), (effects.all & bit) != 0 ? 1 : 0);
        if ((effects.rays & bit) != 0) {
            text +=
                fmt::format("#define GLINT_SLOT_{} {}u\n", effect.macro(), package::effectSlot(effects, bit));
        }
        if ((effects.all & bit) != 0) {
            text +=
                fmt::format("#define GLINT_PAIRS_{} {}u\n", effect.macro(), kFirstPair + kPairsOfEffect * i);
        }
        bits += fmt::format("const uint kEffect{} = {}u;\n", effect.function(), bit);
    }
    text += fmt::format("#define GLINT_EFFECT_COUNT {}u\n", package::countedEffects(effects));
    text += fmt::format("#define GLINT_RAY_EFFECTS {}\n", package::effectSlots(effects));
    text += fmt::format("#define GLINT_STARTS_ON_SCREEN {}\n", effects.screenStarts != 0 ? 1 : 0);
    return text + bits;
}

void addEffect(mustache::data& context, const materials::MaterialModel& model,
               const package::EffectSet& effects, std::size_t number) {
    const materials::EffectDeclaration& effect = model.effects[number];
    const auto file = [](const std::string& name) {
        return name.empty() ? mustache::data(false) : mustache::data(name);
    };
    context.set("name", effect.name);
    context.set("function", effect.function());
    context.set("bit", fmt::format("kEffect{}", effect.function()));
    context.set("main", effect.main());
    context.set("sharesLights", mustache::data(effect.sharesLights));
    context.set("walk", mustache::data((effects.walks & infoOf(effect, number).effect) != 0));
    context.set("compose", file(effect.compose));
    context.set("hit", file(effect.hit));
    context.set("start", effect.start.empty() ? "effects/plain_start.glsl" : effect.start);
    context.set("slot", fmt::format("{}", package::effectSlot(effects, infoOf(effect, number).effect)));
}

void addEffects(mustache::data& context, const Plan& plan) {
    const package::EffectSet& effects = plan.effects.effects;
    const auto list = [&](std::uint32_t bits) {
        mustache::data entries(mustache::data::type::list);
        package::forEachEffect(bits, [&](std::uint32_t number) {
            mustache::data entry;
            addEffect(entry, *plan.model, effects, number);
            addLayersOf(entry, plan, 1U << number);
            entries.push_back(entry);
        });
        return entries;
    };
    context.set("effects", list(effects.all));
    context.set("surfaceEffects", list(effects.surfaces));
    context.set("rayEffects", list(effects.rays));
}

}  // namespace glint::compiler
