#include "emit/effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace glint {

namespace mustache = kainjow::mustache;

namespace {

// At rest, or at a time of an animation.
bool isLit(const Scene& scene) {
    return std::ranges::any_of(scene.lights,
                               [](const Light& light) { return light.shines() || light.canShine; });
}

std::string upperCase(std::string_view name) {
    std::string text(name);
    std::ranges::transform(text, text.begin(), [](char c) {
        return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    });
    return text;
}

mustache::data entryOf(std::uint32_t effects, const package::EffectInfo& info) {
    mustache::data entry;
    addEffect(entry, effects, info.effect);
    return entry;
}

}  // namespace

EffectPlan planEffects(const SceneList& scenes, const CompileSettings& settings) {
    const bool lit = settings.addsLight || std::ranges::any_of(scenes.scenes(), isLit);
    EffectPlan plan = decideEffects(scenes.materials(), scenes.primitives(), {lit}, settings.effects);
    if (settings.passes == package::Passes::Steps) {
        // The host decides which surfaces send rays. What hits need of the effects is their shadow rays.
        const bool lights = settings.answer == package::HitAnswer::Radiance;
        plan.effects &= lights ? package::kEffectShadow : 0U;
        for (EffectDecision& decision : plan.decisions) {
            if (decision.chosen && (plan.effects & decision.effect) == 0) {
                decision.chosen = false;
                decision.reason = "the steps of a host's own rays have no effects but the shadows of hits";
            }
        }
    }
    return plan;
}

std::string effectDefines(std::uint32_t effects) {
    std::string text;
    for (const package::EffectInfo& info : package::kEffects) {
        const std::string name = upperCase(info.file);
        const bool chosen = (effects & info.effect) != 0;
        text += fmt::format("#define GLINT_EFFECT_{} {}\n", name, chosen ? 1 : 0);
        if (chosen && info.kind == package::EffectKind::Rays) {
            text +=
                fmt::format("#define GLINT_SLOT_{} {}u\n", name, package::effectSlot(effects, info.effect));
        }
    }
    return text;
}

void addEffect(mustache::data& context, std::uint32_t effects, package::Effect effect) {
    const package::EffectInfo& info = package::effectInfo(effect);
    context.set("name", std::string(info.name));
    context.set("file", std::string(info.file));
    context.set("function", std::string(info.function));
    context.set("bit", fmt::format("kEffect{}", info.function));
    context.set("start", info.screenStart ? fmt::format("{}_start", info.file) : "plain_start");
    context.set("slot", fmt::format("{}", package::effectSlot(effects, effect)));
}

void addEffects(mustache::data& context, std::uint32_t effects) {
    mustache::data all(mustache::data::type::list);
    mustache::data surface(mustache::data::type::list);
    mustache::data rays(mustache::data::type::list);
    for (const package::EffectInfo& info : package::kEffects) {
        if ((effects & info.effect) == 0) {
            continue;
        }
        all.push_back(entryOf(effects, info));
        if (info.kind == package::EffectKind::Surface) {
            surface.push_back(entryOf(effects, info));
        }
        if (info.kind == package::EffectKind::Rays) {
            rays.push_back(entryOf(effects, info));
        }
    }
    context.set("effects", all);
    context.set("surfaceEffects", surface);
    context.set("rayEffects", rays);
}

}  // namespace glint
