// glint compile: compiles a scene's materials into a package.
#include "cli/compile/compile.h"

#include "base/clock.h"
#include "base/files.h"
#include "base/lists.h"
#include "cli/command_line.h"
#include "cli/options/options.h"
#include "cli/table.h"
#include "emit/package/compiled_package.h"
#include "emit/package/header.h"
#include "emit/package/manifest.h"
#include "gltf/import.h"
#include "materials/declarations.h"
#include "resolve/build.h"

#include <glint/measure/target.h>
#include <glint/result.h>
#include <glint/session/session.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <span>

namespace glint::cli {

namespace {

// --- All results in one step: all files are complete on disk before any of them is moved into place ---

// A full disk leaves everything as it was. Interruptions wait until this is done. Outputs without a name are
// not written; the build says whether the lock file is. `written` is that of writePackage(). Has the errors
// of writePackage(), stageEmbeddedSource() and makeDepfile(), and "file-write".
Status writeOutputs(const compiler::Build& build, const compiler::CompiledPackage& package,
                    const CompileArguments& arguments, std::span<const std::string> dependencies,
                    compiler::WrittenPackage* written) {
    const HeldSignals held;
    // The files outside the package's folder, in the order in which they are moved into place.
    std::vector<base::StagedFile> staged;
    const auto stage = [&](const std::filesystem::path& path, std::string_view text) -> Status {
        base::removeAbandoned(path);
        GLINT_TRY(auto file, base::StagedFile::create(path, base::asBytes(text)));
        staged.push_back(std::move(file));
        return okStatus();
    };
    if (build.lockText) {
        GLINT_TRY_DO(stage(build.settings.lock.file, *build.lockText));
    }
    if (!arguments.embed.empty()) {
        GLINT_TRY(auto embedded, stageEmbeddedSource(*build.scenes, package, arguments.embed));
        std::ranges::move(embedded, std::back_inserter(staged));
    }
    // The dependency file comes last, because it tells Make and Ninja that the others exist.
    if (!arguments.depfile.file.empty()) {
        GLINT_TRY(const auto text, compiler::makeDepfile(arguments.depfile.targets, dependencies));
        GLINT_TRY_DO(stage(arguments.depfile.file, text));
    }
    if (!arguments.output.empty()) {
        GLINT_TRY_DO(writePackage(package, arguments.output, written));
    }
    for (base::StagedFile& file : staged) {
        GLINT_TRY_DO(file.commit());
    }
    return okStatus();
}

// The facts to report at the end. The package is absent after a dry run, and after planning.
struct Outcome {
    const CompileArguments& arguments;
    const compiler::Build& build;
    const gltf::SceneList& scenes = *build.scenes;
    const compiler::Plan& plan = build.plan;
    const compiler::CompiledPackage* package = nullptr;
    std::optional<std::size_t> planned{};  // distinct modules, after --plan-only

