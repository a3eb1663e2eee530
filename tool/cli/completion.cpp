// glint completion: prints a script that completes glint's command line in a shell. The scripts are made from
// the description of the command line.
#include "base/lists.h"
#include "base/text.h"
#include "cli/command_line.h"
#include "cli/options/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace glint::cli {

namespace {

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

bool mentions(const std::string& text, const char* word) {
    return text.find(word) != std::string::npos;
}

ArgumentModel argumentOf(CLI::Option& option) {
    const std::string type = option.get_type_name();
    ArgumentModel argument;
    argument.choices = choicesOf(option);
    argument.isList = option.get_delimiter() == ',';
    argument.files = mentions(type, "FILE") || mentions(type, "IMAGE") || mentions(type, "PROGRAM");
    argument.folders = mentions(type, "DIR");
    return argument;
}

OptionModel optionOf(CLI::Option& option) {
    OptionModel model;
    for (const std::string& name : option.get_snames()) {
        model.names.push_back("-" + name);
    }
    for (const std::string& name : option.get_lnames()) {
        model.names.push_back("--" + name);
    }
    model.help = shortText(option);
    model.takesValue = option.get_items_expected_max() > 0;
    model.value = argumentOf(option);
    return model;
}

CommandModel commandOf(CLI::App& command) {
    CommandModel model{command.get_name(), command.get_description(), {}, {}};
    for (CLI::Option* option : command.get_options(std::function<bool(CLI::Option*)>())) {
        if (!option->get_positional()) {
            model.options.push_back(optionOf(*option));
            continue;
        }
        const ArgumentModel argument = argumentOf(*option);
        model.positional.choices.insert(model.positional.choices.end(), argument.choices.begin(),
                                        argument.choices.end());
        model.positional.files = model.positional.files || argument.files;
        model.positional.folders = model.positional.folders || argument.folders;
    }
    return model;
}

// Returns the commands of `app` in the order of their declarations.
std::vector<CommandModel> describeCommands(CLI::App& app) {
    std::vector<CommandModel> commands;
    for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
        commands.push_back(commandOf(*command));
    }
    return commands;
}

constexpr std::string_view kMadeBy =
    "# Shell completion for glint, made by `glint completion {}`. The version that made it: glint {}.\n";

std::string head(std::string_view shell) {
    return fmt::format(fmt::runtime(kMadeBy), shell, GLINT_VERSION);
}

std::vector<std::string> namesOf(const CommandModel& command) {
    std::vector<std::string> names;
    for (const OptionModel& option : command.options) {
        names.insert(names.end(), option.names.begin(), option.names.end());
    }
    return names;
}

std::vector<std::string> namesOf(const std::vector<CommandModel>& commands) {
    return base::mapped<std::string>(commands, &CommandModel::name);
}

// --- bash ---------------------------------------------------------------------------------------

// Returns the code that fills COMPREPLY for one argument, or an empty text if nothing is known about it.
std::string bashAction(const ArgumentModel& argument) {
    if (!argument.choices.empty()) {
        return fmt::format("{} {}", argument.isList ? "_glint_list" : "_glint_words",
                           base::shellQuoted(fmt::format("{}", fmt::join(argument.choices, " "))));
    }
    return argument.files ? "_glint_files" : argument.folders ? "_glint_folders" : "";
}

std::string bashCommand(const CommandModel& command) {
    std::string text = fmt::format("        {})\n            case $previous in\n", command.name);
    for (const OptionModel& option : command.options) {
        if (option.takesValue) {
            const std::string action = bashAction(option.value);
            text += fmt::format("                {}) {}; return ;;\n", fmt::join(option.names, "|"),
                                action.empty() ? ":" : action);
        }
    }
    const std::string positional = bashAction(command.positional);
    return text + fmt::format(
                      "            esac\n"
                      "            if [[ $current == -* ]]; then\n"
                      "                _glint_words {}\n"
                      "            else\n"
                      "                {}\n"
                      "            fi\n"
                      "            ;;\n",
                      base::shellQuoted(fmt::format("{}", fmt::join(namesOf(command), " "))),
                      positional.empty() ? ":" : positional);
}

// `current` is the word up to the cursor, and `previous` is the option that it belongs to, because bash
// splits --merge=none at the sign.
constexpr std::string_view kBashHelpers = R"(
_glint_words() {
    mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current")
}

# The last of several values that commas separate.
_glint_list() {
    local before=
    [[ $current == *,* ]] && before=${current%,*},
    mapfile -t COMPREPLY < <(compgen -P "$before" -W "$1" -- "${current##*,}")
    compopt -o nospace 2>/dev/null
}

_glint_files() {
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
}

_glint_folders() {
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$current")
}

_glint() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=
    ((COMP_CWORD > 0)) && previous=${COMP_WORDS[COMP_CWORD - 1]}
    if [[ $current == = ]]; then
        current=
    elif [[ $previous == = ]]; then
        previous=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    COMPREPLY=()
    if ((COMP_CWORD == 1)); then
)";

// --- zsh ----------------------------------------------------------------------------------------

// Within _arguments, brackets and colons have a special meaning.
std::string escaped(std::string_view text, std::string_view special) {
    std::string result;
    for (const char c : text) {
        if (special.find(c) != std::string_view::npos) {
            result += '\\';
        }
        result += c;
    }
    return result;
}

