// Reads and writes the values of settings: by the type of the member that holds them, and by hand where
// several members belong together.
#pragma once

#include "settings/descriptor.h"
#include "settings/settings.h"

#include <glint/layers.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <type_traits>
#include <utility>

namespace glint::compiler::values {

inline constexpr std::string_view kAuto = "auto";
inline constexpr std::string_view kNone = "none";
inline constexpr std::string_view kAll = "all";

// Member pointers that lead from Settings to a member of a member.
template <auto First, auto... Rest, typename Object>
auto& memberOf(Object& object) {
    if constexpr (sizeof...(Rest) == 0) {
        return object.*First;
    } else {
        return memberOf<Rest...>(object.*First);
    }
}

template <typename Value>
std::vector<SettingWord> wordsNamed(std::span<const Named<Value>> names) {
    std::vector<SettingWord> words;
    for (const Named<Value>& named : names) {
        words.push_back({std::string(named.name), std::string(named.what)});
    }
    return words;
}

template <typename Value>
std::vector<SettingWord> withAuto(std::span<const Named<Value>> names) {
    std::vector<SettingWord> words = wordsNamed(names);
    words.insert(words.begin(), {std::string(kAuto), ""});
    return words;
}

template <typename Function>
void eachWord(std::string_view list, const Function& function) {
    for (std::size_t begin = 0; begin <= list.size();) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        function(list.substr(begin, end - begin));
        begin = end + 1;
    }
}

template <typename Value>
Value numberOf(std::string_view text) {
    double number = 0.0;
    parseReal(text, std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(), number);
    return static_cast<Value>(number);
}

// A switch.
template <auto... Path>
constexpr SettingValues flag() {
    return {ValueForm::Switch,
            [](const Settings& settings) { return std::string(memberOf<Path...>(settings) ? "on" : "off"); },
            [](Settings& settings, std::string_view text) { memberOf<Path...>(settings) = text == "on"; }};
}

// A boolean or an enumerator by names of its own.
template <const auto& kNames, auto... Path>
constexpr SettingValues named() {
    return {ValueForm::Word,
            [](const Settings& settings) {
                const auto& value = memberOf<Path...>(settings);
                return std::string(
                    std::ranges::find_if(kNames, [&](const auto& one) { return one.value == value; })->name);
            },
            [](Settings& settings, std::string_view text) {
                memberOf<Path...>(settings) =
                    std::ranges::find_if(kNames, [&](const auto& one) { return one.name == text; })->value;
            },
            [] { return wordsNamed<std::remove_cvref_t<decltype(kNames[0].value)>>(kNames); }};
}

template <auto... Path>
constexpr SettingValues enumerator() {
    using Value = std::remove_reference_t<decltype(memberOf<Path...>(std::declval<Settings&>()))>;
    return {ValueForm::Word,
            [](const Settings& settings) { return std::string(nameOf(memberOf<Path...>(settings))); },
            [](Settings& settings, std::string_view text) {
                memberOf<Path...>(settings) = *valueNamed<Value>(text);
            },
            [] { return wordsNamed(namesOf(Value{})); }};
}

// An enumerator, or nothing for "auto".
template <auto... Path>
constexpr SettingValues optional(std::string_view automatic, std::string_view type = {}) {
    using Value =
        typename std::remove_reference_t<decltype(memberOf<Path...>(std::declval<Settings&>()))>::value_type;
    return {.form = ValueForm::Word,
            .text =
                [](const Settings& settings) {
                    const std::optional<Value>& value = memberOf<Path...>(settings);
                    return std::string(value ? nameOf(*value) : kAuto);
                },
            .set = [](Settings& settings,
                      std::string_view text) { memberOf<Path...>(settings) = valueNamed<Value>(text); },
            .words = [] { return withAuto(namesOf(Value{})); },
            .automatic = automatic,
            .type = type};
}

// An enumerator whose member has the value 0 where `Automatic` is set, until something decides.
template <auto Automatic, auto... Path>
constexpr SettingValues decided(std::string_view automatic) {
    using Value = std::remove_reference_t<decltype(memberOf<Path...>(std::declval<Settings&>()))>;
    return {.form = ValueForm::Word,
            .text =
                [](const Settings& settings) {
                    return std::string(settings.*Automatic ? kAuto : nameOf(memberOf<Path...>(settings)));
                },
            .set =
                [](Settings& settings, std::string_view text) {
                    settings.*Automatic = text == kAuto;
                    memberOf<Path...>(settings) = valueNamed<Value>(text).value_or(Value{});
                },
            .words = [] { return withAuto(namesOf(Value{})); },
            .automatic = automatic};
}

