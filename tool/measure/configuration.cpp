#include "emit/effects.h"
#include "gltf/import.h"
#include "gltf/scene_list.h"

#include <glint/measure/render_settings.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <span>
#include <variant>

namespace glint::measure {

namespace {

using List = std::vector<std::string>;
// The variable that holds an argument.
using Place = std::variant<std::string*, std::int64_t*, double*, bool*, List*>;

struct Argument {
    std::string_view name;
    Place (*place)(RenderSettings& render);
};

constexpr Argument kArguments[] = {
    {"spp", [](RenderSettings& a) -> Place { return &a.samples; }},
    {"shadow-spp", [](RenderSettings& a) -> Place { return &a.effectFrame.shadowSamples; }},
    {"ao-spp", [](RenderSettings& a) -> Place { return &a.effectFrame.occlusionSamples; }},
    {"effects", [](RenderSettings& a) -> Place { return &a.effects.effects; }},
    {"max-roughness", [](RenderSettings& a) -> Place { return &a.effects.maxRoughness; }},
    {"mirror-roughness", [](RenderSettings& a) -> Place { return &a.frame.mirrorRoughness; }},
    {"skip-below", [](RenderSettings& a) -> Place { return &a.effectFrame.skipBelow; }},
    {"clamp", [](RenderSettings& a) -> Place { return &a.frame.clamp; }},
    {"ssr", [](RenderSettings& a) -> Place { return &a.frame.ssr; }},
    {"max-interfaces", [](RenderSettings& a) -> Place { return &a.effectFrame.maxInterfaces; }},
    {"hit-lobes", [](RenderSettings& a) -> Place { return &a.plan.hitLobes; }},
    {"energy-compensation", [](RenderSettings& a) -> Place { return &a.accuracy.energyCompensation; }},
    {"texture-lod", [](RenderSettings& a) -> Place { return &a.accuracy.textureLod; }},
    {"precision", [](RenderSettings& a) -> Place { return &a.accuracy.precision; }},
    {"alpha", [](RenderSettings& a) -> Place { return &a.plan.alpha; }},
    {"hit-record", [](RenderSettings& a) -> Place { return &a.tracing.hitRecord; }},
    {"strategy", [](RenderSettings& a) -> Place { return &a.tracing.strategies.front(); }},
    {"merge", [](RenderSettings& a) -> Place { return &a.plan.merge; }},
    {"shadows", [](RenderSettings& a) -> Place { return &a.tracing.shadows; }},
    {"position-fetch", [](RenderSettings& a) -> Place { return &a.tracing.positionFetch; }},
    {"ordering", [](RenderSettings& a) -> Place { return &a.frame.ordering; }},
    {"binning", [](RenderSettings& a) -> Place { return &a.frame.binning; }},
    {"batch-effects", [](RenderSettings& a) -> Place { return &a.effectFrame.batch; }},
};

std::string textOf(const Place& place) {
    struct Visitor {
        std::string operator()(const std::string* text) const {
            return *text;
        }
        std::string operator()(const std::int64_t* number) const {
            return fmt::format("{}", *number);
        }
        std::string operator()(const double* number) const {
            return fmt::format("{}", *number);
        }
        std::string operator()(const bool* flag) const {
            return *flag ? "on" : "off";
        }
        std::string operator()(const List* words) const {
            return fmt::format("{}", fmt::join(*words, ","));
        }
    };
    return std::visit(Visitor{}, place);
}

void setText(const Place& place, const std::string& text) {
    struct Visitor {
        const std::string& given;
        void operator()(std::string* text) const {
            *text = given;
        }
        void operator()(std::int64_t* number) const {
            std::from_chars(given.data(), given.data() + given.size(), *number);
        }
        void operator()(double* number) const {
            std::from_chars(given.data(), given.data() + given.size(), *number);
        }
        void operator()(bool* flag) const {
            *flag = given == "on";
        }
        void operator()(List* words) const {
            words->clear();
            for (std::size_t begin = 0; begin <= given.size();) {
                const std::size_t end = std::min(given.find(',', begin), given.size());
                words->push_back(given.substr(begin, end - begin));
                begin = end + 1;
            }
        }
    };
    std::visit(Visitor{text}, place);
}

// Returns whether hits of any primitive lose a lobe if they keep only those of the base.
bool losesLobes(const Scene& scene, const PlanOptions& plan) {
    PlanSettings base;
    base.hitLobes = {"base"};
    const FeatureMask kept = base.options().keys.keptLobes;
    const std::vector<PrimitiveInputs> primitives = planningInputs(scene);
    return std::ranges::any_of(primitives, [&](const PrimitiveInputs& inputs) {
        const Material& material = scene.materials[static_cast<std::size_t>(inputs.material)];
        return (makeKey(material, inputs, plan.keys) & kLobeMask & ~kept) != 0;
    });
}

}  // namespace

RenderSettings usualSettings() {
    RenderSettings render;
    render.tracing.strategies = {"visibility"};
    render.tracing.tracers = {"auto"};
    return render;
}

Configuration configurationOf(const RenderSettings& render) {
    RenderSettings copy = render;
    Configuration configuration;
    for (const Argument& argument : kArguments) {
        configuration.emplace(argument.name, textOf(argument.place(copy)));
    }
    return configuration;
}

RenderSettings withSettings(RenderSettings render, const Configuration& configuration) {
    for (const Argument& argument : kArguments) {
        const auto value = configuration.find(argument.name);
        if (value != configuration.end()) {
            setText(argument.place(render), value->second);
        }
    }
    return render;
}

Facts factsOf(const RenderSettings& render, const Scene& scene, const PlanOptions& plan) {
    Facts facts;
    facts.masks = std::ranges::any_of(
        scene.materials, [](const Material& material) { return material.alphaMode == AlphaMode::Mask; });
    facts.furtherLobes = losesLobes(scene, plan);
    facts.textures = !scene.textures.empty();
    const CompileSettings settings = compileSettings(render, plan, package::kAllTracers, scene);
    const std::uint32_t effects = planEffects(SceneList({&scene, 1}), settings).effects;
    for (const package::EffectInfo& info : package::kEffects) {
        if ((effects & info.effect) != 0) {
            facts.effects.emplace(info.name);
        }
    }
    const scene_view::SceneViewData data = sceneView(render, scene);
    facts.sizedLights =
        std::ranges::any_of(data.lights, [](const LightView& light) { return light.size > 0.0F; });
    return facts;
}

std::vector<std::string> wordsOf(const Configuration& configuration) {
    std::vector<std::string> words;
    for (const std::string& name : settingNames()) {
        const auto value = configuration.find(name);
        if (value == configuration.end() || (isSwitch(name) && value->second == "off")) {
            continue;
        }
        words.push_back("--" + name);
        if (!isSwitch(name)) {
            words.push_back(value->second);
        }
    }
    return words;
}

bool isSwitch(std::string_view setting) {
    RenderSettings render = usualSettings();
    const Argument* const found = std::ranges::find(kArguments, setting, &Argument::name);
    return found != std::end(kArguments) && std::holds_alternative<bool*>(found->place(render));
}

}  // namespace glint::measure
