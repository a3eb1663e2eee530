#include "cli/options/options.h"

#include "base/suggest.h"
#include "materials/packs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>
#include <tuple>
#include <utility>

namespace glint {

namespace {

// CLI11 shows a check's description beside the option's type. It is empty here, because the help text already
// says it.
CLI::Option& check(CLI::Option* option, const std::function<std::string(const std::string&)>& test) {
    option->check(CLI::Validator(test, ""));
    return *option;
}

template <typename T>
bool parseWhole(const std::string& text, T& value) {
    const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* end = text.data() + text.size();
    const auto parsed = std::from_chars(begin, end, value);
    return parsed.ec == std::errc() && parsed.ptr == end;
}

std::string quoted(const std::string& text) {
    return "\"" + text + "\"";
}

// The name of a check that checks nothing. Its description holds the choices, for choicesOf().
constexpr const char* kChoices = "choices";

void keepChoices(CLI::Option* option, const std::vector<std::string>& choices) {
    CLI::Validator known([](const std::string&) { return std::string(); },
                         fmt::format("{}", fmt::join(choices, " ")), kChoices);
    option->check(known.active(false));
}

CLI::Option& checkChoice(CLI::Option* option, const std::vector<std::string>& choices) {
    keepChoices(option, choices);
    return check(option, [choices](const std::string& text) {
        if (std::find(choices.begin(), choices.end(), text) != choices.end()) {
            return std::string();
        }
        return fmt::format("{} is none of {}{}", quoted(text), fmt::join(choices, ", "),
                           suggestion(text, choices));
    });
}

std::vector<std::string> hitLobeChoices() {
    std::vector<std::string> choices{"all", "base"};
    for (const std::string_view name : builtinMaterialModel().names(kLobeMask)) {
        choices.emplace_back(name);
    }
    return choices;
}

// Lists the lobes that are not part of the base, in lines that fit the help.
std::string furtherLobes() {
    constexpr std::size_t kColumns = 52;
    std::string text;
    std::size_t column = 0;
    for (const std::string_view name : builtinMaterialModel().names(kLobeMask & ~measure::baseLobes())) {
        const bool breaks = column + name.size() + 2 > kColumns;
        text += text.empty() ? "" : breaks ? ",\n" : ", ";
        column = breaks ? name.size() : column + name.size() + 2;
        text += name;
    }
    return text;
}

// Appends a note to an option's text: on its last line, or on a new line if that would be too long.
std::string withNote(const std::string& help, const std::string& note) {
    constexpr std::size_t kColumns = 58;
    const std::size_t lineBreak = help.rfind('\n');
    const std::size_t last = help.size() - (lineBreak == std::string::npos ? 0 : lineBreak + 1);
    return help + (last + 1 + note.size() > kColumns ? "\n" : " ") + note;
}

// The policies that use hits.
constexpr std::string_view kTakesHits[] = {"auto", "profile"};

// Returns the parts before and behind the colon of POLICY:FILE, or nothing if `text` does not have that form.
std::optional<std::pair<std::string, std::string>> splitPolicy(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string policy = text.substr(0, colon);
    const bool takesHits = std::ranges::find(kTakesHits, policy) != std::end(kTakesHits);
    if (colon == std::string::npos || colon + 1 == text.size() || !takesHits) {
        return std::nullopt;
    }
    return std::pair(policy, text.substr(colon + 1));
}

// The value is a choice, or a choice with the file of its hits.
CLI::Option& addMerge(CLI::App& command, std::string& value) {
    const std::vector<std::string> choices{"none", "family", "all", "auto", "profile"};
    CLI::Option* option =
        command
            .add_option("--merge", value,
                        fmt::format("which permutations share a shader; none: every\n"
                                    "permutation has its own; family: those with the same\n"
                                    "lobes share one; all: one shader; auto: decided by a cost\n"
                                    "model, within --max-shaders; profile: those with many\n"
                                    "counted hits have their own, the others are merged; FILE:\n"
                                    "counted hits (default: {})",
                                    value))
            ->type_name("none|family|all|auto[:FILE]|profile[:FILE]");
    keepChoices(option, choices);
    return check(option, [choices](const std::string& text) {
        const bool isKnown = std::find(choices.begin(), choices.end(), text) != choices.end();
        return isKnown || splitPolicy(text)
                   ? std::string()
                   : fmt::format("{} is none of {}, auto:FILE or profile:FILE{}", quoted(text),
                                 fmt::join(choices, ", "), suggestion(text, choices));
    });
}

}  // namespace

CLI::App& addCommand(CLI::App& app, const std::string& name, const std::string& what,
                     const std::string& example) {
    CLI::App* command = app.add_subcommand(name, what);
    command->group("Commands");
    command->footer("Example:\n  " + example);
    command->get_formatter()->column_width(32);
    return *command;
}

CLI::Option& addChoice(CLI::App& command, const std::string& flags, std::string& value,
                       const std::vector<std::string>& choices, const std::string& help) {
    CLI::Option* option =
        command
            .add_option(flags, value,
                        value.empty() ? help : withNote(help, fmt::format("(default: {})", value)))
            ->type_name(fmt::format("{}", fmt::join(choices, "|")));
    return checkChoice(option, choices);
}

CLI::Option& addChoices(CLI::App& command, const std::string& flags, std::vector<std::string>& values,
                        const std::vector<std::string>& choices, const std::string& help) {
    CLI::Option* option =
        command
            .add_option(
                flags, values,
                values.empty() ? help : withNote(help, fmt::format("(default: {})", fmt::join(values, ","))))
            ->type_name(fmt::format("{}", fmt::join(choices, ",")))
            ->delimiter(',')
            ->allow_extra_args(false);
    return checkChoice(option, choices);
}

std::vector<std::string> choicesOf(CLI::Option& option) {
    std::vector<std::string> choices;
    try {
        const CLI::Validator& known = *option.get_validator(kChoices);
        // An inactive check is not shown in the help, and its description is empty.
        std::istringstream words(known.active(true).get_description());
        for (std::string word; words >> word;) {
            choices.push_back(word);
        }
    } catch (const CLI::OptionNotFound&) {
        // CLI11 has no other way to find out.
    }
    return choices;
}

CLI::Option& addInteger(CLI::App& command, const std::string& flags, std::int64_t& value, std::int64_t min,
                        std::int64_t max, const std::string& help) {
    CLI::Option* option =
        command
            .add_option(flags, value, withNote(help, fmt::format("({} to {}, default: {})", min, max, value)))
            ->type_name("N");
    return check(option, [min, max](const std::string& text) {
        std::int64_t number = 0;
        if (parseWhole(text, number) && number >= min && number <= max) {
            return std::string();
        }
        return fmt::format("{} is no whole number from {} to {}", quoted(text), min, max);
    });
}

CLI::Option& addReal(CLI::App& command, const std::string& flags, double& value, double min, double max,
                     const std::string& help) {
    CLI::Option* option = command.add_option(flags, value, help)->type_name("X");
    return check(option, [min, max](const std::string& text) {
        double number = 0.0;
        return measure::parseReal(text, min, max, number)
                   ? std::string()
                   : fmt::format("{} is no number from {} to {}", quoted(text), min, max);
    });
}

CLI::Option& addText(CLI::App& command, const std::string& flags, std::string& value, const std::string& type,
                     const std::string& help) {
    CLI::Option* option = command.add_option(flags, value, help)->type_name(type);
    return check(option, [](const std::string& text) {
        return text.empty() ? std::string("is empty") : std::string();
    });
}

CLI::Option& addTexts(CLI::App& command, const std::string& flags, std::vector<std::string>& values,
                      const std::string& type, const std::string& help) {
    CLI::Option* option = command.add_option(flags, values, help)->type_name(type)->allow_extra_args();
    return check(option, [](const std::string& text) {
        return text.empty() ? std::string("is empty") : std::string();
    });
}

CLI::Option& addImageOutput(CLI::App& command, const std::string& flags, std::string& value,
                            const std::vector<std::string>& extensions, const std::string& help) {
    CLI::Option* option = command.add_option(flags, value, help)->type_name("IMAGE");
    return check(option, [extensions](const std::string& text) {
        std::string extension = std::filesystem::path(text).extension().string();
        std::transform(extension.begin(), extension.end(), extension.begin(),
                       [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
        if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) {
            return std::string();
        }
        return fmt::format("{} does not end in {}", quoted(text), fmt::join(extensions, " or "));
    });
}

CLI::Option& addFlag(CLI::App& command, const std::string& flags, bool& value, const std::string& help) {
    return *command.add_flag(flags, value, help);
}

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

std::vector<CLI::Option*> addPlanOptions(CLI::App& command, measure::PlanSettings& arguments) {
    CLI::Option& merge = addMerge(command, arguments.merge);
    CLI::Option& limit = addInteger(command, "--max-shaders", arguments.maxShaders, 0, 1'000'000,
                                    "limit of shaders: --merge auto and profile stay within\n"
                                    "it, the others fail above it; 0: no limit, or 32 for auto\n"
                                    "and profile");
    CLI::Option& alpha = addChoice(command, "--alpha", arguments.alpha, {"auto", "opaque", "tested"},
                                   "alpha masks of hits; opaque: ignored; tested: each\n"
                                   "candidate is tested; auto: tested if the scene has masks");
    CLI::Option& lobes = addChoices(command, "--hit-lobes", arguments.hitLobes, hitLobeChoices(),
                                    "which lobes of materials hits keep, separated by\n"
                                    "commas; primary surfaces keep all; base: unlit,\n"
                                    "specularGlossiness, ior, specular; others:\n" +
                                        furtherLobes());
    lobes.type_name("all|base|LIST");
    for (CLI::Option* option : {&merge, &limit, &alpha, &lobes}) {
        option->group("Shaders");
    }
    return {&merge, &limit, &alpha, &lobes};
}

void addProfileInput(CLI::App& command, measure::PlanSettings& arguments) {
    addText(command, "--profile", arguments.profile, "FILE",
            "hits that `glint render --profile FILE` counted, for\n"
            "--merge profile; --merge auto uses them too")
        .group("Shaders");
}

void settleProfile(measure::PlanSettings& arguments) {
    if (const auto split = splitPolicy(arguments.merge)) {
        if (!arguments.profile.empty()) {
            throw CLI::ValidationError("--merge",
                                       "names a profile, and so does --profile; give only one of them");
        }
        std::tie(arguments.merge, arguments.profile) = *split;
    }
    if (arguments.merge == "profile" && arguments.profile.empty()) {
        throw CLI::ValidationError(
            "--merge", "profile needs the hits that `glint render --profile FILE` counted: profile:FILE");
    }
    const bool takesHits = std::ranges::find(kTakesHits, arguments.merge) != std::end(kTakesHits);
    if (!takesHits && !arguments.profile.empty()) {
        throw CLI::ValidationError("--profile",
                                   "is for --merge profile and auto, not for --merge " + arguments.merge);
    }
}

std::vector<CLI::Option*> addAccuracyOptions(CLI::App& command, measure::AccuracySettings& arguments) {
    CLI::Option& energy =
        addChoice(command, "--energy-compensation", arguments.energyCompensation, {"on", "off"},
                  "add the light that bounces between microfacets more than\n"
                  "once, which rough surfaces otherwise lose");
    CLI::Option& lod = addChoice(command, "--texture-lod", arguments.textureLod, {"cones", "mip0"},
                                 "which level of a texture is read; cones: by the\n"
                                 "footprint of the ray; mip0: the finest");
    CLI::Option& precision = addChoice(command, "--precision", arguments.precision, {"32", "16"},
                                       "bits of shading; 16: materials, Fresnel and weights of\n"
                                       "lobes are computed in 16-bit float; geometry, densities\n"
                                       "and light keep 32");
    energy.group("Shaders");
    lod.group("Shaders");
    precision.group("Shaders");
    return {&energy, &lod, &precision};
}

void addReadingOptions(CLI::App& command, measure::ReadingSettings& arguments) {
    addText(command, "--variant", arguments.variant, "NAME",
            "use the materials of this variant of the scene\n(KHR_materials_variants; default: none)");
    addFlag(command, "--strict-paths", arguments.strictPaths,
            "refuse symbolic links that lead out of the scene's\nfolder: for scenes that strangers made");
    addTexts(command, "--materials", arguments.materials, "DIR",
             "add the material features that this folder declares\n"
             "(docs/material_features.md); may be repeated")
        .allow_extra_args(false);
}

Result<ImportOptions> importOptions(const measure::ReadingSettings& arguments, bool decodeImages) {
    const Result<const MaterialModel*> model = loadMaterialModel(arguments.materials);
    if (!model) {
        return model.error();
    }
    ImportOptions options;
    options.decodeImages = decodeImages;
    options.variant = arguments.variant;
    options.strictPaths = arguments.strictPaths;
    options.materialModel = *model;
    return options;
}

}  // namespace glint
