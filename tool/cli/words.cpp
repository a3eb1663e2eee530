#include "cli/words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace glint {

void addWords(const CLI::Option& option, std::vector<std::string>& words) {
    if (option.get_positional()) {
        words.insert(words.end(), option.results().begin(), option.results().end());
        return;
    }
    const std::string name = option.get_name();
    if (option.get_items_expected_max() == 0) {
        words.push_back(name);
        return;
    }
    const std::string join = name.starts_with("--") ? name + "=" : name;
    if (option.get_delimiter() == ',') {
        words.push_back(join + fmt::format("{}", fmt::join(option.results(), ",")));
        return;
    }
    for (const std::string& value : option.results()) {
        words.push_back(join + value);
    }
}

std::string shellQuoted(std::string_view text) {
    std::string result = "'";
    for (const char c : text) {
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return result + "'";
}

std::string shellWords(const std::vector<std::string>& words) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./,:=+@%";
    std::string text;
    for (const std::string& word : words) {
        text += text.empty() ? "" : " ";
        if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
            text += word;
            continue;
        }
        text += shellQuoted(word);
    }
    return text;
}

}  // namespace glint