template <auto... Path>
constexpr SettingValues number(double min, double max) {
    using Value = std::remove_reference_t<decltype(memberOf<Path...>(std::declval<Settings&>()))>;
    return {.form = std::is_integral_v<Value> ? ValueForm::Whole : ValueForm::Real,
            .text = [](const Settings& settings) { return fmt::format("{}", memberOf<Path...>(settings)); },
            .set = [](Settings& settings,
                      std::string_view text) { memberOf<Path...>(settings) = numberOf<Value>(text); },
            .min = min,
            .max = max};
}

// A number that is written as 0 where there is no limit.
template <auto... Path>
constexpr SettingValues limit(double max) {
    using Value = std::remove_reference_t<decltype(memberOf<Path...>(std::declval<Settings&>()))>;
    return {.form = ValueForm::Real,
            .text =
                [](const Settings& settings) {
                    const Value value = memberOf<Path...>(settings);
                    return fmt::format("{}",
                                       value == std::numeric_limits<Value>::infinity() ? Value{0} : value);
                },
            .set =
                [](Settings& settings, std::string_view text) {
                    const auto value = numberOf<Value>(text);
                    memberOf<Path...>(settings) = value > 0 ? value : std::numeric_limits<Value>::infinity();
                },
            .min = 0.0,
            .max = max};
}

// A number, one value of which has a name.
template <const auto& kNamed, auto... Path>
constexpr SettingValues numberOr(double max, std::string_view type) {
    using Value = std::remove_reference_t<decltype(memberOf<Path...>(std::declval<Settings&>()))>;
    return {.form = ValueForm::Whole,
            .text =
                [](const Settings& settings) {
                    const Value value = memberOf<Path...>(settings);
                    return value == kNamed.value ? std::string(kNamed.name) : fmt::format("{}", value);
                },
            .set =
                [](Settings& settings, std::string_view text) {
                    memberOf<Path...>(settings) = text == kNamed.name ? kNamed.value : numberOf<Value>(text);
                },
            .words = [] { return wordsNamed<Value>(std::span(&kNamed, 1)); },
            .min = 1,
            .max = max,
            .type = type};
}

// A set of bits. `kAdvised`, if it is not null, stands for "auto".
template <typename Value, bool Settings::*kAdvised, auto... Path>
constexpr SettingValues bits(std::string_view automatic = {}) {
    return {.form = ValueForm::List,
            .text =
                [](const Settings& settings) {
                    std::vector<std::string_view> words;
                    if constexpr (kAdvised != nullptr) {
                        if (settings.*kAdvised) {
                            words.push_back(kAuto);
                        }
                    }
                    for (const Named<Value>& one : namesOf(Value{})) {
                        if ((memberOf<Path...>(settings) & one.value) != 0) {
                            words.push_back(one.name);
                        }
                    }
                    return fmt::format("{}", fmt::join(words, ","));
                },
            .set =
                [](Settings& settings, std::string_view text) {
                    std::uint32_t& set = memberOf<Path...>(settings);
                    set = 0;
                    eachWord(text, [&](std::string_view word) {
                        for (const Named<Value>& one : namesOf(Value{})) {
                            set |= word == kAll || word == one.name ? std::uint32_t{one.value} : 0U;
                        }
                        if constexpr (kAdvised != nullptr) {
                            settings.*kAdvised = settings.*kAdvised || word == kAuto;
                        }
                    });
                },
            .words =
                [] {
                    std::vector<SettingWord> words =
                        kAdvised != nullptr ? withAuto(namesOf(Value{})) : wordsNamed(namesOf(Value{}));
                    words.push_back({std::string(kAll), "all of them"});
                    return words;
                },
            .automatic = automatic,
            .type = kAdvised != nullptr ? "auto|all|LIST" : "all|LIST"};
}

