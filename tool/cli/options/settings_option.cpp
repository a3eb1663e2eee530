#include "cli/options/settings_option.h"

#include "cli/options/options.h"
#include "settings/table.h"

#include <glint/measure/settings_file.h>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

namespace glint::cli {

namespace {

constexpr const char* kOption = "--settings";

// Returns null if there is no command of that name.
const CLI::App* findCommand(const CLI::App& app, std::string_view name) {
    const auto commands =
        app.get_subcommands([name](const CLI::App* command) { return command->get_name() == name; });
    return commands.empty() ? nullptr : commands.front();
}

// Returns the value of an option, joined to it or as the next word; nothing if the option is not given.
std::optional<std::string> given(std::span<const char* const> arguments, std::string_view option) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view word = arguments[i];
        if (word == "--") {
            break;
        }
        if (word == option) {
            return i + 1 < arguments.size() ? arguments[i + 1] : "";
        }
        if (word.starts_with(option) && word.size() > option.size() && word[option.size()] == '=') {
            return std::string(word.substr(option.size() + 1));
        }
    }
    return std::nullopt;
}

// Takes "--sun off" for "--sun=off": boolean options have no value of their own, but people give one.
std::vector<std::string> joinSwitches(const CLI::App& command, const std::vector<std::string>& words) {
    std::vector<std::string> joined;
    for (const std::string& word : words) {
        const CLI::Option* const option =
            joined.empty() ? nullptr : command.get_option_no_throw(joined.back());
        const bool isValue = word == "on" || word == "off" || word == "auto";
        if (isValue && option != nullptr && option->get_expected_max() == 0) {
            joined.back() += "=" + word;
        } else {
            joined.push_back(word);
        }
    }
    return joined;
}

}  // namespace

void addSettingsFile(CLI::App& command, std::string& file) {
    addText(command, kOption, file, "FILE.json",
            "read options from this file, such as `glint bench`\n"
            "writes; options on the command line win")
        .group("Settings");
}

Result<CompletedLine> completeLine(const CLI::App& app, std::span<const char* const> arguments) {
    CompletedLine line;
    line.words.assign(arguments.begin(), arguments.end());
    const CLI::App* const command = arguments.empty() ? nullptr : findCommand(app, arguments.front());
    if (command != nullptr) {
        line.words = joinSwitches(*command, line.words);
    }
    const bool takes = command != nullptr && command->get_option_no_throw(kOption) != nullptr;
    const std::optional<std::string> file = takes ? given(arguments, kOption) : std::nullopt;
    if (!file || file->empty()) {
        return line;
    }
    GLINT_TRY(const auto settings, measure::readSettings(*file));
    line.file = *file;
    const bool isPackaged = given(arguments, "--package").has_value();
    compiler::Configuration taken;
    for (const auto& [name, value] : settings) {
        const std::string option = "--" + name;
        const bool isDecided =
            isPackaged && compiler::sweptSetting(name)->stage == compiler::SettingStage::Package;
        if (command->get_option_no_throw(option) != nullptr && !given(arguments, option) && !isDecided) {
            taken.emplace(name, value);
            line.options.push_back(option);
        }
    }
    const std::vector<std::string> words = compiler::wordsOf(taken);
    line.words.insert(line.words.begin() + 1, words.begin(), words.end());
    return line;
}

std::optional<Diagnostic> blameFile(const CompletedLine& line, const std::string& complaint) {
    for (const std::string& option : line.options) {
        if (complaint.starts_with(option + ":")) {
            const std::string name = option.substr(2);
            return measure::settingsError(
                line.file, "/settings/" + name, complaint.substr(option.size() + 2),
                fmt::format("correct it there, or give {} on the command line", option));
        }
    }
    return std::nullopt;
}

}  // namespace glint::cli
