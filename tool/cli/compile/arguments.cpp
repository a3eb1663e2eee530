#include "base/files.h"
#include "base/text.h"
#include "cli/compile/compile.h"
#include "cli/options/options.h"
#include "emit/package/compiled_package.h"
#include "emit/package/header.h"
#include "materials/declarations.h"
#include "resolve/host.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace glint::cli {

namespace {

constexpr const char* kPlanOnly = "--plan-only";
constexpr const char* kLauncher = "--launcher";
constexpr const char* kModules = "--modules";
constexpr const char* kWatch = "--watch";

// Says what is wrong with a folder's name that looks like a file of another kind.
std::string complaintAboutFolder(const std::string& text) {
    constexpr std::string_view kFiles[] = {".png", ".exr",  ".hdr", ".jpg", ".jpeg", ".gltf",
                                           ".glb", ".json", ".spv", ".cpp", ".h"};
    const std::string extension = std::filesystem::path(text).extension().string();
    return std::ranges::find(kFiles, extension) == std::end(kFiles)
               ? std::string()
               : fmt::format(
                     "is a package's folder, and \"{}\" is named like a file; name a folder such as "
                     "{}.glint, or use glint render for pictures",
                     text, std::filesystem::path(text).stem().string());
}

void addShaderOptions(CLI::App& command, CompileArguments& arguments) {
    const OptionGroup group(command, "Shaders");
    addSettings(command, compiler::kOfCompile, arguments.settings);
    addCalibration(command, arguments.settings);
    addProfileInput(command, arguments.settings);
    addLockOptions(command, arguments.settings.lock, true);
    addHostOption(command, arguments.settings);
    addFlag(command, "--environment-map", arguments.settings.compile.environmentMap,
            "rays that leave the scene see an environment map, which every frame then needs, instead of a "
            "gradient");
    addFlag(command, "--debug-info", arguments.settings.compile.debugInfo,
            "keep names in the SPIR-V, for debuggers");
}

// Options for compilation by other processes.
void addFarmOptions(CLI::App& command, CompileArguments& arguments, CLI::Option& dry) {
    const OptionGroup group(command, "Farm");
    CLI::Option& plan =
        addText(command, kPlanOnly, arguments.planOnly.path, "DIR",
                "compile nothing: write each module's source into this folder, and a build.ninja that "
                "compiles them one by one and makes the package; an earlier plan is replaced");
    CLI::Option& launcher = addText(
        command, kLauncher, arguments.launcher, "COMMAND",
        "with --plan-only: the command that runs each compilation, such as the client of a build farm");
    CLI::Option& modules =
        addText(command, kModules, arguments.modules, "DIR",
                "take modules that glint compile-module made instead of compiling; build.ninja uses this");
    launcher.needs(&plan);
    plan.excludes(&dry)->excludes(&modules);
    modules.excludes(&dry);
    command.get_option(kWatch)->excludes(&plan)->excludes(&modules);
}

void addOutputOptions(CLI::App& command, CompileArguments& arguments) {
    const OptionGroup group(command, "Output");
    addText(command, "-o,--output", arguments.output, "DIR",
            "folder of the package; an earlier package is replaced, and any other content refused (required "
            "without --embed or --dry-run)",
            complaintAboutFolder);
    addOutputFile(command, "--embed", arguments.embed, "FILE.cpp", {".cpp", ".cc", ".cxx"},
                  "write the package as a C++ source; a header comes beside it, for programs that ship no "
                  "files, and -o is then optional");
    addChoices(command, "--emit", arguments.emit, {"glsl", "header", "library", "linkable"},
               "what else the package contains, separated by commas: glsl: the shaders' sources; header: C++ "
               "tables; library: shading as GLSL functions, for shaders of your own; linkable: these "
               "functions as SPIR-V, for linkers");
    CLI::Option& dry = addFlag(command, "--dry-run", arguments.dryRun,
                               "read, check and plan everything as usual; compile nothing and write nothing");
    addFlag(command, kWatch, arguments.watch,
            "compile again whenever an input changes, until Ctrl-C; increments the counter in DIR.stamp "
            "after each new package")
        .excludes(&dry);
    addJobs(command, arguments.settings.compile.jobs);
    addCacheOptions(command, arguments.cache);
    CLI::Option& depfile = addOutputFile(command, "--depfile", arguments.depfile.file, "FILE", {},
                                         "list the files that were read, for Make and Ninja");
    addTexts(command, "--depfile-target", arguments.depfile.targets, "NAME",
             "target of that list (default: the package's manifest.json, else the file of --embed); needs "
             "--depfile; may be repeated")
        .needs(&depfile)
        ->allow_extra_args(false);
    addFarmOptions(command, arguments, dry);
}

}  // namespace

void addCompileOptions(CLI::App& command, CompileArguments& arguments) {
    addTexts(command, "SCENE", arguments.scenes, "FILE",
             "the scenes, .gltf or .glb, or lists of materials; several share the shaders, and each has its "
             "own tables")
        .required();
    addReadingOptions(command, arguments.settings);
    addSettingsFile(command, arguments.settingsFile);
    addOutputOptions(command, arguments);
    addShaderOptions(command, arguments);
}

