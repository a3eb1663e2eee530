#include "settings/descriptor.h"

#include "base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

namespace glint::compiler {

std::vector<SettingWord> wordsOf(const Descriptor& row) {
    std::vector<SettingWord> words =
        row.values.words != nullptr ? row.values.words() : std::vector<SettingWord>();
    for (SettingWord& word : words) {
        word.what = word.name == "auto" && word.what.empty() ? row.values.automatic : word.what;
    }
    return words;
}

bool isSwitch(const Descriptor& row) {
    const std::vector<SettingWord> words = wordsOf(row);
    const auto isOfSwitch = [](const SettingWord& word) {
        return word.name == "on" || word.name == "off" || word.name == "auto";
    };
    return row.values.form == ValueForm::Switch ||
           (row.values.form == ValueForm::Word && std::ranges::all_of(words, isOfSwitch));
}

std::vector<std::string> optionWords(const Descriptor& row, const std::string& value) {
    const std::string name(row.name);
    if (!isSwitch(row)) {
        return {"--" + name, value};
    }
    return {value == "on" ? "--" + name : value == "off" ? "--no-" + name : "--" + name + "=" + value};
}

std::string withoutEffect(std::string_view setting, const BenchFacts& facts) {
    std::string reason;
    for (const materials::EffectDeclaration& effect : materials::builtinMaterialModel().effects) {
        if (std::ranges::find(effect.settings, setting) == effect.settings.end()) {
            continue;
        }
        if (facts.effects.contains(effect.name)) {
            return {};
        }
        reason = effect.absent;
    }
    return reason;
}

std::string idleReason(const Descriptor& row, const BenchFacts& facts, const Configuration& base) {
    if (row.idle != nullptr) {
        return row.idle(facts, base);
    }
    std::string reason = withoutEffect(row.name, facts);
    return reason.empty() && row.bench.against != nullptr ? row.bench.against("", facts, base) : reason;
}

std::string boundText(double bound) {
    std::string text = fmt::format("{:g}", bound);
    if (bound < 1e7 || text.find('.') != std::string::npos) {
        return fmt::format("{}", bound);
    }
    std::erase(text, '+');
    return text.replace(text.find('e') + 1, 1, "");
}

std::string complaintAbout(const Descriptor& row, std::string_view text) {
    const SettingValues& values = row.values;
    std::vector<std::string> names;
    if (values.form == ValueForm::Switch) {
        names = {"on", "off"};
    }
    for (const SettingWord& word : wordsOf(row)) {
        names.push_back(word.name);
    }
    const bool isWord = std::ranges::find(names, text) != names.end();
    if (isWord || (values.accepts != nullptr && values.accepts(text))) {
        return "";
    }
    const std::string range = fmt::format("{} to {}", boundText(values.min), boundText(values.max));
    const bool isWhole = values.form == ValueForm::Whole;
    std::int64_t whole = 0;
    double real = 0.0;
    switch (values.form) {
        case ValueForm::Text:
            return fmt::format("\"{}\" is no {}; give one", text, values.further);
        case ValueForm::Whole:
        case ValueForm::Real:
            if (isWhole ? parseWhole(text, static_cast<std::int64_t>(values.min),
                                     static_cast<std::int64_t>(values.max), whole)
                        : parseReal(text, values.min, values.max, real)) {
                return "";
            }
            return names.empty() ? fmt::format("\"{}\" is no {}number from {}; give one", text,
                                               isWhole ? "whole " : "", range)
                                 : fmt::format("\"{}\" is neither {} nor a number from {}; give one of these",
                                               text, fmt::join(names, ", "), range);
        default:
            const std::string suggestion = base::suggestion(text, names);
            return fmt::format("\"{}\" is none of {}{}{}{}", text, fmt::join(names, ", "),
                               values.further.empty() ? "" : ", ", values.further,
                               suggestion.empty() ? "; give one of them" : suggestion);
    }
}

std::vector<std::string> settingNames() {
    std::vector<std::string> names;
    for (const Descriptor& row : settingsTable()) {
        if (row.bench.use == BenchUse::Swept) {
            names.emplace_back(row.name);
        }
    }
    return names;
}

Configuration configurationOf(const Settings& settings) {
    Configuration configuration;
    for (const Descriptor& row : settingsTable()) {
        if (row.bench.use == BenchUse::Swept) {
            configuration.emplace(row.name, row.values.text(settings));
        }
    }
    return configuration;
}

Settings withSettings(Settings settings, const Configuration& configuration) {
    for (const Descriptor& row : settingsTable()) {
        const auto value = configuration.find(row.name);
        if (row.bench.use == BenchUse::Swept && value != configuration.end()) {
            row.values.set(settings, value->second);
        }
    }
    return settings;
}

std::vector<std::string> wordsOf(const Configuration& configuration) {
    std::vector<std::string> words;
    for (const std::string& name : settingNames()) {
        const auto value = configuration.find(name);
        if (value != configuration.end()) {
            std::ranges::move(optionWords(*sweptSetting(name), value->second), std::back_inserter(words));
        }
    }
    return words;
}

}  // namespace glint::compiler
