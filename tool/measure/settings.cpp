#include "base/files.h"
#include "base/json.h"
#include "base/text.h"
#include "resolve/light.h"

#include <glint/measure/settings.h>
#include <glint/session/session.h>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

namespace glint::measure {

namespace {

// Returns `--effects` for everything that rays find: the effects that the scene calls for, those that refine
// the light of the sky by rays, and those of packs that the user names. Effects that approximate the light of
// rays are left out.
std::string rayEffects(const compiler::EffectRequest& request) {
    std::string words = "auto";
    for (const materials::EffectDeclaration& effect : materials::builtinMaterialModel().effects) {
        if (effect.kind == package::EffectInfo::Kind::Rays && !effect.refines.empty()) {
            words += "," + effect.name;
        }
    }
    for (const std::string& name : request.ofPacks) {
        words += "," + name;
    }
    return words;
}

std::set<std::string, std::less<>> namesOfChosen(const compiler::EffectPlan& plan) {
    std::set<std::string, std::less<>> names;
    for (const compiler::EffectDecision& decision : plan.decisions) {
        if (decision.chosen) {
            names.insert(decision.name);
        }
    }
    return names;
}

// Adds what packages of the same scenes would have with other settings.
void addAlternatives(const compiler::Build& build, compiler::BenchFacts& facts) {
    compiler::CompileSettings asked = build.settings.compile;
    asked.emissiveLights = build.asked.compile.emissiveLights;
    asked.skyLight = build.asked.compile.skyLight;
    asked.sizedLights = build.asked.compile.sizedLights;
    asked.lightSamples.reset();
    const compiler::EffectPlan ofLit = planEffects(*build.scenes, asked, true);
    // No change but that of the roughness matters to the effects.
    const auto planWith = [&](const auto& change) {
        compiler::CompileSettings settings = asked;
        change(settings);
        return planLight(*build.scenes, settings, ofLit);
    };
    facts.lightsMayEmit =
        planWith([](auto& settings) { settings.emissiveLights = compiler::EmissiveLights::On; }).ok();
    facts.skyMayLight = planWith([](auto& settings) { settings.skyLight = compiler::SkyLight::On; }).ok();
    facts.sizedMayShow =
        planWith([](auto& settings) { settings.sizedLights = compiler::SizedLights::On; }).ok();
    compiler::CompileSettings anyRoughness = asked;
    anyRoughness.effects.maxReflectionRoughness = 1.0F;
    if (const auto plan = planLight(*build.scenes, anyRoughness)) {
        facts.effectsOfAnyRoughness = namesOfChosen(plan->effects);
        facts.manyLights = plan->samples > 0;
    }
    const auto one = planWith([](auto& settings) { settings.maxBounces = 1; });
    const auto several = planWith([](auto& settings) { settings.maxBounces = 2; });
    facts.bouncesLight =
        one && several &&
        (one->emissive != several->emissive || one->sky != several->sky || one->sized != several->sized);
}

constexpr std::string_view kMaxRoughness = "max-roughness";

std::vector<std::string> valuesToTry(const compiler::Descriptor& row, const compiler::BenchFacts& facts,
                                     const std::string& base, bool quick) {
    const compiler::SettingBench& bench = row.bench;
    if (bench.triedFor != nullptr) {
        return bench.triedFor(facts, base, quick);
    }
    std::vector<std::string> values;
    std::istringstream given(std::string(quick && !bench.quick.empty() ? bench.quick : bench.tried));
    for (std::string value; given >> value;) {
        values.push_back(value);
    }
    if (values.empty()) {
        for (compiler::SettingWord& word : wordsOf(row)) {
            values.push_back(std::move(word.name));
        }
    }
    return values;
}

bool isNumber(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789.e-") == std::string::npos;
}

// Inserts a value if it is missing: a number by its size, behind a word at the front ("off", "all") and
// before one at the end ("unlimited"); a word at the front.
void insertValue(std::vector<std::string>& values, const std::string& value) {
    if (std::ranges::find(values, value) != values.end()) {
        return;
    }
    const auto isBefore = [&](const std::string& other) {
        return std::strtod(other.c_str(), nullptr) < std::strtod(value.c_str(), nullptr);
    };
    auto at = values.begin();
    while (isNumber(value) && at != values.end() && (isNumber(*at) ? isBefore(*at) : at == values.begin())) {
        ++at;
    }
    values.insert(at, value);
}

// Returns why the setting changes nothing: the default lacks the effects that it belongs to. A higher limit
// of roughness may itself call for reflections, and does in a full reference.
std::string withoutEffects(const compiler::Descriptor& row, compiler::BenchFacts facts) {
    if (row.name == kMaxRoughness && facts.fullTransport) {
        facts.effects = facts.effectsOfAnyRoughness;
    }
    return compiler::withoutEffect(row.name, facts);
}

bool ordersHits(std::string_view strategy) {
    const std::optional<package::Strategy> named = valueNamed<package::Strategy>(strategy);
    return named && (*named & package::orderedStrategies()) != 0;
}

}  // namespace

compiler::BenchFacts factsOf(const compiler::Build& build, std::size_t index) {
    const gltf::Scene& scene = build.scenes->scenes()[index];
    const gltf::SceneList::Range range = build.scenes->primitivesOf(index);
    const compiler::Settings& settings = build.settings;
    compiler::BenchFacts facts;
    facts.masks = std::ranges::any_of(scene.materials, [](const materials::Material& material) {
        return material.alphaMode != materials::AlphaMode::Opaque;
    });
    for (std::size_t i = range.first; i < range.first + range.count; ++i) {
        const materials::PrimitiveInputs& primitive = build.scenes->primitives()[i];
        const materials::Material& material =
            build.scenes->materials()[static_cast<std::size_t>(primitive.material)];
        facts.passesLight = facts.passesLight || material.alphaMode == materials::AlphaMode::Blend ||
                            compiler::passesLight(material, primitive);
        // Hits that keep only the lobes of the base lose a lobe.
        const materials::FeatureMask further =
            materials::builtinMaterialModel().lobes & ~compiler::baseLobes();
        facts.furtherLobes = facts.furtherLobes || (build.plan.primaryMaskOfPrimitive[i] & further) != 0;
    }
    facts.textures = !scene.textures.empty();
    facts.effects = namesOfChosen(build.plan.effects);
    facts.sendsRays =
        build.plan.effects.effects.rays != 0 || build.settings.compile.passes == package::Passes::Steps;
    facts.rayEffects = rayEffects(settings.compile.effects);
    facts.emits = compiler::countEmitters(*build.scenes, index) > 0;
    addAlternatives(build, facts);
    const session::SceneViewData data = session::sceneView(settings, scene);
    facts.punctualLights = !data.lights.empty();
    const auto directional = std::ranges::count(data.lights, LightView::Type::Directional, &LightView::type);
    facts.directionalLights = directional > 0;
    facts.placedLights = static_cast<std::size_t>(directional) < data.lights.size();
    const compiler::LightCounts counts = countLights(*build.scenes, index, settings.compile.emissiveLights);
    facts.lights = counts.positions + counts.emitters;
    facts.sizedLights =
        std::ranges::any_of(data.lights, [](const LightView& light) { return light.size > 0.0F; });
    return facts;
}

std::vector<Setting> settingsFor(const compiler::BenchFacts& facts, const compiler::Configuration& base,
                                 bool quick) {
    const compiler::Configuration exact = exactValues(facts);
    std::vector<Setting> settings;
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        const auto own = base.find(row.name);
        if (row.bench.use != compiler::BenchUse::Swept || own == base.end()) {
            continue;
        }
        Setting setting{.name = std::string(row.name),
                        .what = row.what,
                        .isCompiled = isCompiled(row),
                        .approximates = row.bench.exact.has_value(),
                        .base = own->second};
        const auto reasonAgainst = [&](std::string_view value) {
            return row.bench.against != nullptr ? row.bench.against(value, facts, base) : std::string();
        };
        std::vector<std::string> values = valuesToTry(row, facts, setting.base, quick);
        insertValue(values, setting.base);
        const auto truth = exact.find(row.name);
        if (truth != exact.end() && truth->second != setting.base) {
            setting.exact = truth->second;
            insertValue(values, setting.exact);
        }
        const std::string noEffect = withoutEffects(row, facts);
        const std::string reasonForAll = noEffect.empty() ? reasonAgainst("") : noEffect;
        for (std::string& value : values) {
            std::string reason = value == setting.base  ? std::string()
                                 : reasonForAll.empty() ? reasonAgainst(value)
                                                        : reasonForAll;
            if (reason.empty()) {
                setting.values.push_back(std::move(value));
            } else {
                setting.skipped.push_back({std::move(value), std::move(reason)});
            }
        }
        settings.push_back(std::move(setting));
    }
    return settings;
}