void finishCompile(const CLI::App& command, CompileArguments& arguments) {
    if (arguments.output.empty() && arguments.embed.empty() && !arguments.dryRun) {
        throw CLI::ValidationError("--output", "is missing; give -o DIR, --embed FILE.cpp or --dry-run");
    }
    if (arguments.watch && arguments.output.empty()) {
        throw CLI::ValidationError("--output", "is missing, and --watch needs it; give -o DIR");
    }
    if (arguments.watch && command.count("--json") > 0) {
        throw CLI::ExcludesError(kWatch, "--json");
    }
    checkProfile(command, arguments.settings);
    checkSettings(command, arguments.settings);
    if (arguments.depfile.targets.empty()) {
        arguments.depfile.targets = {arguments.planOnly.path.empty() ? mainOutputs(arguments).front()
                                                                     : arguments.planOnly.buildFile()};
    }
    const auto emits = [&](const char* what) {
        return std::ranges::find(arguments.emit, what) != arguments.emit.end();
    };
    arguments.settings.compile.emitHeader = emits("header");
    arguments.settings.compile.emitGlsl = emits("glsl");
    arguments.settings.compile.emitLibrary = emits("library");
    arguments.settings.compile.emitLinkable = emits("linkable");
    arguments.settings.compile.modules = arguments.modules;
    arguments.options = describeOptions(command);
    // The words already contain what the settings file says.
    constexpr std::string_view kOwn[] = {kPlanOnly, kLauncher, kModules, "--settings"};
    constexpr std::string_view kReport[] = {"--werror", "-W"};
    for (const CLI::Option* const option : command.get_options()) {
        const std::string name = option->get_name();
        if (option->count() == 0 || option->get_positional()) {
            continue;
        }
        if (std::ranges::find(kReport, name) != std::end(kReport)) {
            addWords(*option, arguments.reportWords);
        } else if (hasEffect(*option) && std::ranges::find(kOwn, name) == std::end(kOwn)) {
            addWords(*option, arguments.words);
        }
    }
    if (!arguments.modules.empty()) {
        // Nothing is compiled, and Ninja knows what is up to date, so the cache is not used.
        arguments.cache.folder = kNoCache;
    }
}

Status checkOutputs(const CompileArguments& arguments) {
    if (!arguments.planOnly.path.empty()) {
        GLINT_TRY_DO(base::checkOutputFolder(arguments.planOnly.path));
    } else if (!arguments.output.empty()) {
        GLINT_TRY_DO(compiler::checkPackageFolder(arguments.output));
    }
    if (arguments.planOnly.path.empty() && !arguments.embed.empty()) {
        // Its folder is made.
        const Status possible = base::checkOutputFolder(std::filesystem::path(arguments.embed).parent_path());
        if (!possible) {
            return makeError(possible.error().id, arguments.embed, possible.error().message,
                             possible.error().hint);
        }
    }
    if (std::error_code error; std::filesystem::is_directory(arguments.embed, error)) {
        GLINT_TRY_DO(base::checkOutputFile(arguments.embed));
    }
    return arguments.depfile.file.empty() ? okStatus() : base::checkOutputFile(arguments.depfile.file);
}

std::vector<std::string> mainOutputs(const CompileArguments& arguments) {
    std::vector<std::string> files;
    if (!arguments.output.empty() || arguments.embed.empty()) {
        files.push_back((std::filesystem::path(arguments.output) / package::kManifestFile).string());
    }
    if (!arguments.embed.empty()) {
        files.push_back(arguments.embed);
        files.push_back(compiler::embeddedHeader(arguments.embed).string());
    }
    return files;
}

std::vector<std::filesystem::path> otherInputs(const CompileArguments& arguments) {
    std::vector<std::filesystem::path> files;
    for (const std::string& file : {arguments.settings.profile, arguments.settings.lock.file,
                                    arguments.settingsFile, arguments.settings.calibration}) {
        if (!file.empty()) {
            files.emplace_back(file);
        }
    }
    if (std::error_code error; std::filesystem::exists(arguments.settings.gpu, error)) {
        files.emplace_back(arguments.settings.gpu);
    }
    // Where the folder can't be listed, reading it says so.
    if (const Result<std::vector<std::filesystem::path>> host =
            compiler::hostFiles(arguments.settings.compile.host);
        host) {
        files.insert(files.end(), host->begin(), host->end());
    }
    return files;
}

std::vector<std::filesystem::path> furtherInputs(const CompileArguments& arguments) {
    std::vector<std::filesystem::path> files = otherInputs(arguments);
    // As above.
    if (const Result<std::vector<std::filesystem::path>> packs =
            materials::packFiles(arguments.settings.materials);
        packs) {
        files.insert(files.end(), packs->begin(), packs->end());
    }
    return files;
}

}  // namespace glint::cli
