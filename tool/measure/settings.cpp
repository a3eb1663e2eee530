#include <glint/measure/settings.h>

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace glint::measure {

namespace {

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

bool ordersHits(std::string_view strategy) {
    const std::optional<package::Strategy> named = valueNamed<package::Strategy>(strategy);
    return named && (*named & package::kOrderedStrategies) != 0;
}

}  // namespace

std::vector<Setting> settingsFor(const compiler::BenchFacts& facts, const compiler::Configuration& base,
                                 bool quick) {
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
        insertBase(values, setting.base);
        const std::string noEffect = withoutEffect(row, facts);
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

compiler::Configuration exactValues(const compiler::BenchFacts& facts) {
    compiler::Configuration exact;
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        const bool isSwept = row.bench.use == compiler::BenchUse::Swept;
        if (isSwept && row.bench.exact && !row.bench.exact->empty()) {
            exact.emplace(row.name, *row.bench.exact);
        }
    }
    // A higher limit of roughness would call for reflections.
    if (!withoutEffect(*compiler::sweptSetting("max-roughness"), facts).empty()) {
        exact.erase("max-roughness");
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