inline std::string effectsOf(const Settings& settings) {
    const EffectRequest& request = settings.compile.effects;
    if (!request.automatic && request.named == package::kAllEffects) {
        return std::string(kAll);
    }
    std::vector<std::string_view> words;
    if (request.automatic) {
        words.push_back(kAuto);
    }
    const std::vector<materials::EffectDeclaration>& effects = materials::builtinMaterialModel().effects;
    for (std::size_t i = 0; i < effects.size(); ++i) {
        if ((request.named & infoOf(effects[i], i).effect) != 0) {
            words.push_back(effects[i].name);
        }
    }
    words.insert(words.end(), request.ofPacks.begin(), request.ofPacks.end());
    return words.empty() ? std::string(kNone) : fmt::format("{}", fmt::join(words, ","));
}

inline void setEffects(Settings& settings, std::string_view text) {
    EffectRequest& request = settings.compile.effects;
    request.automatic = false;
    request.named = 0;
    request.ofPacks.clear();
    eachWord(text, [&](std::string_view word) {
        if (word == kAuto || word == kAll || word == kNone) {
            request.automatic = request.automatic || word == kAuto;
            request.named |= word == kAll ? package::kAllEffects : 0U;
        } else if (const package::Effect effect = builtinEffects({word}); effect != 0) {
            request.named |= effect;
        } else {
            request.ofPacks.emplace_back(word);
        }
    });
}

inline std::vector<SettingWord> effectWords() {
    std::vector<SettingWord> words{
        {std::string(kAuto), ""}, {std::string(kNone), "no effect"}, {std::string(kAll), "every effect"}};
    for (const materials::EffectDeclaration& effect : materials::builtinMaterialModel().effects) {
        std::string what = effect.about.substr(0, effect.about.size() - 1);
        what.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(what.front())));
        words.push_back({effect.name, what + (effect.refines.empty() ? "" : "; has to be named")});
    }
    return words;
}

inline std::string hitLobesOf(const Settings& settings) {
    const materials::FeatureMask kept = settings.compile.plan.keys.keptLobes;
    if (kept == materials::kAllFeatures) {
        return std::string(kAll);
    }
    const bool hasBase = (kept & baseLobes()) == baseLobes();
    std::vector<std::string> words =
        materials::builtinMaterialModel().names(hasBase ? kept & ~baseLobes() : kept);
    if (hasBase) {
        words.insert(words.begin(), "base");
    }
    words.insert(words.end(), settings.packLobes.begin(), settings.packLobes.end());
    return fmt::format("{}", fmt::join(words, ","));
}

inline void setHitLobes(Settings& settings, std::string_view text) {
    const materials::MaterialModel& model = materials::builtinMaterialModel();
    materials::FeatureMask& kept = settings.compile.plan.keys.keptLobes;
    kept = 0;
    settings.packLobes.clear();
    eachWord(text, [&](std::string_view word) {
        if (word != kAll && word != "base" && (model.mask(word) & model.lobes) == 0) {
            settings.packLobes.emplace_back(word);
            kept |= model.bases;
            return;
        }
        kept |= word == kAll     ? materials::kAllFeatures
                : word == "base" ? baseLobes()
                                 : model.bases | model.mask(word);
    });
}

// Returns whether a declaration of a pack may have the name.
inline bool isFeatureName(std::string_view text) {
    const auto isLetterOrDigit = [](unsigned char c) { return std::isalnum(c) != 0; };
    return !text.empty() && std::islower(static_cast<unsigned char>(text.front())) != 0 &&
           std::ranges::all_of(text, isLetterOrDigit);
}

inline std::vector<SettingWord> hitLobeWords() {
    const materials::MaterialModel& model = materials::builtinMaterialModel();
    std::vector<SettingWord> words{{std::string(kAll), "as primary surfaces do"},
                                   {"base", fmt::format("{}", fmt::join(model.names(baseLobes()), ", "))}};
    for (std::string& name : model.names(model.lobes)) {
        words.push_back({std::move(name), ""});
    }
    return words;
}

inline constexpr std::string_view kByAddress = "address";  // instead of the number of `tlas`

// Returns "scene-set=0,tlas=0,…".
inline std::string textOf(const package::Bindings& bindings) {
    std::vector<std::string> words;
    for (const package::NamedBinding& one : package::kBindingNames) {
        const std::uint32_t number = bindings.*one.member;
        words.push_back(fmt::format(
            "{}={}", one.name,
            number == package::Bindings::kByAddress ? std::string(kByAddress) : std::to_string(number)));
    }
    return fmt::format("{}", fmt::join(words, ","));
}

