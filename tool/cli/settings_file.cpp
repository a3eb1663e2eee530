#include "cli/settings_file.h"

#include "base/files.h"
#include "base/json_depth.h"
#include "base/suggest.h"
#include "cli/bench_settings.h"
#include "cli/options.h"
#include "cli/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

namespace glint {

namespace {

constexpr const char* kOption = "--settings";
constexpr const char* kSettingsFormat = "glint-settings";
constexpr int kSettingsVersion = 1;

Diagnostic refusal(const std::filesystem::path& file, const std::string& pointer, const std::string& message,
                   const std::string& hint) {
    return makeError("settings-file", pointer.empty() ? file.string() : file.string() + "#" + pointer,
                     message, hint);
}

// Returns a number, a switch or a text as a word of the command line, or nothing for other values.
std::optional<std::string> settingText(const Json& value) {
    if (value.is_string()) {
        return value.get<std::string>();
    }
    if (value.is_boolean()) {
        return value.get<bool>() ? "on" : "off";
    }
    return value.is_number() ? std::optional(value.dump()) : std::nullopt;
}

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

}  // namespace

void addSettingsFile(CLI::App& command, std::string& file) {
    addText(command, kOption, file, "FILE.json",
            "read options from this file, such as `glint bench`\n"
            "writes; options on the command line win")
        .group("Settings");
}

std::string settingsText(const bench::Configuration& settings, const std::string& origin) {
    Json values = Json::object();
    for (const std::string& name : bench::settingNames()) {
        const auto value = settings.find(name);
        if (value != settings.end()) {
            values[name] = value->second;
        }
    }
    return toText(Json{{"format", kSettingsFormat},
                       {"version", kSettingsVersion},
                       {"origin", origin},
                       {"settings", std::move(values)}});
}

Result<bench::Configuration> readSettings(const std::filesystem::path& file) {
    constexpr std::uint64_t kMostBytes = 1U << 20;
    const Result<Bytes> bytes = readFile(file, kMostBytes);
    if (!bytes) {
        return bytes.error();
    }
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    constexpr const char* kHint = "give a file that `glint bench --budget-ms` or --max-error wrote";
    const Json json = nestsTooDeep(*bytes) ? Json() : Json::parse(text, nullptr, false);
    if (!json.is_object() || json.value("format", Json()) != Json(kSettingsFormat) ||
        !json.contains("settings") || !json["settings"].is_object()) {
        return refusal(file, "", "is no file of settings", kHint);
    }
    if (json.value("version", Json()) != Json(kSettingsVersion)) {
        return refusal(file, "/version", fmt::format("is not {}", kSettingsVersion),
                       "this glint reads that version");
    }
    bench::Configuration settings;
    const std::vector<std::string> names = bench::settingNames();
    for (const auto& [name, value] : json["settings"].items()) {
        const std::string pointer = "/settings/" + name;
        if (std::ranges::find(names, name) == names.end()) {
            return refusal(file, pointer, "is no setting" + suggestion(name, names),
                           "leave it out, or see docs/cli.md for those there are");
        }
        std::optional<std::string> word = settingText(value);
        if (!word || word->empty()) {
            return refusal(file, pointer, "is neither a text nor a number",
                           fmt::format("write it as on the command line, behind --{}", name));
        }
        if (isSwitch(name) && *word != "on" && *word != "off") {
            return refusal(file, pointer, fmt::format("is \"{}\", neither on nor off", *word), kHint);
        }
        settings.emplace(name, std::move(*word));
    }
    return settings;
}

Result<CompletedLine> completeLine(const CLI::App& app, std::span<const char* const> arguments) {
    CompletedLine line;
    line.words.assign(arguments.begin(), arguments.end());
    const CLI::App* const command = arguments.empty() ? nullptr : findCommand(app, arguments.front());
    const bool takes = command != nullptr && command->get_option_no_throw(kOption) != nullptr;
    const std::optional<std::string> file = takes ? given(arguments, kOption) : std::nullopt;
    if (!file || file->empty()) {
        return line;
    }
    const Result<bench::Configuration> settings = readSettings(*file);
    if (!settings) {
        return settings.error();
    }
    line.file = *file;
    const bool isPackaged = given(arguments, "--package").has_value();
    bench::Configuration taken;
    for (const auto& [name, value] : *settings) {
        const std::string option = "--" + name;
        const bool isDecided =
            isPackaged && bench::stageOf(name) == bench::Stage::Compile && name != "strategy";
        if (command->get_option_no_throw(option) != nullptr && !given(arguments, option) && !isDecided) {
            taken.emplace(name, value);
            line.options.push_back(option);
        }
    }
    const std::vector<std::string> words = wordsOf(taken);
    line.words.insert(line.words.begin() + 1, words.begin(), words.end());
    return line;
}

std::optional<Diagnostic> blameFile(const CompletedLine& line, const std::string& complaint) {
    for (const std::string& option : line.options) {
        if (complaint.starts_with(option + ":")) {
            const std::string name = option.substr(2);
            return refusal(line.file, "/settings/" + name, complaint.substr(option.size() + 2),
                           fmt::format("correct it there, or give {} on the command line", option));
        }
    }
    return std::nullopt;
}

}  // namespace glint
