// glint inspect: shows the contents of a package.
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/inspect_package.h"

#include <memory>

namespace glint {

namespace {

struct InspectArguments {
    std::string folder;
    std::string disassemble;  // empty: an overview instead
};

int tell(const Console& console, const InspectedPackage& inspected) {
    if (console.isJson()) {
        console.result(toJson(inspected));
    } else {
        console.print(toText(inspected, console.isVerbose() ? Detail::Whole : Detail::Short));
    }
    return kExitDone;
}

int tell(const Console& console, const InspectedPackage& inspected, const std::vector<Disassembly>& list) {
    if (console.isJson()) {
        console.result(toJson(inspected, list));
    } else {
        console.print(toText(inspected, list));
    }
    return kExitDone;
}

int inspect(const Console& console, const InspectArguments& arguments) {
    console.progress("reading " + arguments.folder);
    const Result<Package> package = Package::load(arguments.folder);
    if (!package) {
        return fail(console, package.error());
    }
    const Result<Manifest> manifest = readManifest(arguments.folder);
    if (!manifest) {
        return fail(console, manifest.error());
    }
    const Result<InspectedPackage> inspected = inspectPackage(*package, *manifest, arguments.folder);
    if (!inspected) {
        return fail(console, inspected.error());
    }
    if (arguments.disassemble.empty()) {
        return tell(console, *inspected);
    }
    const Result<std::vector<Disassembly>> list = disassembleModules(*inspected, arguments.disassemble);
    return list ? tell(console, *inspected, *list) : fail(console, list.error());
}

}  // namespace

void addInspect(CLI::App& app, Action& chosen) {
    auto arguments = std::make_shared<InspectArguments>();
    CLI::App& command = addCommand(app, "inspect", "Show what a package holds", "glint inspect scene.glint");
    addText(command, "DIR", arguments->folder, "DIR", "folder of the package").required();
    addText(command, "--disassemble", arguments->disassemble, "ID|NAME",
            "print modules as SPIR-V assembly instead: those of a\n"
            "shader by ID or name, of a role, or of a file (default:\n"
            "off)");
    command.callback([arguments, &chosen] {
        chosen = [arguments](const Console& console) { return inspect(console, *arguments); };
    });
}

}  // namespace glint
