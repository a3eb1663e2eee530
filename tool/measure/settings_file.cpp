#include "base/files.h"
#include "base/json.h"
#include "base/text.h"
#include "settings/descriptor.h"

#include <glint/measure/settings_file.h>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

namespace glint::measure {

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
