// glint compile-module: compiles one module of a plan.
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
    CLI::App& command =
        addCommand(app, "compile-module",
                   "Compile one module of a plan; reads its text and compiled parts, writes one file",
                   "glint compile-module plan/modules/0.glsl -o plan/modules/0.module");
    addText(command, "IN", arguments->input, "FILE", "a module that glint compile --plan-only wrote")
        .required();
    addText(command, "-o,--output", arguments->output, "FILE",
            "the compiled module, which glint compile --modules takes")
        .required();
    command.callback([arguments, &chosen] {
        chosen = [arguments](const Console& console) { return compileModule(console, *arguments); };
    });
}

}  // namespace glint::cli
