// The layout of help, what is wrong with command lines, and options of subcommands: choices, ranges and
// defaults are checked and documented in one place.
#pragma once

#include "cli/console.h"

#include <glint/result.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::cli {

struct Slip {
    std::string command;  // empty: glint itself
    std::string message;
};

std::vector<std::string> commandNames(const CLI::App& app);
// Returns null if there is no command of that name.
const CLI::App* findCommand(const CLI::App& app, std::string_view name);

// Finds misspelt commands and options, and empty values. For the former CLI11 would complain about something
// that is missing; for the latter it would take the next argument as the value. `arguments` lack the
// program's name.
std::optional<Slip> findSlip(const CLI::App& app, std::span<const char* const> arguments);

// Says in Glint's words what CLI11 found wrong with a command line, and what to do.
std::string explain(const CLI::ParseError& error, const CLI::App& command);

// The columns of an option's text in the whole help, and the message about an empty value.
inline constexpr std::size_t kHelpColumns = 58;
inline constexpr const char* kEmpty = "is empty; give a value";

// The text of a command's help besides its options.
struct CommandText {
    std::string name;
    std::string what{};                   // one sentence without a full stop
    std::vector<std::string> examples{};  // two, whole command lines
    std::vector<std::string> usual{};     // the options that most people use, at most ten: "--size"
};

// Returns what an option's text says first, in one line: before details, defaults and the meanings of values.
std::string shortText(const CLI::Option& option);
// Returns "-q,--[no-]quiet", or the name of a positional argument.
std::string namesOf(const CLI::Option& option);

// The layout of help. --help fits a screen: what the command is for, its usual options in a line each, and
// examples. --help-all lists every option. Texts of options say which others they need and exclude, so
// CLI11's notes about these are left out.
class HelpFormatter : public CLI::Formatter {
public:
    explicit HelpFormatter(CommandText text = {});
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
    std::string make_option_name(const CLI::Option* option, bool isPositional) const override;
    std::string make_option_opts(const CLI::Option* option) const override;

private:
    std::string shortHelp(const CLI::App& command, const std::string& name) const;

    CommandText text_;
};

// --- Options of subcommands ---

// The group of options about how a command works, which change nothing in what it writes.
inline constexpr const char* kWork = "Work";

// While it lives, the options that are added to the command belong to the group of that name.
class OptionGroup {
public:
    OptionGroup(CLI::App& command, const std::string& name)
        : command_(command), before_(command.option_defaults()->get_group()) {
        command.option_defaults()->group(name);
    }
    // The short name needs no memory. NOLINTNEXTLINE(bugprone-exception-escape)
    ~OptionGroup() {
        command_.option_defaults()->group(before_);
    }
    OptionGroup(const OptionGroup&) = delete;
    OptionGroup& operator=(const OptionGroup&) = delete;

private:
    CLI::App& command_;
    std::string before_;
};

// Adds a subcommand with its short help.
CLI::App& addCommand(CLI::App& app, const CommandText& text);

// Returns an option's text in lines of kHelpColumns, with a note on the last line, or on a new line if that
// would be too long. The functions below do the same with the texts that they get.
std::string helpText(const std::string& help, const std::string& note = {});
// Adds an option that takes one of `choices`; the text in `value`, if any, is the default. A misspelt value
// suggests the nearest choice.
CLI::Option& addChoice(CLI::App& command, const std::string& flags, std::string& value,
                       const std::vector<std::string>& choices, const std::string& help);
// The same; the choice goes to a function.
CLI::Option& addChoice(CLI::App& command, const std::string& flags, const std::string& usual,
                       const std::function<void(const std::string&)>& set,
                       const std::vector<std::string>& choices, const std::string& help);
// Adds an option that takes any of `choices`, separated by commas.
CLI::Option& addChoices(CLI::App& command, const std::string& flags, std::vector<std::string>& values,
                        const std::vector<std::string>& choices, const std::string& help);
// Adds an option that takes one of the names of an enumeration; `value` has the default.
template <HasNames Value>
CLI::Option& addNamed(CLI::App& command, const std::string& flags, Value& value, const std::string& help) {
    std::vector<std::string> names;
    for (const Named<Value>& named : namesOf(Value{})) {
        names.emplace_back(named.name);
    }
    return addChoice(
        command, flags, std::string(nameOf(value)),
        [&value](const std::string& name) { value = *valueNamed<Value>(name); }, names, help);
}
// Makes choicesOf() return these choices.
void keepChoices(CLI::Option& option, const std::vector<std::string>& choices);
// Returns the choices that addChoice() and addChoices() were given; empty for other options.
std::vector<std::string> choicesOf(CLI::Option& option);
// Adds an option for a whole number within [min, max]; `value` is the default.
CLI::Option& addInteger(CLI::App& command, const std::string& flags, std::int64_t& value, std::int64_t min,
                        std::int64_t max, const std::string& help);
// Adds an option for a number within [min, max].
CLI::Option& addReal(CLI::App& command, const std::string& flags, double& value, double min, double max,
                     const std::string& help);
// Says what is wrong with a value; empty: nothing is.
using Complaint = std::function<std::string(const std::string&)>;
// Adds an option for a path or a name: any text except an empty one, and one that there is a complaint about.
CLI::Option& addText(CLI::App& command, const std::string& flags, std::string& value, const std::string& type,
                     const std::string& help, const Complaint& complaint = {});
// Adds an option for one or more texts.
CLI::Option& addTexts(CLI::App& command, const std::string& flags, std::vector<std::string>& values,
                      const std::string& type, const std::string& help);
// Adds an option for a file to write, which replaces an existing one, as the help then says. Its extension
// must be one of `extensions`, if there are any.
CLI::Option& addOutputFile(CLI::App& command, const std::string& flags, std::string& value,
                           const std::string& type, const std::vector<std::string>& extensions,
                           const std::string& help);
// Adds a boolean option: --x sets it, and --no-x clears it. `value` is the default.
CLI::Option& addFlag(CLI::App& command, const std::string& flags, bool& value, const std::string& help);
// Returns the same for `flags` of an option with the values on and off, and perhaps others by --x=VALUE.
std::string switchFlags(const std::string& flags, const std::string& on, const std::string& off);

// Adds --jobs: how many threads work at the same time.
void addJobs(CLI::App& command, int& jobs);
// Adds --device and --validate. `checks` is what the latter does besides.
void addDeviceChoice(CLI::App& command, std::string& device, bool& validate, const std::string& checks = {});

// Appends a parsed option as it would be given again, with one word for each value.
void addWords(const CLI::Option& option, std::vector<std::string>& words);

// Options that decide which diagnostics count, by id, and how a command reports: --json, --quiet, --verbose,
// --color, --werror, -W.

struct ReportArguments : ConsoleOptions {
    std::vector<std::string> werror;    // "true" for --werror, else an id
    std::vector<std::string> warnings;  // of -W: "no-ID", "error", "error=ID"

    // Returns the options with the policy that these words ask for.
    ConsoleOptions options() const;
    // Throws a CLI::ParseError if the options contradict each other.
    void check() const;
};

// Adds the options that every command has; `arguments` must outlive the command. If the command has declared
// --json with its own help text, that stays.
void addReportOptions(CLI::App& command, ReportArguments& arguments);

}  // namespace glint::cli
