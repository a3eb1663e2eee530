#include "cli/options/usage.h"

#include "base/suggest.h"

#include <string_view>
#include <vector>

namespace glint::cli {

namespace {

using Arguments = std::span<const char* const>;

std::vector<const CLI::App*> commandsOf(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<std::string> commandNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : commandsOf(app)) {
        names.push_back(command->get_name());
    }
    return names;
}

// Returns null if there is no command of that name.
const CLI::App* commandNamed(const CLI::App& app, const std::string& name) {
    for (const CLI::App* command : commandsOf(app)) {
        if (command->get_name() == name) {
            return command;
        }
    }
    return nullptr;
}

std::vector<std::string> optionNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    return names;
}

std::string unknownOption(const CLI::App& app, const std::string& name) {
    return "unknown option " + name + base::suggestion(name, optionNames(app));
}

// Returns the first unknown long option, with a suggestion.
std::optional<std::string> findUnknownOption(const CLI::App& app, Arguments arguments) {
    for (const std::string_view argument : arguments) {
        if (argument == "--") {
            break;
        }
        const std::string name(argument.substr(0, argument.find('=')));
        if (name.starts_with("--") && app.get_option_no_throw(name) == nullptr) {
            return unknownOption(app, name);
        }
    }
    return std::nullopt;
}

// Returns nothing if the list has an item between all of its commas, and no blank.
std::optional<std::string> checkList(const std::string& name, const std::string& value) {
    if (value.find_first_not_of(',') == std::string::npos) {
        return name + ": is empty";
    }
    if (value.find_first_of(" \t") != std::string::npos) {
        return name + ": \"" + value + "\" has a blank: lists are separated by commas, without blanks";
    }
    if (value.starts_with(',') || value.ends_with(',') || value.find(",,") != std::string::npos) {
        return name + ": \"" + value + "\" lacks an item: lists are separated by commas, without blanks";
    }
    return std::nullopt;
}

// Returns the first option whose value is empty, or is a list with an empty item.
std::optional<std::string> findEmptyValue(const CLI::App& app, Arguments arguments) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view argument = arguments[i];
        if (argument == "--") {
            break;
        }
        const std::size_t sign = argument.find('=');
        const std::string name(argument.substr(0, sign));
        const CLI::Option* const option = name.starts_with('-') ? app.get_option_no_throw(name) : nullptr;
        if (option == nullptr) {
            continue;
        }
        const bool joined = name.starts_with("--") && sign != std::string_view::npos;
        if (joined && sign + 1 == argument.size()) {
            return name + ": is empty";
        }
        const bool isLast = i + 1 == arguments.size();
        if (option->get_delimiter() == ',' && (joined || !isLast)) {
            const std::string value(joined ? argument.substr(sign + 1) : std::string_view(arguments[i + 1]));
            if (std::optional<std::string> message = checkList(name, value)) {
                return message;
            }
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<Slip> findSlip(const CLI::App& app, std::span<const char* const> arguments) {
    if (arguments.empty()) {
        return Slip{"", "a command is missing"};
    }
    const std::string first = arguments[0];
    if (first.starts_with('-')) {
        const std::string name = first.substr(0, first.find('='));
        return app.get_option_no_throw(name) != nullptr ? std::nullopt
                                                        : std::optional<Slip>({"", unknownOption(app, name)});
    }
    const CLI::App* command = commandNamed(app, first);
    if (command == nullptr) {
        return Slip{"", "unknown command \"" + first + "\"" + base::suggestion(first, commandNames(app))};
    }
    std::optional<std::string> message = findUnknownOption(*command, arguments.subspan(1));
    if (!message) {
        message = findEmptyValue(*command, arguments.subspan(1));
    }
    return message ? std::optional<Slip>({first, *message}) : std::nullopt;
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
    std::string text;
    if (option->get_type_size() != 0) {
        text += option->get_type_name().empty() ? "" : " " + option->get_type_name();
        const bool many = option->get_expected_max() >= CLI::detail::expected_max_vector_size;
        text += many && option->get_positional() ? "..." : "";
        text += option->get_required() ? " " + get_label("REQUIRED") : "";
    }
    return text;
}

}  // namespace glint::cli