bool hasExactValue(const Setting& setting) {
    return !setting.exact.empty() && std::ranges::find(setting.values, setting.exact) != setting.values.end();
}

compiler::Configuration exactValues(const compiler::BenchFacts& facts) {
    compiler::Configuration exact;
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        const compiler::SettingBench& bench = row.bench;
        const bool isSwept = bench.use == compiler::BenchUse::Swept;
        if (!isSwept || !bench.exact || (bench.isTransport && !facts.fullTransport)) {
            continue;
        }
        std::string value = bench.exactFor != nullptr ? bench.exactFor(facts) : std::string(*bench.exact);
        if (!value.empty()) {
            exact.emplace(row.name, std::move(value));
        }
    }
    // A higher limit of roughness would call for reflections, which are part of all transport alone.
    if (!facts.fullTransport && !compiler::withoutEffect(kMaxRoughness, facts).empty()) {
        exact.erase(std::string(kMaxRoughness));
    }
    return exact;
}

compiler::Configuration simplified(const compiler::Configuration& configuration,
                                   const compiler::Configuration& base) {
    compiler::Configuration rest = configuration;
    const std::string strategy = valueOf("strategy", configuration, base);
    if (!ordersHits(strategy)) {
        rest.erase("ordering");
        rest.erase("hit-record");
    } else {
        rest.erase("position-fetch");
    }
    std::erase_if(rest, [&base](const auto& choice) {
        const auto own = base.find(choice.first);
        return own != base.end() && own->second == choice.second;
    });
    return rest;
}