    std::uint64_t packageBytes() const {
        return base::sumOf<std::uint64_t>(
            package->files, [](const compiler::PackageFile& file) { return file.bytes.size(); });
    }
};

base::Json shadersToJson(const Outcome& outcome) {
    base::Json list = base::Json::array();
    for (const compiler::Case& shader : outcome.plan.cases) {
        if (shader.isRetired()) {
            continue;
        }
        list.push_back({{"id", shader.shaderId},
                        {"name", shader.name},
                        {"always", outcome.plan.model->names(shader.always)},
                        {"sometimes", outcome.plan.model->names(shader.sometimes)},
                        {"keys", shader.keys.size()},
                        {"share", compiler::roundedShare(shader.share)},
                        {"reason", toString(shader.reason)},
                        {"materials", materialsToJson(outcome.scenes, shader.materials)},
                        {"stages", stagesToJson(outcome.package, shader.shaderId)}});
    }
    return list;
}

base::Json plannedToJson(const Outcome& outcome) {
    return outcome.planned ? base::Json{{"folder", outcome.arguments.planOnly.path},
                                        {"ninja", outcome.arguments.planOnly.buildFile()},
                                        {"modules", *outcome.planned}}
                           : base::Json(nullptr);
}

base::Json scenesToJson(const gltf::SceneList& scenes) {
    return listOf(scenes.scenes(), [](const gltf::Scene& scene) -> base::Json {
        return {{"file", scene.path},
                {"sceneInFile", base::jsonOf(compiler::orNone(gltf::sceneInFile(scene)))}};
    });
}

base::Json toJson(const Outcome& outcome) {
    const compiler::CompiledPackage* package = outcome.package;
    const auto orNull = [&](auto value) { return package ? base::Json(value()) : base::Json(nullptr); };
    return {{"counts",
             {{"scenes", outcome.scenes.scenes().size()},
              {"materials", outcome.scenes.materials().size()},
              {"keysPossible", base::jsonOf(compiler::wholeNumber(outcome.plan.keysPossible))},
              {"keysPresent", outcome.plan.keys.size()},
              {"cases", caseCount(outcome.plan)},
              {"uniqueSpirv", orNull([&] { return package->uniqueSpirv; })}}},
            {"spirvBytes", orNull([&] { return package->spirvBytes; })},
            {"packageBytes", orNull([&] { return outcome.packageBytes(); })},
            {"milliseconds", nullptr},
            {"modules", nullptr},
            {"upToDate", nullptr},
            {"scenes", scenesToJson(outcome.scenes)},
            {"variant", base::textOrNull(outcome.scenes.variant())},
            {"strategyChoice", base::jsonOf(outcome.build.settings.compile.strategyChoice)},
            {"shaders", shadersToJson(outcome)},
            {"dropped", droppedToJson(outcome.scenes, outcome.plan)},
            {"output", orNull([&] { return base::textOrNull(outcome.arguments.output); })},
            {"embedded", orNull([&] { return base::textOrNull(outcome.arguments.embed); })},
            {"plan", plannedToJson(outcome)}};
}

std::string chosenEffects(const compiler::EffectPlan& effects) {
    std::vector<std::string_view> names;
    for (const compiler::EffectDecision& decision : effects.decisions) {
        if (decision.chosen) {
            names.push_back(decision.name);
        }
    }
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

// Names those of the package's folder and the source that are written.
std::string outputsOf(const CompileArguments& arguments) {
    const bool both = !arguments.output.empty() && !arguments.embed.empty();
    return arguments.output + (both ? ", " : "") + arguments.embed;
}

Rows fieldsOf(const Outcome& outcome) {
    const compiler::Plan& plan = outcome.plan;
    Rows rows{{"materials", fmt::format("{}", outcome.scenes.materials().size())},
              {"keys possible", fmt::format("{:.0f}", plan.keysPossible)},
              {"keys present", fmt::format("{}", plan.keys.size())},
              {"cases", fmt::format("{}", caseCount(plan))}};
    const compiler::CompileSettings& settings = outcome.build.settings.compile;
    if (settings.strategyChoice) {
        rows.push_back({"strategies",
                        fmt::format("{} (auto)", base::join(compiler::strategyNames(settings.strategies)))});
    }
    if (outcome.package != nullptr) {
        rows.push_back({"effects", chosenEffects(plan.effects)});
        rows.push_back({"unique SPIR-V", fmt::format("{}", outcome.package->uniqueSpirv)});
        rows.push_back({"SPIR-V bytes", formatBytes(outcome.package->spirvBytes)});
        rows.push_back({"package bytes", formatBytes(outcome.packageBytes())});
    }
    if (outcome.planned) {
        rows.push_back({"to compile", fmt::format("{} modules", *outcome.planned)});
        rows.push_back({"next", "ninja -f " + base::shellWords({outcome.arguments.planOnly.buildFile()})});
        return rows;
    }
    const bool written = outcome.package != nullptr;
    rows.push_back({"output", written ? outputsOf(outcome.arguments) : "none (dry run)"});
    return rows;
}

CompileSummary summaryOf(const Outcome& outcome) {
    const int modules = outcome.package == nullptr ? 0 : static_cast<int>(outcome.package->modules.size());
    return {toJson(outcome), fieldsOf(outcome), droppedText(outcome.plan), modules};
}

// Reads each file with `options`. A variant is used in the scenes that have it. Has the errors of
// importScene(); "variant-unknown" only if no scene has the variant.
Result<std::vector<gltf::Scene>> readScenes(std::span<const std::string> files,
                                            const gltf::ImportOptions& options) {
    std::vector<gltf::Scene> scenes;
    bool hasVariant = options.variant.empty();
    std::optional<Diagnostic> missing;
    for (const std::string& file : files) {
        Result<gltf::Scene> scene = importScene(file, options);
        if (!scene && scene.error().id == "variant-unknown") {
            missing = missing ? missing : scene.error();
            gltf::ImportOptions defaults = options;
            defaults.variant.clear();
            scene = importScene(file, defaults);
        } else {
            hasVariant = true;
        }
        if (!scene) {
            return scene.error();
        }
        scenes.push_back(std::move(*scene));
    }
    if (!hasVariant) {
        return *missing;
    }
    return scenes;
}

// Returns the warnings of all scenes.
std::vector<Diagnostic> warningsOf(std::span<const gltf::Scene> scenes) {
    std::vector<Diagnostic> warnings;
    for (const gltf::Scene& scene : scenes) {
        warnings.insert(warnings.end(), scene.warnings.begin(), scene.warnings.end());
    }
    return warnings;
}

// Returns the plan that makes the package of these arguments.
compiler::NinjaPlan ninjaPlan(const CompileArguments& arguments) {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    const auto wordsWith = [&](const std::vector<std::string>& further) {
        std::vector<std::string> words{"compile"};
        words.insert(words.end(), arguments.words.begin(), arguments.words.end());
        words.insert(words.end(), further.begin(), further.end());
        words.emplace_back("--");
        words.insert(words.end(), arguments.scenes.begin(), arguments.scenes.end());
        return words;
    };
    std::vector<std::string> again = arguments.reportWords;
    again.push_back("--plan-only=" + arguments.planOnly.path);
    if (!arguments.launcher.empty()) {
        again.push_back("--launcher=" + arguments.launcher);
    }
    // Making the package is quiet, because planning has already reported everything.
    return {.tool = error ? "glint" : self.string(),
            .launcher = arguments.launcher,
            .folder = arguments.planOnly,
            .outputs = mainOutputs(arguments),
            .plan = wordsWith(again),
            .package = wordsWith({"--modules=" + arguments.planOnly.modules(),
                                  "--depfile=" + arguments.planOnly.packageDepfile(), "--quiet"})};
}

// Writes the plan of what would be compiled. The plan decides shader IDs, so the lock file is written now.
Result<int> planOnly(const Console& console, const CompileArguments& arguments, const compiler::Build& build,
                     std::span<const std::string> dependencies, base::Clock::time_point start) {
    GLINT_TRY(const auto planned, planPackage(build));
    console.progress("writing " + arguments.planOnly.buildFile());
    GLINT_TRY_DO(writePlan(ninjaPlan(arguments), planned, dependencies));
    if (build.lockText) {
        GLINT_TRY_DO(base::writeFile(arguments.settings.lock.file, *build.lockText));
    }
    GLINT_TRY_DO(writeDepfile(arguments.depfile, dependencies));
    const Outcome outcome{.arguments = arguments, .build = build, .planned = planned.modules.size()};
    tell(console, summaryOf(outcome), std::nullopt, false, base::millisecondsSince(start));
    return kExitDone;
}

// If nothing has to be done, repeats the output of an earlier run that did the same, and returns the exit
// code.
Result<std::optional<int>> repeatEarlier(const Console& console, const CompileArguments& arguments,
                                         CompileCache& cache, base::Clock::time_point start) {
    const std::optional<compiler::ActionRecord> earlier = cache.findUpToDate();
    const std::optional<CompileSummary> summary =
        earlier ? unpackSummary(earlier->summary, console.isJson()) : std::nullopt;
    if (!summary) {
        return std::optional<int>();
    }
    console.report(earlier->diagnostics);
    if (console.refused()) {
        return std::optional(kExitFailed);
    }
    GLINT_TRY_DO(writeDepfile(arguments.depfile, pathsOf(earlier->inputs)));
    tell(console, *summary, ModuleCounts{0, summary->modules}, true, base::millisecondsSince(start));
    return std::optional(kExitDone);
}

// Adds the files that a run has written.
bool addOutputs(const compiler::CompiledPackage& package, const CompileArguments& arguments,
                compiler::ActionRecord& run) {
    if (!arguments.output.empty()) {
        run.outputs = filesOf(package, arguments.output);
    }
    if (arguments.embed.empty()) {
        return true;
    }
    const std::filesystem::path embedded[] = {arguments.embed, compiler::embeddedHeader(arguments.embed)};
    return addFiles(run.outputs, embedded);
}

// Returns whether the files are GLSL of the packs of a model, and still there.
bool areGlsl(std::span<const std::string> files, const materials::MaterialModel& model) {
    return std::ranges::all_of(files, [&](const std::string& path) {
        const auto found = std::ranges::find(model.files, path, &materials::PackFile::path);
        std::error_code error;
        return found != model.files.end() && !found->isDeclaration && std::filesystem::exists(path, error);
    });
}

// Returns whether the files are of the scenes.
bool areOfScenes(std::span<const std::string> files, std::span<const gltf::Scene> scenes) {
    const std::vector<std::string> known = pathsOf(filesOf(scenes));
    return std::ranges::all_of(
        files, [&](const std::string& path) { return std::ranges::find(known, path) != known.end(); });
}

// Reads and decides. The run before may have `earlier`, of which holds what does not follow from the files
// that have `changed` since: the model if these are of scenes, and if they are GLSL of packs also the scenes
// and all decisions, which follow from declarations.
Result<std::unique_ptr<Resolved>> readAndResolve(
    const Console& console, const CompileArguments& arguments, CompileCache& cache,
    std::unique_ptr<Resolved> earlier, std::span<const std::string> changed,
    const std::function<void(const std::vector<Diagnostic>&)>& report) {
    console.progress("reading " + base::join(arguments.scenes));
    if (earlier != nullptr && areGlsl(changed, *earlier->import.materialModel)) {
        GLINT_TRY(const auto model, materials::withPresentGlsl(*earlier->import.materialModel, changed));
        earlier->import.materialModel = earlier->build.plan.model = model;
        earlier->build.milliseconds = 0.0;
        earlier->build.settings.compile.progress = console.countTo("compiling");
        report(earlier->diagnostics);
        return earlier;
    }
    auto resolved = std::make_unique<Resolved>();
    if (earlier != nullptr && areOfScenes(changed, earlier->scenes)) {
        resolved->import = earlier->import;
    } else {
        GLINT_TRY_DO(checkOutputs(arguments));
        GLINT_TRY(resolved->import,
                  session::importOptions(arguments.settings, session::ImageReading::None, cache.store()));
    }
    const auto keep = [&](const std::vector<Diagnostic>& diagnostics) {
        resolved->diagnostics.insert(resolved->diagnostics.end(), diagnostics.begin(), diagnostics.end());
        report(diagnostics);
    };
    GLINT_TRY(resolved->scenes, readScenes(arguments.scenes, resolved->import));
    keep(warningsOf(resolved->scenes));
    GLINT_TRY(const auto target, measure::targetOf(arguments.settings));
    compiler::Settings asked = arguments.settings;
    asked.compile.progress = console.countTo("compiling");
    GLINT_TRY(resolved->build, compiler::resolve(resolved->scenes, asked, target));
    const compiler::Build& build = resolved->build;
    if (build.lockText) {
        GLINT_TRY_DO(base::checkOutputFile(build.settings.lock.file));
    }
    keep(build.messages);
    if (const std::optional<compiler::StrategyAdvice>& advice = build.settings.compile.strategyChoice) {
        console.detail(fmt::format("strategy {}: {}", advice->choice.strategy, advice->choice.why));
    }
    keep(idleSettings(build));
    return resolved;
}

// `watched` is null unless the run is one of a watch.
Result<int> compileOnce(const Console& console, const CompileArguments& arguments, CompileCache& cache,
                        WatchedRun* watched) {
    const base::Clock::time_point start = base::Clock::now();
    const bool plans = !arguments.planOnly.path.empty();
    if (watched == nullptr && !arguments.dryRun && !plans) {
        GLINT_TRY(const auto done, repeatEarlier(console, arguments, cache, start));
        if (done) {
            return *done;
        }
    }
    compiler::ActionRecord run;
    const std::vector<std::filesystem::path> others = otherInputs(arguments);
    const bool known = addFiles(run.inputs, others);
    const auto report = [&](const std::vector<Diagnostic>& diagnostics) {
        run.diagnostics.insert(run.diagnostics.end(), diagnostics.begin(), diagnostics.end());
        console.report(diagnostics);
    };
    std::unique_ptr<Resolved> earlier = watched != nullptr ? std::move(watched->resolved) : nullptr;
    GLINT_TRY(auto own,
              readAndResolve(console, arguments, cache, std::move(earlier),
                             watched != nullptr ? watched->changed : std::vector<std::string>(), report));
    const Resolved& resolved = *own;
    if (watched != nullptr) {
        watched->resolved = std::move(own);
    }
    if (console.refused()) {
        return kExitFailed;
    }
    const compiler::Build& build = resolved.build;
    // The files of scenes come first, each in the state in which it was read.
    const std::vector<compiler::FileState> sceneFiles = filesOf(resolved.scenes);
    run.inputs.insert(run.inputs.begin(), sceneFiles.begin(), sceneFiles.end());
    std::vector<std::string> dependencies = pathsOf(sceneFiles);
    for (const std::filesystem::path& file : others) {
        dependencies.push_back(file.string());
    }
    for (const materials::PackFile& file : resolved.import.materialModel->files) {
        run.inputs.push_back({file.path, file.bytes, file.hash, {}});
        dependencies.push_back(file.path);
    }
    if (!arguments.depfile.file.empty()) {
        GLINT_TRY([[maybe_unused]] const auto listed,
                  compiler::makeDepfile(arguments.depfile.targets, dependencies));
    }
    if (arguments.dryRun) {
        // Everything but to compile and to write.
        GLINT_TRY([[maybe_unused]] const auto planned, planPackage(build));
        tell(console, summaryOf(Outcome{arguments, build}), std::nullopt, false,
             base::millisecondsSince(start));
        return kExitDone;
    }
    if (plans) {
        return planOnly(console, arguments, build, dependencies, start);
    }
    if (watched != nullptr) {
        for (const compiler::FileState& file : run.inputs) {
            watched->inputs.push_back({file.path, file.hash});
        }
        watched->readMs = base::millisecondsSince(start) - build.milliseconds;
    }
    console.progress("compiling " + base::join(arguments.scenes));
    GLINT_TRY(const auto package,
              compilePackage(build, cache.modules(), watched != nullptr ? &watched->warm : nullptr));
    console.progress("writing " + outputsOf(arguments));
    const base::Clock::time_point compiled = base::Clock::now();
    GLINT_TRY_DO(writeOutputs(build, package, arguments, dependencies,
                              watched != nullptr ? &watched->written : nullptr));
    if (watched != nullptr) {
        describeRun(package, *watched);
        watched->writeMs = package.tablesMs + base::millisecondsSince(compiled);
        return kExitDone;
    }
    CompileSummary summary = summaryOf(Outcome{.arguments = arguments, .build = build, .package = &package});
    // A run that changes its own input may report other things next time, so it is not kept.
    if (known && !build.lockText && addOutputs(package, arguments, run)) {
        run.summary = pack(summary);
        cache.keep(run);
    }
    cache.close(console);
    tell(console, std::move(summary), countModules(package), false, base::millisecondsSince(start));
    return kExitDone;
}

Result<int> compile(const Console& console, const CompileArguments& arguments) {
    // The names of further inputs belong to the key: a new file in a pack is a new run.
    const std::vector<std::filesystem::path> further = furtherInputs(arguments);
    CompileCache cache(arguments.cache, arguments.options, further);
    if (!arguments.watch) {
        return compileOnce(console, arguments, cache, nullptr);
    }
    const int code = watchInputs(console, arguments,
                                 [&](const Console& own, const CompileArguments& current, WatchedRun& run) {
                                     return compileOnce(own, current, cache, &run);
                                 });
    cache.close(console);
    return code;
}

// --- glint compile-module: compiles one module of a plan ---

struct ModuleArguments {
    std::string input;
    std::string output;
};

Result<int> compileModule(const Console& console, const ModuleArguments& arguments) {
    GLINT_TRY_DO(base::checkOutputFile(arguments.output));
    console.progress("compiling " + arguments.input);
    GLINT_TRY_DO(compiler::compileModuleFile(arguments.input, arguments.output));
    if (console.isJson()) {
        console.result(base::Json{{"input", arguments.input}, {"output", arguments.output}});
    }
    return kExitDone;
}

}  // namespace

void addCompile(CLI::App& app, Action& chosen, std::span<const char* const> line) {
    auto arguments = std::make_shared<CompileArguments>();
    arguments->line.assign(line.begin(), line.end());
    CLI::App& command = addCommand(
        app, {.name = "compile",
              .what = "Compile a scene's materials into a package of shaders",
              .examples = {"glint compile scene.gltf -o scene.glint",
                           "glint compile scene.gltf -o scene.glint --strategy auto --emit header,library"},
              .usual = {"--output", "--embed", "--strategy", "--effects", "--merge", "--bounces", "--emit",
                        "--watch", "--dry-run", "--jobs"}});
    addCompileOptions(command, *arguments);
    command.callback([arguments, &command, &chosen] {
        finishCompile(command, *arguments);
        chosen = [arguments](const Console& console) { return compile(console, *arguments); };
    });
}

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
