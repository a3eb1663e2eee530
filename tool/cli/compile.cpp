// glint compile: a scene's materials into a package.
#include "emit/compile.h"

#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/held_signals.h"
#include "cli/plan_choice.h"
#include "cli/read_scenes.h"
#include "cli/report.h"
#include "cli/table.h"
#include "cli/tracing_options.h"
#include "emit/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <span>

namespace glint {

namespace {

using Clock = std::chrono::steady_clock;

struct CompileArguments {
    std::vector<std::string> scenes;
    std::string output;
    TracingArguments tracing;
    std::string variant;
    PlanArguments plan;
    AccuracyArguments accuracy;
    std::vector<std::string> emit{"header"};
    std::int64_t jobs = 0;
    bool environmentMap = false;
    bool debugInfo = false;
    bool warningsAsErrors = false;
    bool json = false;
    bool dryRun = false;
};

// What there is to tell at the end. The package is absent after a dry run.
struct Outcome {
    const CompileArguments& arguments;
    const SceneList& scenes;
    std::span<const Diagnostic> warnings;
    const Plan& plan;
    const CompiledPackage* package = nullptr;
    double milliseconds = 0.0;

    std::uint64_t packageBytes() const {
        std::uint64_t bytes = 0;
        for (const PackageFile& file : package->files) {
            bytes += file.bytes.size();
        }
        return bytes;
    }
};

CompileSettings settingsOf(const CompileArguments& arguments, PlanOptions plan) {
    const auto emits = [&](const char* what) {
        return std::find(arguments.emit.begin(), arguments.emit.end(), what) != arguments.emit.end();
    };
    CompileSettings settings;
    arguments.tracing.apply(settings);
    settings.plan = std::move(plan);
    arguments.accuracy.apply(settings);
    settings.jobs = static_cast<int>(arguments.jobs);
    settings.emitHeader = emits("header");
    settings.emitGlsl = emits("glsl");
    settings.environmentMap = arguments.environmentMap;
    settings.debugInfo = arguments.debugInfo;
    return settings;
}

// The shading module of each case, if the package has them one by one.
std::map<int, const CompiledModule*> caseModules(const CompiledPackage* package) {
    std::map<int, const CompiledModule*> modules;
    if (package != nullptr) {
        for (const CompiledModule& module : package->modules) {
            if (module.key.role == package::ModuleRole::ShadeCase) {
                modules[static_cast<int>(module.key.index)] = &module;
            }
        }
    }
    return modules;
}

Json shadersToJson(const Outcome& outcome) {
    const std::map<int, const CompiledModule*> modules = caseModules(outcome.package);
    Json list = Json::array();
    for (const Case& shader : outcome.plan.cases) {
        if (shader.isRetired()) {
            continue;
        }
        Json entry{{"id", shader.shaderId},
                   {"name", shader.name},
                   {"always", featuresToJson(shader.always)},
                   {"sometimes", featuresToJson(shader.sometimes)},
                   {"keys", shader.keys.size()},
                   {"share", shareToJson(shader.share)},
                   {"reason", toString(shader.reason)},
                   {"materials", materialsToJson(outcome.scenes, shader.materials)}};
        const auto found = modules.find(shader.shaderId);
        if (found != modules.end()) {
            const CompiledModule& module = *found->second;
            entry["spirv"] = Json{{"file", module.file},
                                  {"bytes", module.statistics.bytes},
                                  {"instructions", module.statistics.instructions},
                                  {"textureFetches", module.statistics.textureFetches},
                                  {"rayQueries", module.statistics.rayQueries}};
        }
        list.push_back(std::move(entry));
    }
    return list;
}

Json toJson(const Outcome& outcome) {
    const CompiledPackage* package = outcome.package;
    const auto orNull = [&](auto value) { return package ? Json(value()) : Json(nullptr); };
    return {{"counts",
             {{"scenes", outcome.scenes.scenes().size()},
              {"materials", outcome.scenes.materials().size()},
              {"keysPossible", countToJson(outcome.plan.keysPossible)},
              {"keysPresent", outcome.plan.keys.size()},
              {"cases", caseCount(outcome.plan)},
              {"uniqueSpirv", orNull([&] { return package->uniqueSpirv; })}}},
            {"spirvBytes", orNull([&] { return package->spirvBytes; })},
            {"packageBytes", orNull([&] { return outcome.packageBytes(); })},
            {"milliseconds", outcome.milliseconds},
            {"variant", textOrNull(outcome.scenes.variant())},
            {"shaders", shadersToJson(outcome)},
            {"dropped", droppedToJson(outcome.scenes, outcome.plan)},
            {"warnings", glint::toJson(outcome.warnings)},
            {"output", orNull([&] { return outcome.arguments.output; })}};
}

std::string toText(const Outcome& outcome) {
    const Plan& plan = outcome.plan;
    std::vector<std::vector<std::string>> rows{
        {"materials", fmt::format("{}", outcome.scenes.materials().size())},
        {"keys possible", fmt::format("{:.0f}", plan.keysPossible)},
        {"keys present", fmt::format("{}", plan.keys.size())},
        {"cases", fmt::format("{}", caseCount(plan))}};
    if (outcome.package != nullptr) {
        rows.push_back({"unique SPIR-V", fmt::format("{}", outcome.package->uniqueSpirv)});
        rows.push_back({"SPIR-V bytes", formatBytes(outcome.package->spirvBytes)});
        rows.push_back({"package bytes", formatBytes(outcome.packageBytes())});
    }
    rows.push_back({"time", fmt::format("{:.0f} ms", outcome.milliseconds)});
    const bool written = outcome.package != nullptr;
    rows.push_back({"output", written ? outcome.arguments.output : "none (dry run)"});
    return formatFields(rows) + droppedText(plan);
}

void tell(const Console& console, Outcome outcome, Clock::time_point start) {
    outcome.milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    console.print(outcome.arguments.json ? glint::toText(toJson(outcome)) : toText(outcome));
}

int fail(const Console& console, const Diagnostic& error) {
    console.report(error);
    return kExitFailed;
}

int planOnly(const Console& console, Outcome outcome, const PlanOptions& options, Clock::time_point start) {
    if (const std::optional<std::string> excess = describeExcess(outcome.plan, options)) {
        return fail(console, makeError("max-shaders", outcome.scenes.path(), *excess));
    }
    tell(console, outcome, start);
    return kExitDone;
}

// An interruption waits, so that it leaves no staging folder behind.
Status writeWhole(const CompiledPackage& package, const std::string& folder) {
    const HeldSignals held;
    return writePackage(package, folder);
}

int compile(const Console& console, const CompileArguments& arguments) {
    const Clock::time_point start = Clock::now();
    console.progress("reading " + join(arguments.scenes));
    ImportOptions import;
    import.variant = arguments.variant;
    const Result<std::vector<Scene>> scenes = readScenes(arguments.scenes, import);
    if (!scenes) {
        return fail(console, scenes.error());
    }
    const SceneList list(*scenes);
    Result<PlanChoice> plan = choosePlan(arguments.plan, list);
    if (!plan) {
        return fail(console, plan.error());
    }
    std::vector<Diagnostic> warnings = warningsOf(*scenes);
    warnings.insert(warnings.end(), plan->warnings.begin(), plan->warnings.end());
    console.report(warnings);
    console.report(plan->notes);
    if (arguments.warningsAsErrors && !warnings.empty()) {
        return fail(console, makeError("werror", list.path(), "has warnings, and --werror makes them errors",
                                       "mend them, or leave out --werror"));
    }
    if (arguments.dryRun) {
        const Plan made = makePlan(list.materials(), list.primitives(), plan->options);
        return planOnly(console, Outcome{arguments, list, warnings, made}, plan->options, start);
    }
    console.progress("compiling " + join(arguments.scenes));
    const Result<CompiledPackage> package =
        compilePackage(*scenes, settingsOf(arguments, std::move(plan->options)));
    if (!package) {
        return fail(console, package.error());
    }
    console.progress("writing " + arguments.output);
    if (Status written = writeWhole(*package, arguments.output); !written) {
        return fail(console, written.error());
    }
    tell(console, Outcome{arguments, list, warnings, package->plan, &*package}, start);
    return kExitDone;
}

void addShaderOptions(CLI::App& command, CompileArguments& arguments) {
    addTracingLists(command, arguments.tracing);
    addPlanOptions(command, arguments.plan);
    addProfileInput(command, arguments.plan);
    addAccuracyOptions(command, arguments.accuracy);
    addFlag(command, "--environment-map", arguments.environmentMap,
            "what leaves the scene sees an environment map, which\nrenderers then need; without: a gradient")
        .group("Shaders");
    addFlag(command, "--debug-info", arguments.debugInfo, "keep names in the SPIR-V, for debuggers")
        .group("Shaders");
}

void addOutputOptions(CLI::App& command, CompileArguments& arguments) {
    addText(command, "-o,--output", arguments.output, "DIR",
            "folder of the package; one that is there is replaced\n(required without --dry-run)")
        .group("Output");
    addChoices(command, "--emit", arguments.emit, {"glsl", "header"},
               "what else the package holds, separated by commas:\n"
               "glsl: the shaders' sources; header: C++ tables")
        .group("Output");
    addFlag(command, "--dry-run", arguments.dryRun, "plan only: compile and write nothing").group("Output");
    addInteger(command, "--jobs", arguments.jobs, 0, 1024, "threads that compile; 0: one a core")
        .group("Output");
}

}  // namespace

void addCompile(CLI::App& app, Action& chosen) {
    auto arguments = std::make_shared<CompileArguments>();
    CLI::App& command = addCommand(app, "compile", "Compile a scene's materials into a package of shaders",
                                   "glint compile scene.gltf -o scene.glint --merge none --emit glsl,header");
    addTexts(command, "SCENE", arguments->scenes, "FILE",
             "the scenes, .gltf or .glb; several share the shaders,\nand each has its own tables")
        .required();
    addVariant(command, arguments->variant);
    addOutputOptions(command, *arguments);
    addShaderOptions(command, *arguments);
    addFlag(command, "--werror", arguments->warningsAsErrors,
            "fail on any warning, before anything is written")
        .group("Report");
    addFlag(command, "--json", arguments->json, "print the summary as JSON").group("Report");
    command.callback([arguments, &chosen] {
        if (arguments->output.empty() && !arguments->dryRun) {
            throw CLI::RequiredError("-o DIR (or --dry-run)");
        }
        settleProfile(arguments->plan);
        chosen = [arguments](const Console& console) { return compile(console, *arguments); };
    });
}

}  // namespace glint