const std::string& valueOf(std::string_view name, const compiler::Configuration& configuration,
                           const compiler::Configuration& base) {
    const auto own = configuration.find(name);
    return own != configuration.end() ? own->second : base.find(name)->second;
}

std::string nameOf(const compiler::Configuration& configuration) {
    std::string name;
    for (const std::string& setting : compiler::settingNames()) {
        const auto own = configuration.find(setting);
        if (own != configuration.end()) {
            name += fmt::format("{}{} {}", name.empty() ? "" : ", ", setting, own->second);
        }
    }
    return name.empty() ? "default" : name;
}

// --- Files of settings ---

namespace {

constexpr const char* kSettingsFormat = "glint-settings";
constexpr int kSettingsVersion = 1;

// Returns a number, a switch or a text as a word of the command line, or nothing for other values.
std::optional<std::string> settingText(const base::Json& value) {
    if (value.is_string()) {
        return value.get<std::string>();
    }
    if (value.is_boolean()) {
        return value.get<bool>() ? "on" : "off";
    }
    return value.is_number() ? std::optional(value.dump()) : std::nullopt;
}

}  // namespace

Diagnostic settingsError(const std::filesystem::path& file, const std::string& pointer,
                         const std::string& message, const std::string& hint) {
    return makeError("settings-file", pointer.empty() ? file.string() : file.string() + "#" + pointer,
                     message, hint);
}

std::string settingsText(const compiler::Configuration& settings, const std::string& origin) {
    base::Json values = base::Json::object();
    for (const std::string& name : compiler::settingNames()) {
        const auto value = settings.find(name);
        if (value != settings.end()) {
            values[name] = value->second;
        }
    }
    return base::toText(base::Json{{"format", kSettingsFormat},
                                   {"version", kSettingsVersion},
                                   {"origin", origin},
                                   {"settings", std::move(values)}});
}

Result<compiler::Configuration> readSettings(const std::filesystem::path& file) {
    constexpr std::uint64_t kMostBytes = 1U << 20;
    GLINT_TRY(const auto bytes, base::readFile(file, kMostBytes));
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    constexpr const char* kHint = "give a file that `glint bench --budget-ms` or --max-error wrote";
    const base::Json json =
        base::nestsTooDeep(bytes) ? base::Json() : base::Json::parse(text, nullptr, false);
    if (!json.is_object() || json.value("format", base::Json()) != base::Json(kSettingsFormat) ||
        !json.contains("settings") || !json["settings"].is_object()) {
        return settingsError(file, "", "is no file of settings", kHint);
    }
    if (json.value("version", base::Json()) != base::Json(kSettingsVersion)) {
        return settingsError(file, "/version", fmt::format("is not {}", kSettingsVersion),
                             "this glint reads that version");
    }
    compiler::Configuration settings;
    const std::vector<std::string> names = compiler::settingNames();
    for (const auto& [name, value] : json["settings"].items()) {
        const std::string pointer = "/settings/" + name;
        if (std::ranges::find(names, name) == names.end()) {
            return settingsError(file, pointer, "is no setting" + base::suggestion(name, names),
                                 "leave it out, or see docs/cli.md for those there are");
        }
        std::optional<std::string> word = settingText(value);
        if (!word || word->empty()) {
            return settingsError(file, pointer, "is neither a text nor a number",
                                 fmt::format("write it as on the command line, behind --{}", name));
        }
        settings.emplace(name, std::move(*word));
    }
    return settings;
}

}  // namespace glint::measure
