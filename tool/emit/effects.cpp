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

}  // namespace

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
