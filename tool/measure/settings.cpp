#include "settings/descriptor.h"

#include <glint/measure/settings.h>

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace glint::measure {

namespace {

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

}  // namespace glint::measure
