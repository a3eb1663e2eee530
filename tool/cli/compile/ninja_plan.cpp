#include "cli/compile/ninja_plan.h"

#include "base/files.h"
#include "emit/module_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace glint::cli {

namespace {

namespace fs = std::filesystem;

Diagnostic ninjaNameError(const std::string& name, const char* why) {
    return makeError("ninja-name", name, fmt::format("can't be written to a file for Ninja: it has {}", why),
                     "rename it, or give another path");
}

// Escapes a path in a build statement (the manual's "Lexical syntax").
std::string escapePath(std::string_view path) {
    std::string text;
    for (const char c : path) {
        text += c == '$' || c == ' ' || c == ':' ? "$" : "";
        text += c;
    }
    return text;
}

std::string escapePaths(std::span<const std::string> paths) {
    std::string text;
    for (const std::string& path : paths) {
        text += ' ';
        text += escapePath(path);
    }
    return text;
}

// Escapes the value of a variable.
std::string escapeValue(std::string_view value) {
    std::string text;
    for (const char c : value) {
        text += c == '$' ? "$" : "";
        text += c;
    }
    return text;
}

std::string shellArguments(std::span<const std::string> words) {
    std::string text;
    for (const std::string& word : words) {
        text += ' ';
        text += shellWord(word);
    }
    return text;
}

std::optional<Diagnostic> findImpossible(const NinjaPlan& plan) {
    std::vector<std::string> paths{plan.tool, plan.folder, plan.file};
    paths.insert(paths.end(), plan.outputs.begin(), plan.outputs.end());
    std::vector<std::string> all = paths;
    all.push_back(plan.launcher);
    all.insert(all.end(), plan.plan.begin(), plan.plan.end());
    all.insert(all.end(), plan.package.begin(), plan.package.end());
    for (const std::string& text : all) {
        if (text.find_first_of("\r\n") != std::string::npos) {
            return ninjaNameError(text, "a line break");
        }
    }
    for (const std::string& path : paths) {
        if (path.find('|') != std::string::npos) {
            return ninjaNameError(path, "a |");
        }
    }
    return std::nullopt;
}

constexpr const char* kModuleFolder = "modules";

fs::path moduleFolder(const CompileArguments& arguments) {
    return fs::path(arguments.planOnly) / kModuleFolder;
}

// Returns whether nameOfModuleText() may have made the name, whatever the suffix is.
bool isModuleName(const std::string& stem) {
    return stem.size() == compiler::kModuleNameLength &&
           stem.find_first_not_of("0123456789abcdef") == std::string::npos;
}

Status checkFolder(const CompileArguments& arguments) {
    const fs::path file = planFile(arguments);
    std::error_code error;
    if (!fs::exists(file, error)) {
        return okStatus();
    }
    GLINT_TRY(const auto bytes, base::readFile(file));
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return text.starts_with(kNinjaFirstWords)
               ? okStatus()
               : makeError("output-not-a-plan", file.string(), "was not made by glint and stays as it is",
                           "choose another folder for --plan-only");
}

// Removes files that the new Ninja file does not know.
void removeOthers(const fs::path& folder, const std::set<std::string>& kept) {
    std::error_code error;
    std::vector<fs::path> gone;
    for (fs::directory_iterator file(folder, error), end; !error && file != end; file.increment(error)) {
        const fs::path& path = file->path();
        const std::string suffix = path.extension().string();
        if ((suffix == compiler::kModuleTextSuffix || suffix == compiler::kCompiledModuleSuffix) &&
            isModuleName(path.stem().string()) && !kept.contains(path.stem().string())) {
            gone.push_back(path);
        }
    }
    for (const fs::path& path : gone) {
        // An error is ignored, because a file that stays does no harm.
        fs::remove(path, error);
    }
}

std::vector<std::string> commandWords(std::vector<std::string> options, std::span<const std::string> further,
                                      const std::vector<std::string>& scenes) {
    options.insert(options.begin(), "compile");
    options.insert(options.end(), further.begin(), further.end());
    options.emplace_back("--");
    options.insert(options.end(), scenes.begin(), scenes.end());
    return options;
}

NinjaPlan describe(const CompileArguments& arguments, const compiler::PackagePlan& plan) {
    NinjaPlan ninja;
    std::error_code error;
    ninja.tool = fs::read_symlink("/proc/self/exe", error).string();
    if (error) {
        ninja.tool = "glint";
    }
    ninja.launcher = arguments.launcher;
    ninja.folder = arguments.planOnly;
    ninja.file = planFile(arguments);
    for (const compiler::PlannedModule& module : plan.modules) {
        const auto pathOf = [&](const std::string& stem, std::string_view suffix) {
            return (moduleFolder(arguments) / (stem + std::string(suffix))).string();
        };
        NinjaModule entry{module.name, pathOf(module.file, compiler::kModuleTextSuffix),
                          pathOf(module.file, compiler::kCompiledModuleSuffix)};
        for (const std::string& part : module.parts) {
            entry.parts.push_back(pathOf(part, compiler::kCompiledModuleSuffix));
        }
        ninja.modules.push_back(std::move(entry));
    }
    ninja.outputs = mainOutputs(arguments);
    const fs::path folder = arguments.planOnly;
    ninja.planDepfile = (folder / "plan.d").string();
    ninja.packageDepfile = (folder / "package.d").string();

    std::vector<std::string> again = arguments.reportWords;
    again.push_back("--plan-only=" + arguments.planOnly);
    if (!arguments.launcher.empty()) {
        again.push_back("--launcher=" + arguments.launcher);
    }
    ninja.plan = commandWords(arguments.words, again, arguments.scenes);
    // This run is quiet, because planning has already reported everything.
    const std::vector<std::string> take{"--modules=" + moduleFolder(arguments).string(),
                                        "--depfile=" + ninja.packageDepfile, "--quiet"};
    ninja.package = commandWords(arguments.words, take, arguments.scenes);
    return ninja;
}

}  // namespace

