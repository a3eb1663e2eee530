// glint diff: shows the differences between two packages.
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/diff_compare.h"
#include "cli/diff_report.h"

#include <memory>

namespace glint {

namespace {

struct DiffArguments {
    std::string before;
    std::string after;
    bool exitCode = false;
};

int diff(const Console& console, const DiffArguments& arguments) {
    const Result<DiffPackage> before = readDiffPackage(arguments.before);
    if (!before) {
        console.report(before.error());
        return kExitFailed;
    }
    const Result<DiffPackage> after = readDiffPackage(arguments.after);
    if (!after) {
        console.report(after.error());
        return kExitFailed;
    }
    const PackageDiff difference = comparePackages(*before, *after);
    const DiffSides sides{arguments.before, arguments.after, *before, *after};
    if (console.isJson()) {
        console.result(diffJson(difference, sides));
    } else {
        console.print(diffText(difference, sides, console.isVerbose() ? Detail::Whole : Detail::Short));
    }
    return arguments.exitCode && !difference.isEmpty() ? kExitFailed : kExitDone;
}

}  // namespace

void addDiff(CLI::App& app, Action& chosen) {
    auto arguments = std::make_shared<DiffArguments>();
    CLI::App& command = addCommand(app, "diff", "Show what is different between two packages",
                                   "glint diff before.glint after.glint");
    addText(command, "A", arguments->before, "DIR", "folder of the package before").required();
    addText(command, "B", arguments->after, "DIR", "folder of the package after").required();
    addFlag(command, "--exit-code", arguments->exitCode, "exit 1 if anything differs");
    command.callback([arguments, &chosen] {
        chosen = [arguments](const Console& console) { return diff(console, *arguments); };
    });
}

}  // namespace glint
