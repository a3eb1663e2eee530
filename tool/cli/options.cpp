#include "cli/options.h"

#include "cli/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

namespace glint {

namespace {

// CLI11 shows a check's description beside the option's type; the help text says it already.
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

CLI::Option& checkChoice(CLI::Option* option, const std::vector<std::string>& choices) {
    return check(option, [choices](const std::string& text) {
        if (std::find(choices.begin(), choices.end(), text) != choices.end()) {
            return std::string();
        }
        return fmt::format("{} is none of {}{}", quoted(text), fmt::join(choices, ", "),
                           suggestion(text, choices));
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
    CLI::Option* option = command.add_option(flags, value, fmt::format("{} (default: {})", help, value))
                              ->type_name(fmt::format("{}", fmt::join(choices, "|")));
    return checkChoice(option, choices);
}

CLI::Option& addChoices(CLI::App& command, const std::string& flags, std::vector<std::string>& values,
                        const std::vector<std::string>& choices, const std::string& help) {
    CLI::Option* option =
        command.add_option(flags, values, fmt::format("{} (default: {})", help, fmt::join(values, ",")))
            ->type_name(fmt::format("{}", fmt::join(choices, ",")))
            ->delimiter(',')
            ->allow_extra_args(false);
    return checkChoice(option, choices);
}

CLI::Option& addInteger(CLI::App& command, const std::string& flags, std::int64_t& value, std::int64_t min,
                        std::int64_t max, const std::string& help) {
    CLI::Option* option =
        command.add_option(flags, value, fmt::format("{} ({} to {}, default: {})", help, min, max, value))
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
        return parseReal(text, min, max, number)
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

PlanOptions PlanArguments::options() const {
    PlanOptions plan;
    plan.merge = merge == "none"  ? MergePolicy::None
                 : merge == "all" ? MergePolicy::All
                                  : MergePolicy::Family;
    plan.keys.alpha = alpha == "tested" ? AlphaPolicy::Tested : AlphaPolicy::Opaque;
    return plan;
}

PlanFlags addPlanOptions(CLI::App& command, PlanArguments& arguments) {
    CLI::Option& merge = addChoice(command, "--merge", arguments.merge, {"none", "family", "all"},
                                   "which permutations share a shader:\n"
                                   "none: every permutation its own; family: those with the\n"
                                   "same lobes; all: one shader");
    CLI::Option& alpha = addChoice(command, "--alpha", arguments.alpha, {"opaque", "tested"},
                                   "alpha masks of hits; opaque: ignored;\ntested: each candidate is tested");
    merge.group("Shaders");
    alpha.group("Shaders");
    return {&merge, &alpha};
}

bool parseReal(const std::string& text, double min, double max, double& value) {
    return parseWhole(text, value) && value >= min && value <= max;
}

}  // namespace glint
