#include "base/text.h"
#include "cli/options/options.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace glint::cli {

namespace {

using Arguments = std::span<const char* const>;

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
    const std::string suggestion = base::suggestion(name, optionNames(app));
    return "unknown option " + name + (suggestion.empty() ? "; leave it out, or see --help-all" : suggestion);
}

// Returns the option that a word of the command line names: "--size", "--size=8x8", "-o", "-oFILE". Null:
// none.
const CLI::Option* optionOf(const CLI::App& app, std::string_view word) {
    const std::string name(word.starts_with("--") ? word.substr(0, word.find('=')) : word.substr(0, 2));
    return name.starts_with('-') ? app.get_option_no_throw(name) : nullptr;
}

bool looksLikeOption(std::string_view word) {
    return word.starts_with("--") ||
           (word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0);
}

// Returns the first unknown option, with a suggestion.
std::optional<std::string> findUnknownOption(const CLI::App& app, Arguments arguments) {
    for (std::size_t i = 0; i < arguments.size() && std::string_view(arguments[i]) != "--"; ++i) {
        const std::string_view word = arguments[i];
        const CLI::Option* const option = optionOf(app, word);
        if (option == nullptr && looksLikeOption(word)) {
            return unknownOption(app, std::string(word.substr(0, word.find('='))));
        }
        const bool isJoined =
            word.starts_with("--") ? word.find('=') != std::string_view::npos : word.size() > 2;
        if (option != nullptr && option->get_items_expected_max() > 0 && !isJoined) {
            ++i;  // the next word is its value, whatever it looks like
        }
    }
    return std::nullopt;
}

// Returns nothing if the list has an item between all of its commas, and no blank.
std::optional<std::string> checkList(const std::string& name, const std::string& value) {
    if (value.find_first_not_of(',') == std::string::npos) {
        return name + ": " + kEmpty;
    }
    if (value.find_first_of(" \t") != std::string::npos) {
        return name + ": \"" + value + "\" has a blank; separate lists by commas alone";
    }
    if (value.starts_with(',') || value.ends_with(',') || value.find(",,") != std::string::npos) {
        return name + ": \"" + value + "\" lacks an item; separate lists by single commas";
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
            return name + ": " + kEmpty;
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

std::vector<std::string> commandNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        names.push_back(command->get_name());
    }
    return names;
}

const CLI::App* findCommand(const CLI::App& app, std::string_view name) {
    const auto commands =
        app.get_subcommands([name](const CLI::App* command) { return command->get_name() == name; });
    return commands.empty() ? nullptr : commands.front();
}

std::optional<Slip> findSlip(const CLI::App& app, std::span<const char* const> arguments) {
    if (arguments.empty()) {
        return Slip{"", "a command is missing; give one, such as render"};
    }
    const std::string first = arguments[0];
    if (first.starts_with('-')) {
        const std::string name = first.substr(0, first.find('='));
        return app.get_option_no_throw(name) != nullptr ? std::nullopt
                                                        : std::optional<Slip>({"", unknownOption(app, name)});
    }
    const CLI::App* command = findCommand(app, first);
    if (command == nullptr) {
        const std::string suggestion = base::suggestion(first, commandNames(app));
        return Slip{"", "unknown command \"" + first + "\"" +
                            (suggestion.empty() ? "; see glint --help for those there are" : suggestion)};
    }
    std::optional<std::string> message = findUnknownOption(*command, arguments.subspan(1));
    if (!message) {
        message = findEmptyValue(*command, arguments.subspan(1));
    }
    return message ? std::optional<Slip>({first, *message}) : std::nullopt;
}

std::string shortText(const CLI::Option& option) {
    std::string text = option.get_description();
    std::ranges::replace(text, '\n', ' ');
    std::size_t end = text.size();
    for (const char* const rest : {"; ", ": ", " ("}) {
        end = std::min(end, text.find(rest));
    }
    return text.substr(0, end);
}

std::string namesOf(const CLI::Option& option) {
    if (option.get_positional()) {
        return option.get_name(true);
    }
    std::string names;
    for (const std::string& name : option.get_snames()) {
        names += "-" + name + ",";
    }
    constexpr std::string_view kNo = "no-";
    const std::vector<std::string>& all = option.get_lnames();
    for (const std::string& name : all) {
        const bool isOff =
            name.starts_with(kNo) && std::ranges::find(all, name.substr(kNo.size())) != all.end();
        const bool hasOff = std::ranges::find(all, std::string(kNo) + name) != all.end();
        names += isOff ? "" : (hasOff ? "--[no-]" : "--") + name + ",";
    }
    names.pop_back();
    return names;
}

