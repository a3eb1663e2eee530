#include "base/suggest.h"
#include "settings/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace glint::compiler {

std::vector<SettingWord> wordsOf(const Descriptor& row) {
    std::vector<SettingWord> words =
        row.values.words != nullptr ? row.values.words() : std::vector<SettingWord>();
    for (SettingWord& word : words) {
        word.what = word.name == "auto" && word.what.empty() ? row.values.automatic : word.what;
    }
    return words;
}

std::string withoutEffect(const Descriptor& row, const BenchFacts& facts) {
    std::string reason;
    for (const materials::EffectDeclaration& effect : materials::builtinMaterialModel().effects) {
        if (std::ranges::find(effect.settings, row.name) == effect.settings.end()) {
            continue;
        }
        if (facts.effects.contains(effect.name)) {
            return {};
        }
        reason = effect.absent;
    }
    return reason;
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
            return fmt::format("\"{}\" is no {}", text, values.further);
        case ValueForm::Whole:
        case ValueForm::Real:
            if (isWhole ? parseWhole(text, static_cast<std::int64_t>(values.min),
                                     static_cast<std::int64_t>(values.max), whole)
                        : parseReal(text, values.min, values.max, real)) {
                return "";
            }
            return names.empty()
                       ? fmt::format("\"{}\" is no {}number from {}", text, isWhole ? "whole " : "", range)
                       : fmt::format("\"{}\" is neither {} nor a number from {}", text,
                                     fmt::join(names, ", "), range);
        default:
            if (!values.further.empty()) {
                return fmt::format("\"{}\" is none of {}, {}{}", text, fmt::join(names, ", "), values.further,
                                   base::suggestion(text, names));
            }
            return fmt::format("\"{}\" is none of {}{}", text, fmt::join(names, ", "),
                               base::suggestion(text, names));
    }
}

}  // namespace glint::compiler