std::string shellWord(const std::string& text) {
    const auto isPlain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               std::string_view("-_./=,:+@%").find(c) != std::string_view::npos;
    };
    if (!text.empty() && std::ranges::all_of(text, isPlain)) {
        return text;
    }
    std::string word = "'";
    for (const char c : text) {
        if (c == '\'') {
            word += "'\\'";
        }
        word += c;
    }
    word += '\'';
    return word;
}

Result<std::string> makeNinjaFile(const NinjaPlan& plan) {
    if (std::optional<Diagnostic> impossible = findImpossible(plan)) {
        return *impossible;
    }
    const std::string file = escapePath(plan.file);
    const std::string tool = escapePath(plan.tool);
    std::string launcher = plan.launcher;
    if (!launcher.empty()) {
        launcher += ' ';
    }
    std::string text = fmt::format(
        "{}. Do not edit.\n"
        "# Run it where that command ran: ninja -f {}\n"
        "ninja_required_version = 1.8\n"
        "builddir = {}\n"
        "glint = {}\n"
        "launcher = {}\n\n",
        kNinjaFirstWords, shellWord(plan.file), escapeValue(plan.folder), escapeValue(shellWord(plan.tool)),
        escapeValue(launcher));
    // An output that would be the same keeps its time stamp, which restat tells Ninja.
    text += fmt::format(
        "rule plan\n"
        "  command = $glint{} > /dev/null\n"
        "  description = PLAN\n"
        "  depfile = {}\n"
        "  generator = 1\n"
        "  restat = 1\n\n"
        "rule module\n"
        "  command = $launcher$glint compile-module $in -o $out\n"
        "  description = MODULE $name\n"
        "  restat = 1\n\n"
        "rule package\n"
        "  command = $glint{}\n"
        "  description = PACKAGE $out\n"
        "  depfile = {}\n"
        "  restat = 1\n\n",
        escapeValue(shellArguments(plan.plan)), escapeValue(plan.planDepfile),
        escapeValue(shellArguments(plan.package)), escapeValue(plan.packageDepfile));
    text += "build " + file + " |";
    for (const NinjaModule& module : plan.modules) {
        text += " $\n    " + escapePath(module.input);
    }
    text += ": plan | " + tool + "\n\n";
    for (const NinjaModule& module : plan.modules) {
        text +=
            fmt::format("build {}: module {} | {}{}\n  name = {}\n", escapePath(module.output),
                        escapePath(module.input), tool, escapePaths(module.parts), escapeValue(module.name));
    }
    text += "\nbuild" + escapePaths(plan.outputs) + ": package";
    for (const NinjaModule& module : plan.modules) {
        text += " $\n    " + escapePath(module.output);
    }
    return text + " | " + tool + "\n\ndefault" + escapePaths(plan.outputs) + "\n";
}

namespace fs = std::filesystem;

Status writePlan(const CompileArguments& arguments, const compiler::PackagePlan& plan,
                 std::span<const std::string> dependencies) {
    const NinjaPlan ninja = describe(arguments, plan);
    GLINT_TRY(const auto text, makeNinjaFile(ninja));
    const std::string target[] = {ninja.file};
    GLINT_TRY(const auto depfile, makeDepfile(target, dependencies));
    GLINT_TRY_DO(checkFolder(arguments));
    std::error_code error;
    fs::create_directories(moduleFolder(arguments), error);
    if (error) {
        return makeError("file-write", moduleFolder(arguments).string(), "can't be made: " + error.message(),
                         "check the folder and its permissions");
    }
    std::set<std::string> kept;
    for (const compiler::PlannedModule& module : plan.modules) {
        kept.insert(module.file);
        const fs::path file =
            moduleFolder(arguments) / (module.file + std::string(compiler::kModuleTextSuffix));
        GLINT_TRY_DO(base::writeFile(file, module.text));
    }
    GLINT_TRY_DO(base::writeFile(ninja.planDepfile, depfile));
    GLINT_TRY_DO(base::writeFile(ninja.file, text));
    removeOthers(moduleFolder(arguments), kept);
    return okStatus();
}

}  // namespace glint::cli