namespace {

// Returns the text after the last ": " of a message, or all of it.
std::string rest(const std::string& message) {
    const std::size_t colon = message.rfind(": ");
    return colon == std::string::npos ? message : message.substr(colon + 2);
}

std::string explainExtras(const std::string& words, const CLI::App& command) {
    if (words.starts_with('-')) {
        return unknownOption(command, words.substr(0, words.find(' ')));
    }
    return "\"" + words + "\" is more than the command takes; leave it out, or quote names that have blanks";
}

std::string explainMissing(const std::string& name, const CLI::App& command) {
    const CLI::Option* const option = command.get_option_no_throw(name);
    return option == nullptr ? name + " is missing; give it"
                             : name + " is missing; give " + shortText(*option);
}

}  // namespace

std::string explain(const CLI::ParseError& error, const CLI::App& command) {
    std::string message = error.what();
    const auto before = [&](std::string_view text) { return message.substr(0, message.find(text)); };
    const auto after = [&](std::string_view text) {
        const std::size_t at = message.find(text);
        return at == std::string::npos ? std::string() : message.substr(at + text.size());
    };
    if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
        return explainExtras(rest(message), command);
    }
    if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
        return explainMissing(before(" is required"), command);
    }
    if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr) {
        return before(" requires ") + ": needs " + after(" requires ") + "; give both, or neither";
    }
    if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr) {
        return before(" excludes ") + ": can't be combined with " + after(" excludes ") +
               "; leave out one of them";
    }
    if (dynamic_cast<const CLI::ValidationError*>(&error) != nullptr) {
        return message;  // Glint's own
    }
    // Numbers of values, and values of options without values.
    const std::string unread = after("Could not convert: ");
    const std::string name = unread.empty() ? before(":") : unread.substr(0, unread.find(" = "));
    const CLI::Option* const option = command.get_option_no_throw(name);
    if (option == nullptr) {
        return "the command line can't be understood; see --help";
    }
    if (option->get_items_expected_max() == 0) {
        return name + ": takes no value but on and off; give " + name + " or --no-" + name.substr(2);
    }
    return option->results().size() > 1 ? name + ": is given more than once; give it once"
                                        : name + ": its value is missing; give " + option->get_type_name();
}

HelpFormatter::HelpFormatter(CommandText text) : text_(std::move(text)) {
    column_width(32);
    label("SUBCOMMAND", "COMMAND");
    label("REQUIRED", "(required)");
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
    if (app->get_parent() == nullptr || mode == CLI::AppFormatMode::Sub) {
        return CLI::Formatter::make_help(app, std::move(name), mode);
    }
    if (mode == CLI::AppFormatMode::Normal) {
        return shortHelp(*app, name);
    }
    return make_description(app) + make_usage(app, std::move(name)) + make_positionals(app) +
           make_groups(app, mode);
}

std::string HelpFormatter::shortHelp(const CLI::App& command, const std::string& name) const {
    const auto lineOf = [&](const CLI::Option& option) {
        std::string left = "  " + namesOf(option) + make_option_opts(&option);
        if (left.size() + 1 > get_column_width()) {
            left = "  " + namesOf(option) + " WORD";
        }
        left.resize(std::max(left.size() + 1, get_column_width()), ' ');
        return left + shortText(option) + "\n";
    };
    std::string text = make_description(&command) + "\n" + make_usage(&command, name) + "\n";
    std::size_t count = 0;
    for (const CLI::Option* const option : command.get_options()) {
        text += option->get_positional() ? lineOf(*option) : "";
        count += option->nonpositional() ? 1 : 0;
    }
    for (const std::string& option : text_.usual) {
        text += lineOf(*command.get_option(option));
    }
    text += "\nExamples:\n";
    for (const std::string& example : text_.examples) {
        text += "  " + example + "\n";
    }
    return text + "\n--help-all lists all " + std::to_string(count) + " options.\n";
}

std::string HelpFormatter::make_option_name(const CLI::Option* option, bool isPositional) const {
    return isPositional ? option->get_name(true) : namesOf(*option);
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
    std::string text;
    if (option->get_type_size() != 0) {
        const std::string type = option->get_type_name();
        text += type.empty() || (option->get_positional() && type == option->get_name()) ? "" : " " + type;
        const bool many = option->get_expected_max() >= CLI::detail::expected_max_vector_size;
        text += many && option->get_positional() ? "..." : "";
        text += option->get_required() ? " " + get_label("REQUIRED") : "";
    }
    return text;
}

}  // namespace glint::cli
