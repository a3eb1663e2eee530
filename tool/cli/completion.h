// Makes shell completion scripts from the description of the command line.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace glint {

// The words that a shell offers after an option, or for a positional argument.
struct ArgumentModel {
    std::vector<std::string> choices;  // empty: none that are known
    bool isList = false;               // of choices, separated by commas
    bool files = false;
    bool folders = false;
};

struct OptionModel {
    std::vector<std::string> names;  // "-o", "--output"
    std::string help;                // what its text says first, in one line
    bool takesValue = false;
    ArgumentModel value;
};

struct CommandModel {
    std::string name;
    std::string help;
    std::vector<OptionModel> options;
    ArgumentModel positional;  // of all positionals together
};

// Returns the commands of `app` in the order of their declarations.
std::vector<CommandModel> describeCommands(CLI::App& app);

// Returns the whole script. `options` are those of glint itself.
std::string bashCompletion(const std::vector<CommandModel>& commands);
std::string zshCompletion(const std::vector<CommandModel>& commands);
std::string fishCompletion(const std::vector<CommandModel>& commands);

}  // namespace glint