// Changes the bindings that `text` names: "scene-set=1,push-offset=16". Returns false, and may have changed
// some, if it is malformed.
inline bool parseBindings(std::string_view text, package::Bindings& bindings) {
    constexpr std::int64_t kMost = 1 << 20;
    bool valid = true;
    eachWord(text, [&](std::string_view word) {
        const std::size_t sign = std::min(word.find('='), word.size());
        const auto* const one =
            std::ranges::find(package::kBindingNames, word.substr(0, sign), &package::NamedBinding::name);
        std::int64_t number = 0;
        valid = valid && one != std::end(package::kBindingNames) && sign < word.size();
        if (valid && one->member == &package::Bindings::tlas && word.substr(sign + 1) == kByAddress) {
            bindings.tlas = package::Bindings::kByAddress;
            return;
        }
        valid = valid && parseWhole(word.substr(sign + 1), 0, kMost, number);
        if (valid) {
            bindings.*one->member = static_cast<std::uint32_t>(number);
        }
    });
    return valid;
}

inline constexpr std::string_view kDefaultBindings = "default";

inline constexpr SettingValues kBindings{
    .form = ValueForm::Text,
    .text =
        [](const Settings& settings) {
            const package::Bindings& bindings = settings.compile.bindings;
            return bindings == package::Bindings() ? std::string(kDefaultBindings) : textOf(bindings);
        },
    .set =
        [](Settings& settings, std::string_view text) {
            settings.compile.bindings = {};
            if (text != kDefaultBindings) {
                parseBindings(text, settings.compile.bindings);
            }
        },
    .words =
        [] {
            return std::vector<SettingWord>{{std::string(kDefaultBindings), "those of Glint's renderer"}};
        },
    .type = "NAME=N,...",
    .accepts =
        [](std::string_view text) {
            package::Bindings bindings;
            return parseBindings(text, bindings);
        },
    .further =
        "list of NAME=N, with the names scene-set, tlas, textures, samplers, environment-set, "
        "environment and push-offset; tlas=address: the engine gives the structure's device address"};

inline constexpr SettingValues kEffects{.form = ValueForm::List,
                                        .text = effectsOf,
                                        .set = setEffects,
                                        .words = effectWords,
                                        .automatic = "those that the scenes call for",
                                        .type = "auto|none|all|LIST",
                                        .accepts = materials::isEffectName,
                                        .further = "effects of packs (--materials)"};

inline std::string layersOf(const Settings& settings) {
    const std::vector<std::string>& layers = settings.compile.layers;
    return layers.empty() ? std::string(kNone) : fmt::format("{}", fmt::join(layers, ","));
}

inline void setLayers(Settings& settings, std::string_view text) {
    settings.compile.layers.clear();
    eachWord(text, [&](std::string_view word) {
        if (word != kNone) {
            settings.compile.layers.emplace_back(word);
        }
    });
}

inline std::vector<SettingWord> layerWords() {
    std::vector<SettingWord> words{
        {std::string(kNone), "no layer"},
        {std::string(kAll), "every layer but the diagnostic ones, which come last"},
        {"surface", "every layer of primary surfaces"},
        {std::string(package::kDirectLight), "every layer of the direct light"}};
    for (const materials::EffectDeclaration& effect : materials::builtinMaterialModel().effects) {
        if (effect.kind == package::EffectInfo::Kind::Rays) {
            words.push_back({effect.name, fmt::format("every layer of the effect {}", effect.name)});
        }
    }
    for (const package::LayerInfo& layer : package::layerTable()) {
        words.push_back({std::string(layer.name), std::string(layer.what)});
    }
    return words;
}

// A word is "EFFECT.LAYER", where the effect may be one of a pack, or the word of an optional layer.
inline bool isLayerWord(std::string_view text) {
    if (text.ends_with(kOptionalLayer)) {
        text.remove_suffix(1);
        if (package::findLayer(text) != nullptr) {
            return true;
        }
    }
    const std::size_t dot = std::min(text.find('.'), text.size());
    const package::LayerInfo* const layer = package::findLayer(text.substr(std::min(dot + 1, text.size())));
    return layer != nullptr && package::hasSources(*layer) && materials::isEffectName(text.substr(0, dot));
}

inline constexpr SettingValues kLayers{
    .form = ValueForm::List,
    .text = layersOf,
    .set = setLayers,
    .words = layerWords,
    .type = "none|all|LIST",
    .accepts = isLayerWord,
    .further = "a layer of one source of light, such as reflection.radiance"};

