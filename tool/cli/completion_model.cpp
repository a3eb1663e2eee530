#include "cli/completion.h"
#include "cli/options.h"

#include <algorithm>
#include <functional>

namespace glint {

namespace {

bool mentions(const std::string& text, const char* word) {
    return text.find(word) != std::string::npos;
}

// Returns the beginning of the text in one line. Details, defaults and the meanings of values follow it in
// the text.
std::string shortened(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    std::size_t end = text.size();
    for (const char* const rest : {"; ", ": ", " (default"}) {
        end = std::min(end, text.find(rest));
    }
    return text.substr(0, end);
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
    model.help = shortened(option.get_description());
    model.takesValue = option.get_items_expected_max() > 0;
    model.value = argumentOf(option);
    return model;
}

CommandModel commandOf(CLI::App& command) {
    CommandModel model{command.get_name(), shortened(command.get_description()), {}, {}};
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

}  // namespace

std::vector<CommandModel> describeCommands(CLI::App& app) {
    std::vector<CommandModel> commands;
    for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
        commands.push_back(commandOf(*command));
    }
    return commands;
}

}  // namespace glint
