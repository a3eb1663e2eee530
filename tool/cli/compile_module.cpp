// glint compile-module: compiles one module of a plan.
#include "base/files.h"
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/report.h"
#include "emit/module_files.h"

#include <memory>

namespace glint::cli {

namespace {

struct ModuleArguments {
    std::string input;
    std::string output;
};

int compileModule(const Console& console, const ModuleArguments& arguments) {
    if (Status possible = base::checkOutputFile(arguments.output); !possible) {
        return fail(console, possible.error());
    }
    console.progress("compiling " + arguments.input);
    if (Status done = compiler::compileModuleFile(arguments.input, arguments.output); !done) {
        console.report(done.error());
        return kExitFailed;
    }
    if (console.isJson()) {
        console.result(base::Json{{"input", arguments.input}, {"output", arguments.output}});
    }
    return kExitDone;
}

}  // namespace

void addCompileModule(CLI::App& app, Action& chosen) {
    auto arguments = std::make_shared<ModuleArguments>();
    CLI::App& command = addCommand(
        app, {.name = "compile-module",
              .what = "Compile one module of a plan, for build farms",
              .examples = {"glint compile-module plan/modules/0.glsl -o plan/modules/0.module",
                           "glint compile-module plan/modules/0.glsl -o plan/modules/0.module --json"},
              .usual = {"--output", "--quiet"}});
    addText(command, "IN", arguments->input, "FILE", "a module that glint compile --plan-only wrote")
        .required();
    addOutputFile(command, "-o,--output", arguments->output, "FILE", {},
                  "the compiled module, which glint compile --modules takes")
        .required();
    command.callback([arguments, &chosen] {
        chosen = [arguments](const Console& console) { return compileModule(console, *arguments); };
    });
}

}  // namespace glint::cli
