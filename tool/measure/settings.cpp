#include <glint/measure/settings.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace glint::measure {

namespace {

using Values = std::span<const std::string_view>;

constexpr std::array<std::string_view, 7> kSamples{"1", "2", "4", "8", "16", "32", "64"};
constexpr std::array<std::string_view, 4> kFewSamples{"1", "2", "4", "8"};
constexpr std::array<std::string_view, 5> kShadowSamples{"1", "2", "4", "8", "16"};
constexpr std::array<std::string_view, 2> kFewShadowSamples{"1", "4"};
constexpr std::array<std::string_view, 5> kRoughness{"0.1", "0.2", "0.3", "0.6", "1"};
constexpr std::array<std::string_view, 3> kFewRoughness{"0.1", "0.3", "1"};
constexpr std::array<std::string_view, 4> kMirrors{"0", "0.05", "0.1", "0.2"};
constexpr std::array<std::string_view, 2> kFewMirrors{"0.05", "0.2"};
constexpr std::array<std::string_view, 4> kBounds{"0", "0.01", "0.05", "0.2"};
constexpr std::array<std::string_view, 2> kFewBounds{"0", "0.05"};
constexpr std::array<std::string_view, 5> kSteps{"off", "8", "16", "32", "64"};
constexpr std::array<std::string_view, 2> kFewSteps{"off", "16"};
constexpr std::array<std::string_view, 5> kInterfaces{"2", "4", "8", "16", "32"};
constexpr std::array<std::string_view, 2> kFewInterfaces{"2", "8"};
constexpr std::array<std::string_view, 2> kEnergy{"on", "off"};
constexpr std::array<std::string_view, 2> kLod{"cones", "mip0"};
constexpr std::array<std::string_view, 2> kLobes{"all", "base"};
constexpr std::array<std::string_view, 2> kAlpha{"tested", "opaque"};
constexpr std::array<std::string_view, 2> kPrecision{"32", "16"};
constexpr std::array<std::string_view, 2> kRecord{"full", "packed"};
constexpr std::array<std::string_view, 2> kShadows{"inline", "deferred"};
constexpr std::array<std::string_view, 2> kSwitch{"off", "on"};
constexpr std::array<std::string_view, 4> kMerge{"none", "family", "all", "auto"};
constexpr std::array<std::string_view, 4> kStrategy{"uber", "visibility", "sorted-uber", "hit-shaders"};
constexpr std::array<std::string_view, 3> kBinning{"none", "sign", "octahedral"};
constexpr std::array<std::string_view, 6> kOrdering{
    "auto", "global-atomics", "wave-loop", "wave-aggregated", "wave-ballot", "local-histogram"};
constexpr std::array<std::string_view, 2> kFewOrderings{"auto", "local-histogram"};

struct Row {
    std::string_view name;
    std::string_view what;
    Stage stage;
    // The value in the reference. It is empty for the default's value, because the user asks for that value
    // or all values converge to the same picture. It is absent if the setting changes time alone.
    std::optional<std::string_view> exact;
    Values values;
    Values few;  // the values with `quick`
};

// The values of `clamp` and `effects` depend on the scene.
constexpr Row kRows[] = {
    {"spp", "samples a pixel", Stage::Render, "", kSamples, kFewSamples},
    {"shadow-spp", "shadow rays per sample to each light that has a size", Stage::Render, "", kShadowSamples,
     kFewShadowSamples},
    {"ao-spp", "rays per sample of ambient occlusion", Stage::Render, "", kShadowSamples, kFewShadowSamples},
    {"effects", "which effects the picture has", Stage::Compile, "", {}, {}},
    {"max-roughness", "rougher surfaces send no reflection ray", Stage::Render, "1", kRoughness,
     kFewRoughness},
    {"mirror-roughness", "smoother surfaces reflect as mirrors", Stage::Render, "0", kMirrors, kFewMirrors},
    {"skip-below", "rays below this weight are not sent", Stage::Render, "0", kBounds, kFewBounds},
    {"clamp", "the most luminance that a ray adds", Stage::Render, "0", {}, {}},
    {"ssr", "steps in screen space before a ray", Stage::Render, "off", kSteps, kFewSteps},
    {"max-interfaces", "the most surfaces that a refracted ray meets", Stage::Render, "64", kInterfaces,
     kFewInterfaces},
    {"hit-lobes", "lobes of materials that hits keep", Stage::Compile, "all", kLobes, kLobes},
    {"energy-compensation", "light that microfacets scatter more than once", Stage::Compile, "on", kEnergy,
     kEnergy},
    {"texture-lod", "levels of textures that are read", Stage::Compile, "mip0", kLod, kLod},
    {"alpha", "alpha masks of hits", Stage::Compile, "tested", kAlpha, kAlpha},
    {"precision", "bits of shading's floating point", Stage::Compile, "32", kPrecision, kPrecision},
    {"hit-record", "what is kept of a hit between passes", Stage::Compile, "full", kRecord, kRecord},
    {"strategy", "how hits are shaded", Stage::Compile, std::nullopt, kStrategy, kStrategy},
    {"merge", "which permutations share a shader", Stage::Compile, std::nullopt, kMerge, kMerge},
    {"shadows", "where shadow rays of hits are traced", Stage::Compile, std::nullopt, kShadows, kShadows},
    {"position-fetch", "positions from acceleration structures", Stage::Compile, std::nullopt, kSwitch,
     kSwitch},
    {"ordering", "how hits are sorted by shader", Stage::Render, std::nullopt, kOrdering, kFewOrderings},
    {"binning", "how the rays of a workgroup are sorted", Stage::Render, std::nullopt, kBinning, kBinning},
    {"batch-effects", "the hits of all effects shaded together", Stage::Render, std::nullopt, kSwitch,
     kSwitch},
};

bool ordersHits(std::string_view strategy) {
    return strategy == "visibility" || strategy == "sorted-uber";
}

// Returns the default's effects, and further values that leave out one effect each.
std::vector<std::string> effectValues(const Facts& facts, const std::string& base) {
    std::vector<std::string> values{base};
    for (const std::string& without : facts.effects) {
        std::vector<std::string> rest;
        for (const std::string& effect : facts.effects) {
            if (effect != without) {
                rest.push_back(effect);
            }
        }
        values.push_back(rest.empty() ? "none" : fmt::format("{}", fmt::join(rest, ",")));
    }
    return values;
}

// Returns multiples of white, rounded to three digits.
std::vector<std::string> clampValues(const Facts& facts, bool quick) {
    std::vector<std::string> values{"0"};
    for (const double times : {16.0, 4.0, 1.0}) {
        if (facts.white > 0.0 && (!quick || times == 1.0)) {
            values.push_back(fmt::format("{:.3g}", times * facts.white));
        }
    }
    return values;
}

// Returns why a value is not worth trying, or the whole setting if `value` is empty. Returns an empty text if
// it is worth trying.
std::string reasonAgainst(std::string_view name, std::string_view value, const Facts& facts,
                          const Configuration& base) {
    const auto has = [&facts](std::string_view effect) { return facts.effects.contains(effect); };
    const bool sendsRays = has("reflection") || has("refraction") || has("indirect-diffuse");
    const std::string_view strategy = base.find("strategy")->second;
    if (value.empty()) {
        if (name == "shadow-spp") {
            return !has("shadow") ? "there are no shadows"
                   : facts.sizedLights
                       ? ""
                       : "no light has a size (--light-radius, --sun-angle): one ray is exact";
        }
        if (name == "ao-spp") {
            return has("ambient-occlusion") ? "" : "there is no ambient occlusion (--effects)";
        }
        if (name == "max-roughness" || name == "mirror-roughness" || name == "ssr") {
            return has("reflection") ? "" : "there are no reflections";
        }
        if (name == "max-interfaces") {
            return has("refraction") ? "" : "nothing refracts";
        }
        if (name == "alpha") {
            return facts.masks ? "" : "no material has an alpha mask";
        }
        if (name == "hit-lobes") {
            return facts.furtherLobes ? "" : "no material has a lobe that hits could lose";
        }
        if (name == "texture-lod") {
            return facts.textures ? "" : "there are no textures";
        }
        if (!sendsRays && (name == "skip-below" || name == "clamp" || name == "hit-record" ||
                           name == "strategy" || name == "ordering" || name == "binning" ||
                           name == "shadows" || name == "batch-effects" || name == "position-fetch")) {
            return "no effect sends rays whose hits are shaded";
        }
        if (name == "ordering" && !ordersHits(strategy)) {
            return fmt::format("--strategy {} sorts no hits", strategy);
        }
        if (name == "hit-record" && !ordersHits(strategy)) {
            return fmt::format("--strategy {} keeps no records", strategy);
        }
        if (name == "effects") {
            return facts.effects.empty() ? "there are no effects" : "";
        }
        return "";
    }
    if (name == "precision" && value == "16" && !facts.float16) {
        return "the device has no 16-bit floating point (shaderFloat16)";
    }
    if (name == "position-fetch" && value == "on" && !facts.positionFetch) {
        return "the device lacks VK_KHR_ray_tracing_position_fetch, or this glint's glslang GLSL for it";
    }
    if (name == "strategy" && value == "hit-shaders" && !facts.rayPipeline) {
        return "the device has no ray tracing pipelines";
    }
    return "";
}

// Inserts `base` if it is missing: a number by its size, a word at the front.
void insertBase(std::vector<std::string>& values, const std::string& base) {
    if (std::ranges::find(values, base) != values.end()) {
        return;
    }
    const auto number = [](const std::string& text) { return std::strtod(text.c_str(), nullptr); };
    const bool isNumber = !base.empty() && base.find_first_not_of("0123456789.e-") == std::string::npos;
    auto at = values.begin();
    while (isNumber && at != values.end() && (*at == "off" || number(*at) < number(base))) {
        ++at;
    }
    values.insert(at, base);
}

}  // namespace