inline constexpr SettingValues kHitLobes{.form = ValueForm::List,
                                         .text = hitLobesOf,
                                         .set = setHitLobes,
                                         .words = hitLobeWords,
                                         .type = "all|base|LIST",
                                         .accepts = isFeatureName,
                                         .further = "lobes of packs (--materials)"};

inline constexpr SettingValues kMerge{
    .form = ValueForm::Word,
    .text = [](const Settings& settings) { return std::string(nameOf(settings.compile.plan.merge)); },
    .set =
        [](Settings& settings, std::string_view text) {
            const MergeChoice choice = *parseMerge(text);
            settings.compile.plan.merge = choice.policy;
            if (!choice.file.empty()) {
                settings.profile = choice.file;
            }
        },
    .words = [] { return wordsNamed(namesOf(MergePolicy{})); },
    .type = "none|family|all|auto[:FILE]|profile[:FILE]",
    .accepts = [](std::string_view text) { return parseMerge(text).has_value(); },
    .further = "auto:FILE or profile:FILE"};

inline constexpr SettingValues kSize{
    .form = ValueForm::Text,
    .text =
        [](const Settings& settings) {
            return fmt::format("{}x{}", settings.renderer.width, settings.renderer.height);
        },
    .set = [](Settings& settings,
              std::string_view text) { parseSize(text, settings.renderer.width, settings.renderer.height); },
    .type = "WxH",
    .accepts =
        [](std::string_view text) {
            std::uint32_t width = 0;
            std::uint32_t height = 0;
            return parseSize(text, width, height);
        },
    .further = "size such as 960x540, of 1 to 16384 pixels each way and 67108864 in all"};

inline constexpr SettingValues kSky{
    .form = ValueForm::Real,
    .text =
        [](const Settings& settings) {
            return settings.sky ? fmt::format("{}", *settings.sky) : std::string(kAuto);
        },
    .set =
        [](Settings& settings, std::string_view text) {
            settings.sky = text == kAuto ? std::nullopt : std::optional(numberOf<double>(text));
        },
    .words =
        [] {
            return std::vector<SettingWord>{{std::string(kAuto), ""}};
        },
    .max = 1e9,
    .automatic =
        "the sky brings as much light as the scene's lights, and the factor "
        "is 1 if the scene has none",
    .type = "auto|FACTOR"};

inline constexpr Named<std::uint32_t> kNoSteps{0, "off"};
inline constexpr SettingValues kScreenSteps =
    numberOr<kNoSteps, &Settings::frame, &FrameOptions::screenSteps>(1024, "off|N");

inline constexpr SettingValues kLights{
    .form = ValueForm::Whole,
    .text =
        [](const Settings& settings) {
            const std::optional<std::uint32_t> samples = settings.compile.lightSamples;
            return !samples ? std::string("auto") : *samples == 0 ? "all" : fmt::format("{}", *samples);
        },
    .set =
        [](Settings& settings, std::string_view text) {
            settings.compile.lightSamples.reset();
            if (text != "auto") {
                settings.compile.lightSamples = text == "all" ? 0 : numberOf<std::uint32_t>(text);
            }
        },
    .words =
        [] {
            return std::vector<SettingWord>{{"auto",
                                             "all of few lights, and 16 where all cost more; 2 to 8 of the "
                                             "triangles in scenes with emissive lights"},
                                            {"all", "every light"}};
        },
    .min = 1,
    .max = package::kMaxLightSamples,
    .type = "auto|all|K"};

inline constexpr Named<std::uint32_t> kUnlimited{package::kMaxBounces, "unlimited", "64"};
inline constexpr SettingValues kBounces =
    numberOr<kUnlimited, &Settings::compile, &CompileSettings::maxBounces>(package::kMaxBounces,
                                                                           "N|unlimited");

inline constexpr Named<bool> kEnergyNames[] = {{true, "on"}, {false, "off"}};
inline constexpr Named<bool> kTrustNames[] = {
    {true, "on", "textures have the values of their images"},
    {false, "off", "textures may have any values; so with --fallback and --host"},
};
inline constexpr Named<bool> kFalloffNames[] = {
    {false, "none", "all count alike"},
    {true, "linear", "surfaces occlude less the farther away they are; needs --ao-radius"}};

}  // namespace glint::compiler::values
