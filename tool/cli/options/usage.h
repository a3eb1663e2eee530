// The layout of help, and what is wrong with command lines: in Glint's words, and with typos that CLI11 would
// report as something else, or not at all.
#pragma once

#include <CLI/CLI.hpp>

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

}  // namespace glint::cli