std::vector<std::string> settingNames() {
    std::vector<std::string> names;
    for (const Row& row : kRows) {
        names.emplace_back(row.name);
    }
    return names;
}

Stage stageOf(std::string_view name) {
    const Row* const row = std::ranges::find(kRows, name, &Row::name);
    return row == std::end(kRows) ? Stage::Render : row->stage;
}

std::vector<Setting> settingsFor(const Facts& facts, const Configuration& base, bool quick) {
    std::vector<Setting> settings;
    for (const Row& row : kRows) {
        const auto own = base.find(row.name);
        if (own == base.end()) {
            continue;
        }
        Setting setting;
        setting.name = row.name;
        setting.what = row.what;
        setting.stage = row.stage;
        setting.approximates = row.exact.has_value();
        setting.base = own->second;
        const Values tried = quick ? row.few : row.values;
        std::vector<std::string> values(tried.begin(), tried.end());
        if (row.name == "effects") {
            values = effectValues(facts, setting.base);
        } else if (row.name == "clamp") {
            values = clampValues(facts, quick);
        }
        insertBase(values, setting.base);
        if (const std::string reason = reasonAgainst(row.name, "", facts, base); !reason.empty()) {
            for (const std::string& value : values) {
                if (value != setting.base) {
                    setting.skipped.push_back({value, reason});
                }
            }
            values = {setting.base};
        }
        for (const std::string& value : values) {
            const std::string reason =
                value == setting.base ? "" : reasonAgainst(row.name, value, facts, base);
            if (reason.empty()) {
                setting.values.push_back(value);
            } else {
                setting.skipped.push_back({value, reason});
            }
        }
        settings.push_back(std::move(setting));
    }
    return settings;
}

Configuration exactValues(const Facts& facts) {
    Configuration exact;
    for (const Row& row : kRows) {
        if (row.exact && !row.exact->empty()) {
            exact.emplace(row.name, *row.exact);
        }
    }
    if (!facts.effects.contains("reflection")) {
        exact.erase("max-roughness");
    }
    return exact;
}

Configuration simplified(const Configuration& configuration, const Configuration& base) {
    Configuration rest = configuration;
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

const std::string& valueOf(std::string_view name, const Configuration& configuration,
                           const Configuration& base) {
    const auto own = configuration.find(name);
    return own != configuration.end() ? own->second : base.find(name)->second;
}

std::string nameOf(const Configuration& configuration) {
    std::string name;
    for (const std::string& setting : settingNames()) {
        const auto own = configuration.find(setting);
        if (own != configuration.end()) {
            name += fmt::format("{}{} {}", name.empty() ? "" : ", ", setting, own->second);
        }
    }
    return name.empty() ? "default" : name;
}

}  // namespace glint::measure
