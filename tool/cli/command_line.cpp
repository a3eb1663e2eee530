#include "cli/command_line.h"

#include "base/suggest.h"
#include "cli/commands.h"
#include "gltf/basisu.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

namespace {

using Arguments = std::span<const char* const>;

void describe(CLI::App& app) {
    app.name("glint");
    app.description("Compiles the materials of glTF scenes into ray-query hit shaders, and runs them.");
    app.set_version_flag("--version",
                         std::string("glint ") + GLINT_VERSION +
                             (gltf::hasBasisu() ? "\nKTX2 textures (KHR_texture_basisu): read by libktx"
                                                : "\nKTX2 textures (KHR_texture_basisu): not built in"),
                         "Print the version and what is built in, and exit");
    app.set_help_flag("-h,--help", "Print this help and exit");
    app.footer(
        "Exit: 0 done; 1 the input or the work failed; 2 the command line is wrong.\n"
        "Results go to stdout, diagnostics and progress to stderr.\n"
        "Environment: NO_COLOR turns colour off; TMPDIR holds temporary files.\n"
        "Run glint COMMAND --help for the options of a command.");
    app.get_formatter()->label("SUBCOMMAND", "COMMAND");
    app.get_formatter()->label("REQUIRED", "(required)");
    app.require_subcommand(1);
}

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

// Null if there is none of that name.
const CLI::App* findCommand(const CLI::App& app, const std::string& name) {
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
    return "unknown option " + name + suggestion(name, optionNames(app));
}

// The first unknown long option, and what may have been meant.
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

struct Slip {
    std::string command;  // empty: glint itself
    std::string message;
};

// Misspelt commands and options, found before CLI11 complains about what is missing because of them.
std::optional<Slip> findSlip(const CLI::App& app, Arguments arguments) {
    if (arguments.empty()) {
        return Slip{"", "a command is missing"};
    }
    const std::string first = arguments[0];
    if (first.starts_with('-')) {
        const std::string name = first.substr(0, first.find('='));
        return app.get_option_no_throw(name) != nullptr ? std::nullopt
                                                        : std::optional<Slip>({"", unknownOption(app, name)});
    }
    const CLI::App* command = findCommand(app, first);
    if (command == nullptr) {
        return Slip{"", "unknown command \"" + first + "\"" + suggestion(first, commandNames(app))};
    }
    const std::optional<std::string> unknown = findUnknownOption(*command, arguments.subspan(1));
    return unknown ? std::optional<Slip>({first, *unknown}) : std::nullopt;
}

int refuse(const Slip& slip) {
    const std::string command = slip.command.empty() ? "glint" : "glint " + slip.command;
    std::fprintf(stderr, "%s: error: %s\nRun %s --help for its options.\n", command.c_str(),
                 slip.message.c_str(), command.c_str());
    return kExitUsage;
}

// Runs the work, and fails if its results could not be written.
int act(const Action& chosen) {
    const Console console;
    const int code = chosen(console);
    if (Status flushed = console.flush(); !flushed) {
        console.report(flushed.error());
        return kExitFailed;
    }
    return code;
}

}  // namespace

int runCommandLine(int argc, const char* const* argv) {
    CLI::App app;
    Action chosen;
    describe(app);
    addCompile(app, chosen);
    addExplain(app, chosen);
    addInspect(app, chosen);
    addLint(app, chosen);
    addRender(app, chosen);
    addCompare(app, chosen);

    const Arguments arguments = Arguments(argv, static_cast<std::size_t>(argc)).subspan(argc > 0 ? 1 : 0);
    const std::optional<Slip> slip = findSlip(app, arguments);
    if (slip) {
        return refuse(*slip);
    }
    const std::string command = arguments[0][0] == '-' ? "" : arguments[0];
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& request) {
        return app.exit(request, std::cout, std::cerr);
    } catch (const CLI::ParseError& error) {
        return refuse({command, error.what()});
    }
    return act(chosen);
}

}  // namespace glint
