#include "cli/options/options.h"

#include "base/text.h"
#include "cli/table.h"
#include "settings/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>

namespace glint::cli {

namespace {

// CLI11 shows a check's description beside the option's type. It is empty here, because the help text already
// says it.
CLI::Option& check(CLI::Option* option, const Complaint& complaint) {
    option->check(CLI::Validator(complaint, ""));
    return *option;
}

std::string quoted(const std::string& text) {
    return "\"" + text + "\"";
}

std::string complaintAboutWhole(const std::string& text, std::int64_t min, std::int64_t max) {
    std::int64_t number = 0;
    return compiler::parseWhole(text, min, max, number)
               ? std::string()
               : fmt::format("{} is no whole number from {} to {}; give one", quoted(text), min, max);
}

// The name of a check that checks nothing. Its description holds the choices, for choicesOf().
constexpr const char* kChoices = "choices";

CLI::Option& checkChoice(CLI::Option* option, const std::vector<std::string>& choices) {
    keepChoices(*option, choices);
    return check(option, [choices](const std::string& text) {
        if (std::find(choices.begin(), choices.end(), text) != choices.end()) {
            return std::string();
        }
        const std::string suggestion = base::suggestion(text, choices);
        return fmt::format("{} is none of {}{}", quoted(text), fmt::join(choices, ", "),
                           suggestion.empty() ? "; give one of them" : suggestion);
    });
}

}  // namespace

std::string helpText(const std::string& help, const std::string& note) {
    const std::string text = wrapped(help, kHelpColumns);
    const std::size_t lineBreak = text.rfind('\n');
    const std::size_t last = text.size() - (lineBreak == std::string::npos ? 0 : lineBreak + 1);
    return note.empty() ? text : text + (last + 1 + note.size() > kHelpColumns ? "\n" : " ") + note;
}

CLI::App& addCommand(CLI::App& app, const CommandText& text) {
    CLI::App* command = app.add_subcommand(text.name, text.what);
    command->group("Commands");
    command->formatter(std::make_shared<HelpFormatter>(text));
    return *command;
}

CLI::Option& addChoice(CLI::App& command, const std::string& flags, const std::string& usual,
                       const std::function<void(const std::string&)>& set,
                       const std::vector<std::string>& choices, const std::string& help) {
    CLI::Option* option = command
                              .add_option(
                                  flags,
                                  [set](const CLI::results_t& words) {
                                      set(words.front());
                                      return true;
                                  },
                                  helpText(help, usual.empty() ? "" : fmt::format("(default: {})", usual)))
                              ->type_name(fmt::format("{}", fmt::join(choices, "|")));
    return checkChoice(option, choices);
}

CLI::Option& addChoice(CLI::App& command, const std::string& flags, std::string& value,
                       const std::vector<std::string>& choices, const std::string& help) {
    return addChoice(
        command, flags, value, [&value](const std::string& choice) { value = choice; }, choices, help);
}

CLI::Option& addChoices(CLI::App& command, const std::string& flags, std::vector<std::string>& values,
                        const std::vector<std::string>& choices, const std::string& help) {
    CLI::Option* option =
        command
            .add_option(
                flags, values,
                helpText(help, values.empty() ? "" : fmt::format("(default: {})", fmt::join(values, ","))))
            ->type_name(fmt::format("{}", fmt::join(choices, ",")))
            ->delimiter(',')
            ->allow_extra_args(false);
    return checkChoice(option, choices);
}

void keepChoices(CLI::Option& option, const std::vector<std::string>& choices) {
    CLI::Validator known([](const std::string&) { return std::string(); },
                         fmt::format("{}", fmt::join(choices, " ")), kChoices);
    option.check(known.active(false));
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
            .add_option(flags, value, helpText(help, fmt::format("({} to {}, default: {})", min, max, value)))
            ->type_name("N");
    return check(option, [min, max](const std::string& text) { return complaintAboutWhole(text, min, max); });
}

CLI::Option& addReal(CLI::App& command, const std::string& flags, double& value, double min, double max,
                     const std::string& help) {
    CLI::Option* option = command.add_option(flags, value, helpText(help))->type_name("X");
    return check(option, [min, max](const std::string& text) {
        double number = 0.0;
        return compiler::parseReal(text, min, max, number)
                   ? std::string()
                   : fmt::format("{} is no number from {} to {}; give one", quoted(text), min, max);
    });
}

CLI::Option& addText(CLI::App& command, const std::string& flags, std::string& value, const std::string& type,
                     const std::string& help, const Complaint& complaint) {
    CLI::Option* option = command.add_option(flags, value, helpText(help))->type_name(type);
    return check(option, [complaint](const std::string& text) {
        return text.empty() ? std::string(kEmpty) : complaint ? complaint(text) : std::string();
    });
}

CLI::Option& addTexts(CLI::App& command, const std::string& flags, std::vector<std::string>& values,
                      const std::string& type, const std::string& help) {
    CLI::Option* option =
        command.add_option(flags, values, helpText(help))->type_name(type)->allow_extra_args();
    return check(option,
                 [](const std::string& text) { return text.empty() ? std::string(kEmpty) : std::string(); });
}

CLI::Option& addOutputFile(CLI::App& command, const std::string& flags, std::string& value,
                           const std::string& type, const std::vector<std::string>& extensions,
                           const std::string& help) {
    CLI::Option& option = addText(command, flags, value, type, help + "; an existing file is replaced");
    return extensions.empty() ? option : check(&option, [extensions](const std::string& text) {
        std::string extension = std::filesystem::path(text).extension().string();
        std::transform(extension.begin(), extension.end(), extension.begin(),
                       [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
        if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) {
            return std::string();
        }
        return fmt::format("{} does not end in {}; name such a file", quoted(text),
                           fmt::join(extensions, " or "));
    });
}

CLI::Option& addFlag(CLI::App& command, const std::string& flags, bool& value, const std::string& help) {
    return *command.add_flag(switchFlags(flags, "true", "false"), value,
                             helpText(help, value ? "(default: on)" : ""));
}

std::string switchFlags(const std::string& flags, const std::string& on, const std::string& off) {
    const std::size_t name = flags.find("--") + 2;
    std::string all;
    for (std::size_t begin = 0; begin <= flags.size();) {
        const std::size_t end = std::min(flags.find(',', begin), flags.size());
        all += flags.substr(begin, end - begin) + "{" + on + "},";
        begin = end + 1;
    }
    return all + "--no-" + flags.substr(name) + "{" + off + "}";
}

void addJobs(CLI::App& command, int& jobs) {
    constexpr int kMost = 1024;
    const std::string help =
        fmt::format("threads that work at a time; 0: one for each core\n(0 to {}, default: {})", kMost, jobs);
    check(command.add_option("-j,--jobs", jobs, help)->type_name("N")->group(kWork),
          [](const std::string& text) { return complaintAboutWhole(text, 0, kMost); });
}

void addDeviceChoice(CLI::App& command, std::string& device, bool& validate, const std::string& checks) {
    addText(command, "--device", device, "NAME", "part of the GPU's name (default: the first suitable one)");
    addFlag(
        command, "--validate", validate,
        "run with the Vulkan validation layers, synchronisation included: any message is an error" + checks);
}

void addWords(const CLI::Option& option, std::vector<std::string>& words) {
    if (option.get_positional()) {
        words.insert(words.end(), option.results().begin(), option.results().end());
        return;
    }
    const std::string name = option.get_name();
    if (option.get_items_expected_max() == 0) {
        // The last one counts. Lists, such as that of --werror, have several values.
        const std::vector<std::string>& values = option.results();
        const bool isList = option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
        for (std::size_t i = isList ? 0 : values.size() - 1; i < values.size(); ++i) {
            const std::string& value = values[i];
            const bool isOff = value == "false" || value == "off";
            const bool isOn = value == "true" || value == "on";
            words.push_back(isOff  ? "--no-" + name.substr(2)
                            : isOn ? name
                                   : fmt::format("{}={}", name, value));
        }
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

namespace {

constexpr std::string_view kNoPrefix = "no-";
constexpr std::string_view kErrorWord = "error";
constexpr std::string_view kErrorPrefix = "error=";
// The value that CLI11 gives to a flag without a value.
constexpr std::string_view kAll = "true";

// Returns an empty text if `id` names a diagnostic of one of the severities, else the reason why it does not.
std::string checkId(const std::string& id, std::uint8_t severities) {
    const std::uint8_t known = severitiesOf(id);
    if (known == 0) {
        const std::string suggestion = base::suggestion(id, diagnosticIds(severities));
        return "there is no diagnostic \"" + id + "\"" +
               (suggestion.empty() ? "; docs/diagnostics.md lists them" : suggestion);
    }
    return (known & severities) != 0 ? std::string() : "\"" + id + "\" is always an error; name a warning";
}

std::string checkWarning(const std::string& value) {
    const std::string_view text = value;
    if (text == kErrorWord) {
        return {};
    }
    if (text.starts_with(kErrorPrefix)) {
        return checkId(value.substr(kErrorPrefix.size()), kWarning);
    }
    if (text.starts_with(kNoPrefix)) {
        return checkId(value.substr(kNoPrefix.size()), kWarning | kNote);
    }
    return "\"" + value + "\" is neither no-ID, error nor error=ID; give one of these";
}

}  // namespace

ConsoleOptions ReportArguments::options() const {
    ConsoleOptions options = *this;
    for (const std::string& id : werror) {
        if (id == kAll) {
            options.policy.allErrors = true;
        } else {
            options.policy.errors.insert(id);
        }
    }
    for (const std::string& value : warnings) {
        if (value == kErrorWord) {
            options.policy.allErrors = true;
        } else if (value.starts_with(kErrorPrefix)) {
            options.policy.errors.insert(value.substr(kErrorPrefix.size()));
        } else {
            options.policy.dropped.insert(value.substr(kNoPrefix.size()));
        }
    }
    return options;
}

void ReportArguments::check() const {
    if (quiet && verbose) {
        throw CLI::ValidationError("--verbose", "can't be combined with --quiet; leave out one of them");
    }
}

void addReportOptions(CLI::App& command, ReportArguments& arguments) {
    const OptionGroup group(command, "Report");
    if (command.get_option_no_throw("--json") == nullptr) {
        addFlag(command, "--json", arguments.json, "print the result and all diagnostics as JSON");
    }
    addFlag(command, "-q,--quiet", arguments.quiet, "print only errors");
    addFlag(command, "-v,--verbose", arguments.verbose, "print what is read, decided and made, with times");
    addNamed(command, "--color", arguments.color,
             "colour of diagnostics; auto: where stderr is a terminal and NO_COLOR is not set");
    command
        .add_flag("--werror", arguments.werror,
                  "treat warnings as errors; --werror=ID: only those of this\n"
                  "id; may be repeated")
        ->check(CLI::Validator(
            [](const std::string& id) { return id == kAll ? std::string() : checkId(id, kWarning); }, ""));
    command
        .add_option("-W", arguments.warnings,
                    "hide warnings and notes; -Wno-ID: those of this id; -Werror,\n"
                    "-Werror=ID: the same as --werror; may be repeated")
        ->type_name("no-ID|error=ID")
        ->allow_extra_args(false)
        ->check(CLI::Validator(checkWarning, ""));
}

}  // namespace glint::cli
