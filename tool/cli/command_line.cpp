#include "cli/command_line.h"

#include "cli/options/options.h"
#include "cli/options/setting_options.h"
#include "gltf/codecs/codecs.h"
#include "spirv/compiler.h"

#include <glint/internal/package_format.h>
#include <glint/measure/machine.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <optional>
#include <system_error>
#include <unistd.h>

namespace glint::cli {

using Arguments = std::span<const char* const>;

Diagnostic startCompanion(const char* program, Arguments line, const Diagnostic& missing) {
    std::error_code error;
    const std::string path =
        (std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / program).string();
    std::vector<char*> words{const_cast<char*>(path.c_str())};
    for (const char* const word : line) {
        words.push_back(const_cast<char*>(word));
    }
    words.push_back(nullptr);
    execv(path.c_str(), words.data());
    return missing;
}

namespace {

std::string versionText() {
    return fmt::format(
        "glint {}, commit {}\n"
        "package format {}\n"
        "glslang {}, SPIRV-Tools {}\n"
        "KTX2 textures (KHR_texture_basisu): {}",
        GLINT_VERSION, measure::sourceCommit(), package::kVersion, compiler::glslangVersion(),
        compiler::spirvToolsVersion(),
        gltf::hasBasisu() ? "read by the transcoder of Basis Universal" : "not built in");
}

void describe(CLI::App& app) {
    app.formatter(std::make_shared<HelpFormatter>());
    app.name("glint");
    app.description("Compiles the materials of glTF scenes into shaders for ray hits, and runs them.");
    app.set_version_flag("--version", versionText(), "print the version and what is built in, and exit");
    app.set_help_flag("-h,--help", "print this help and exit");
    app.set_help_all_flag("--help-all", "print all options and exit");
    app.footer(
        "Exit: 0 done; 1 the input or the work failed; 2 the command line is wrong.\n"
        "Results go to stdout, diagnostics and progress to stderr.\n"
        "Boolean options: --x sets and --no-x clears; the last one counts.\n"
        "Environment: NO_COLOR turns colour off; GLINT_CACHE names the folder that keeps\n"
        "compiled shaders (see glint compile --help-all).\n"
        "glint help COMMAND says what a command is for.");
    app.require_subcommand(1);
}

int refuse(const Slip& slip) {
    const std::string command = slip.command.empty() ? "glint" : "glint " + slip.command;
    std::fprintf(stderr, "%s: error: %s\nRun %s --help for its options.\n", command.c_str(),
                 slip.message.c_str(), command.c_str());
    return kExitUsage;
}

// glint help COMMAND is glint COMMAND --help.
void addHelp(CLI::App& app, Action& chosen) {
    const std::vector<std::string> names = commandNames(app);
    CLI::App& help = addCommand(app, {.name = "help",
                                      .what = "Show what a command is for, and its usual options",
                                      .examples = {"glint help render", "glint help"},
                                      .usual = {"--help"}});
    auto topic = std::make_shared<std::string>();
    addChoice(help, "COMMAND", *topic, names, "the command").type_name("");
    help.callback([topic, &app, &chosen] {
        chosen = [topic, &app](const Console& console) {
            console.print(topic->empty()
                              ? app.get_formatter()->make_help(&app, "glint", CLI::AppFormatMode::Normal)
                              : app.get_subcommand(*topic)->help("glint"));
            return kExitDone;
        };
    });
}

// Runs the work. It fails if a warning counts as an error, or if its results could not be written.
int act(const Action& chosen, const ReportArguments& report) {
    const Console console(report.options());
    const Result<int> done = chosen(console);
    int code = done ? *done : fail(console, done.error());
    if (console.refused()) {
        console.report(makeError("werror", "", "there are warnings that count as errors",
                                 "fix them, or leave out --werror and -Werror"));
        code = kExitFailed;
    }
    if (Status finished = console.finish(); !finished) {
        console.report(finished.error());
        return kExitFailed;
    }
    return code;
}

int run(int argc, const char* const* argv, const Companion& companion) {
    CLI::App app;
    Action chosen;
    describe(app);
    const Arguments arguments = Arguments(argv, static_cast<std::size_t>(argc)).subspan(argc > 0 ? 1 : 0);
    addCompile(app, chosen, arguments);
    addCompileModule(app, chosen);
    addExplain(app, chosen);
    addInspect(app, chosen);
    addDiff(app, chosen);
    addLint(app, chosen);
    addRender(app, chosen);
    addView(app, chosen, arguments, companion);
    addBench(app, chosen);
    addCompare(app, chosen);
    addCheckMaterials(app, chosen, arguments, companion);
    ReportArguments report;
    for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        addReportOptions(*command, report);
    }
    addCompletion(app, chosen);
    addHelp(app, chosen);

    const std::optional<Slip> slip = findSlip(app, arguments);
    if (slip) {
        return refuse(*slip);
    }
    const std::string command = arguments[0][0] == '-' ? "" : arguments[0];
    const Result<CompletedLine> line = completeLine(app, arguments);
    if (!line) {
        Console().report(line.error());
        return kExitFailed;
    }
    try {
        // CLI11 takes the words in reverse order.
        std::vector<std::string> words(line->words.rbegin(), line->words.rend());
        app.parse(words);
        report.check();
    } catch (const CLI::Success& request) {
        return app.exit(request, std::cout, std::cerr);
    } catch (const CLI::ParseError& error) {
        const std::string message = explain(error, command.empty() ? app : *app.get_subcommand(command));
        if (const std::optional<Diagnostic> ofFile = blameFile(*line, message)) {
            Console().report(*ofFile);
            return kExitFailed;
        }
        return refuse({command, message});
    }
    return act(chosen, report);
}

}  // namespace

int runCommandLine(int argc, const char* const* argv, const Companion& companion) {
    try {
        return run(argc, argv, companion);
    } catch (const std::bad_alloc&) {
        std::fputs(
            "error: the work does not fit into memory; use smaller inputs, or a machine with more"
            " [out-of-memory]\n",
            stderr);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "glint: error: %s\n", error.what());
    }
    return kExitFailed;
}

}  // namespace glint::cli
