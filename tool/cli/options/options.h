// Declares the options of subcommands: choices, ranges and defaults are checked and documented in one place.
#pragma once

#include "cli/console.h"
#include "cli/options/usage.h"

#include <glint/result.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace glint::cli {

// The group of options about how a command works, which change nothing in what it writes.
inline constexpr const char* kWork = "Work";

// The work of a subcommand once its command line is parsed. Returns the exit code.
using Action = std::function<int(const Console&)>;

// Adds a subcommand with its short help.
CLI::App& addCommand(CLI::App& app, const CommandText& text);

// Appends a note to an option's text: on its last line, or on a new line if that would be too long.
std::string withNote(const std::string& help, const std::string& note);
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
// Adds an option for a path or a name: any text except an empty one.
CLI::Option& addText(CLI::App& command, const std::string& flags, std::string& value, const std::string& type,
                     const std::string& help);
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

}  // namespace glint::cli
