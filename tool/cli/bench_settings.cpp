#include "cli/bench_settings.h"

#include "cli/render_setup.h"
#include "emit/effects.h"
#include "gltf/import.h"
#include "gltf/scene_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <span>
#include <variant>

namespace glint {

namespace {

using List = std::vector<std::string>;
// The variable that holds an argument.
using Place = std::variant<std::string*, std::int64_t*, double*, bool*, List*>;

struct Argument {
    std::string_view name;
    Place (*place)(RenderArguments& arguments);
};

constexpr Argument kArguments[] = {
    {"spp", [](RenderArguments& a) -> Place { return &a.samples; }},
    {"shadow-spp", [](RenderArguments& a) -> Place { return &a.effectFrame.shadowSamples; }},
    {"ao-spp", [](RenderArguments& a) -> Place { return &a.effectFrame.occlusionSamples; }},
    {"effects", [](RenderArguments& a) -> Place { return &a.effects.effects; }},
    {"max-roughness", [](RenderArguments& a) -> Place { return &a.effects.maxRoughness; }},
    {"mirror-roughness", [](RenderArguments& a) -> Place { return &a.frame.mirrorRoughness; }},
    {"skip-below", [](RenderArguments& a) -> Place { return &a.effectFrame.skipBelow; }},
    {"clamp", [](RenderArguments& a) -> Place { return &a.frame.clamp; }},
    {"ssr", [](RenderArguments& a) -> Place { return &a.frame.ssr; }},
    {"max-interfaces", [](RenderArguments& a) -> Place { return &a.effectFrame.maxInterfaces; }},
    {"hit-lobes", [](RenderArguments& a) -> Place { return &a.plan.hitLobes; }},
    {"energy-compensation", [](RenderArguments& a) -> Place { return &a.accuracy.energyCompensation; }},
    {"texture-lod", [](RenderArguments& a) -> Place { return &a.accuracy.textureLod; }},
    {"precision", [](RenderArguments& a) -> Place { return &a.accuracy.precision; }},
    {"alpha", [](RenderArguments& a) -> Place { return &a.plan.alpha; }},
    {"hit-record", [](RenderArguments& a) -> Place { return &a.tracing.hitRecord; }},
    {"strategy", [](RenderArguments& a) -> Place { return &a.tracing.strategies.front(); }},
    {"merge", [](RenderArguments& a) -> Place { return &a.plan.merge; }},
    {"shadows", [](RenderArguments& a) -> Place { return &a.tracing.shadows; }},
    {"position-fetch", [](RenderArguments& a) -> Place { return &a.tracing.positionFetch; }},
    {"ordering", [](RenderArguments& a) -> Place { return &a.frame.ordering; }},
    {"binning", [](RenderArguments& a) -> Place { return &a.frame.binning; }},
    {"batch-effects", [](RenderArguments& a) -> Place { return &a.effectFrame.batch; }},
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
    PlanArguments base;
    base.hitLobes = {"base"};
    const FeatureMask kept = base.options().keys.keptLobes;
    const std::vector<PrimitiveInputs> primitives = planningInputs(scene);
    return std::ranges::any_of(primitives, [&](const PrimitiveInputs& inputs) {
        const Material& material = scene.materials[static_cast<std::size_t>(inputs.material)];
        return (makeKey(material, inputs, plan.keys) & kLobeMask & ~kept) != 0;
    });
}

}  // namespace

RenderArguments usualArguments() {
    RenderArguments arguments;
    arguments.tracing.strategies = {"visibility"};
    arguments.tracing.tracers = {"auto"};
    return arguments;
}

bench::Configuration configurationOf(const RenderArguments& arguments) {
    RenderArguments copy = arguments;
    bench::Configuration configuration;
    for (const Argument& argument : kArguments) {
        configuration.emplace(argument.name, textOf(argument.place(copy)));
    }
    return configuration;
}

RenderArguments withSettings(RenderArguments arguments, const bench::Configuration& configuration) {
    for (const Argument& argument : kArguments) {
        const auto value = configuration.find(argument.name);
        if (value != configuration.end()) {
            setText(argument.place(arguments), value->second);
        }
    }
    return arguments;
}

bench::Facts factsOf(const RenderArguments& arguments, const Scene& scene, const PlanOptions& plan) {
    bench::Facts facts;
    facts.masks = std::ranges::any_of(
        scene.materials, [](const Material& material) { return material.alphaMode == AlphaMode::Mask; });
    facts.furtherLobes = losesLobes(scene, plan);
    facts.textures = !scene.textures.empty();
    const CompileSettings settings = compileSettings(arguments, plan, package::kAllTracers, scene);
    const std::uint32_t effects = planEffects(SceneList({&scene, 1}), settings).effects;
    for (const package::EffectInfo& info : package::kEffects) {
        if ((effects & info.effect) != 0) {
            facts.effects.emplace(info.name);
        }
    }
    const SceneViewData data = sceneView(arguments, scene);
    facts.sizedLights =
        std::ranges::any_of(data.lights, [](const LightView& light) { return light.size > 0.0F; });
    return facts;
}

std::vector<std::string> wordsOf(const bench::Configuration& configuration) {
    std::vector<std::string> words;
    for (const std::string& name : bench::settingNames()) {
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
    RenderArguments arguments = usualArguments();
    const Argument* const found = std::ranges::find(kArguments, setting, &Argument::name);
    return found != std::end(kArguments) && std::holds_alternative<bool*>(found->place(arguments));
}

}  // namespace glint