std::string zshAction(const ArgumentModel& argument) {
    if (!argument.choices.empty()) {
        const std::string choices = fmt::format("{}", fmt::join(argument.choices, " "));
        return argument.isList ? fmt::format("_values -s , value {}", choices) : fmt::format("({})", choices);
    }
    return argument.files ? "_files" : argument.folders ? "_files -/" : " ";
}

std::string zshCommand(const CommandModel& command) {
    std::string text = fmt::format("                {})\n                    _arguments \\\n", command.name);
    for (const OptionModel& option : command.options) {
        for (const std::string& name : option.names) {
            const bool isLong = name.starts_with("--");
            const std::string value =
                option.takesValue ? fmt::format(":value:{}", zshAction(option.value)) : std::string();
            text += fmt::format(
                "                        {} \\\n",
                base::shellQuoted(fmt::format("{}{}[{}]{}", name, option.takesValue && isLong ? "=" : "",
                                              escaped(option.help, "[]:\\"), value)));
        }
    }
    return text + fmt::format("                        {}\n                    ;;\n",
                              base::shellQuoted("*:argument:" + zshAction(command.positional)));
}

// --- fish ---------------------------------------------------------------------------------------

std::string fishQuoted(std::string_view text) {
    return "'" + escaped(text, "'\\") + "'";
}

std::string fishOption(const CommandModel& command, const OptionModel& option) {
    std::string line = fmt::format("complete -c glint -n '__fish_seen_subcommand_from {}'", command.name);
    for (const std::string& name : option.names) {
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    if (option.takesValue) {
        const ArgumentModel& value = option.value;
        line += !value.choices.empty()
                    ? " -x -a " + fishQuoted(fmt::format("{}", fmt::join(value.choices, " ")))
                : value.files   ? " -r -F"
                : value.folders ? " -x -a '(__fish_complete_directories)'"
                                : " -x";
    }
    return line + " -d " + fishQuoted(option.help) + "\n";
}

std::string bashCompletion(const std::vector<CommandModel>& commands) {
    std::string text = head("bash") + std::string(kBashHelpers);
    text +=
        fmt::format("        _glint_words {}\n        return\n    fi\n    case ${{COMP_WORDS[1]}} in\n",
                    base::shellQuoted(fmt::format("{} --help --version", fmt::join(namesOf(commands), " "))));
    for (const CommandModel& command : commands) {
        text += bashCommand(command);
    }
    return text + "    esac\n}\n\ncomplete -F _glint glint\n";
}

std::string zshCompletion(const std::vector<CommandModel>& commands) {
    std::string text = "#compdef glint\n" + head("zsh") +
                       "\n_glint() {\n"
                       "    local -a commands=(\n";
    for (const CommandModel& command : commands) {
        text +=
            fmt::format("        {}\n", base::shellQuoted(command.name + ":" + escaped(command.help, ":\\")));
    }
    text +=
        "    )\n"
        "    local context state state_descr line\n"
        "    typeset -A opt_args\n"
        "    _arguments -C '(- *)--help[print help]' '(- *)--version[print the version]' "
        "'1:command:->command' '*::argument:->argument'\n"
        "    case $state in\n"
        "        command) _describe command commands ;;\n"
        "        argument)\n"
        "            case $words[1] in\n";
    for (const CommandModel& command : commands) {
        text += zshCommand(command);
    }
    return text +
           "            esac\n"
           "            ;;\n"
           "    esac\n"
           "}\n\n"
           "if [[ $funcstack[1] == _glint ]]; then\n"
           "    _glint \"$@\"\n"
           "else\n"
           "    compdef _glint glint\n"
           "fi\n";
}

std::string fishCompletion(const std::vector<CommandModel>& commands) {
    std::string text = head("fish") + "\n";
    for (const CommandModel& command : commands) {
        text += fmt::format("complete -c glint -n __fish_use_subcommand -x -a {} -d {}\n", command.name,
                            fishQuoted(command.help));
    }
    for (const CommandModel& command : commands) {
        text += "\n";
        const ArgumentModel& positional = command.positional;
        if (!positional.choices.empty() || !(positional.files || positional.folders)) {
            text +=
                fmt::format("complete -c glint -n '__fish_seen_subcommand_from {}' -f -a {}\n", command.name,
                            fishQuoted(fmt::format("{}", fmt::join(positional.choices, " "))));
        }
        for (const OptionModel& option : command.options) {
            text += fishOption(command, option);
        }
    }
    return text;
}

}  // namespace

void addCompletion(CLI::App& app, Action& chosen) {
    auto shell = std::make_shared<std::string>();
    CLI::App& command = addCommand(
        app, {.name = "completion",
              .what = "Print a script that completes this command line in a shell",
              .examples = {"glint completion bash > ~/.local/share/bash-completion/completions/glint",
                           "source <(glint completion zsh)"},
              .usual = {"--help"}});
    addChoice(command, "SHELL", *shell, {"bash", "zsh", "fish"}, "the shell").required();
    command.callback([shell, &app, &chosen] {
        chosen = [shell, &app](const Console& console) {
            const std::vector<CommandModel> commands = describeCommands(app);
            console.print(*shell == "bash"  ? bashCompletion(commands)
                          : *shell == "zsh" ? zshCompletion(commands)
                                            : fishCompletion(commands));
            return kExitDone;
        };
    });
}

}  // namespace glint::cli
