#include "base/files.h"
#include "base/text.h"
#include "emit/module_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

namespace glint::compiler {

namespace fs = std::filesystem;

namespace {

// --- Dependency files ---

// These characters have a meaning in Make or Ninja, and both take them literally after a backslash.
constexpr std::string_view kEscaped = " #:";
// Ninja ends a name at these characters (its depfile parser has a list of the characters of names), and Make
// at some of them.
constexpr std::string_view kImpossible = "\"&'*;<>?^`|\t\n\r";
// Make reads a line with a '=' as an assignment, and one with a '%' left of the colon as a pattern.
constexpr std::string_view kNotInTargets = "=%";

bool isAmong(char c, std::string_view characters) {
    return characters.find(c) != std::string_view::npos;
}

Diagnostic nameError(std::string_view name, const std::string& why) {
    return makeError("depfile-name", std::string(name),
                     "can't be written to a file for Make and Ninja: " + why,
                     "rename the file, or leave out --depfile");
}

Result<std::string> escapeName(std::string_view name, bool isTarget) {
    std::string text;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        const bool isLast = i + 1 == name.size();
        if (isAmong(c, kImpossible) || (isTarget && isAmong(c, kNotInTargets))) {
            return nameError(name, c < ' ' ? "it has a control character" : fmt::format("it has a {}", c));
        }
        if (c == '\\' && (isLast || isAmong(name[i + 1], kEscaped))) {
            return nameError(name, "they disagree about its backslash");
        }
        if (c == ':' && isLast) {
            return nameError(name, "it ends in a colon");
        }
        text += c == '$' ? "$" : isAmong(c, kEscaped) ? "\\" : "";
        text += c;
    }
    // Make expands a leading ~ to a home folder.
    if (text.starts_with('~')) {
        text.insert(0, "./");
    }
    return text;
}

}  // namespace

Result<std::string> makeDepfile(std::span<const std::string> targets,
                                std::span<const std::string> dependencies) {
    std::string text;
    for (const std::string& target : targets) {
        GLINT_TRY(const auto name, escapeName(target, true));
        text += (text.empty() ? "" : " ") + name;
    }
    text += ':';
    // Make reads what follows the colon as an assignment if the first name contains a '='.
    std::vector<std::string_view> names(dependencies.begin(), dependencies.end());
    std::stable_partition(names.begin(), names.end(),
                          [](std::string_view name) { return !isAmong('=', name); });
    std::set<std::string_view> known;
    for (const std::string_view name : names) {
        if (known.insert(name).second) {
            GLINT_TRY(const auto escaped, escapeName(name, false));
            text += " \\\n  " + escaped;
        }
    }
    if (!names.empty() && isAmong('=', names.front())) {
        return nameError(names.front(), "every name has a '='");
    }
    return text + "\n";
}

Status writeDepfile(const Depfile& depfile, std::span<const std::string> dependencies) {
    if (depfile.file.empty()) {
        return okStatus();
    }
    GLINT_TRY(const auto text, makeDepfile(depfile.targets, dependencies));
    return base::writeFile(depfile.file, text);
}

// --- Plans for Ninja ---

namespace {

// The beginning of each build file.
constexpr std::string_view kNinjaFirstWords = "# Made by glint compile --plan-only";

Diagnostic ninjaNameError(const std::string& name, const char* why) {
    return makeError("ninja-name", name, fmt::format("can't be written to a file for Ninja: it has {}", why),
                     "rename it, or give another path");
}

// Puts a '$' before each of the characters (the manual's "Lexical syntax").
std::string escaped(std::string_view text, std::string_view characters) {
    std::string result;
    for (const char c : text) {
        result += isAmong(c, characters) ? "$" : "";
        result += c;
    }
    return result;
}

// Escapes a path in a build statement.
std::string escapePath(std::string_view path) {
    return escaped(path, "$ :");
}

std::string escapePaths(std::span<const std::string> paths) {
    std::string text;
    for (const std::string& path : paths) {
        text += " " + escapePath(path);
    }
    return text;
}

// Escapes the value of a variable.
std::string escapeValue(std::string_view value) {
    return escaped(value, "$");
}

std::string wordsValue(const std::vector<std::string>& words) {
    return escapeValue(base::shellWords(words));
}

std::optional<Diagnostic> findImpossible(const NinjaPlan& plan) {
    std::vector<std::string> paths{plan.tool, plan.folder.path, plan.folder.buildFile()};
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

std::string pathOf(const PlanFolder& folder, const std::string& module, std::string_view suffix) {
    return (fs::path(folder.modules()) / (module + std::string(suffix))).string();
}

// Returns whether nameOfModuleText() may have made the name, whatever the suffix is.
bool isModuleName(const std::string& stem) {
    return stem.size() == kModuleNameLength &&
           stem.find_first_not_of("0123456789abcdef") == std::string::npos;
}

Status checkFolder(const fs::path& file) {
    std::error_code error;
    if (!fs::exists(file, error)) {
        return okStatus();
    }
    GLINT_TRY(const auto bytes, base::readFile(file));
    return base::asText(bytes).starts_with(kNinjaFirstWords)
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
        if ((suffix == kModuleTextSuffix || suffix == kCompiledModuleSuffix) &&
            isModuleName(path.stem().string()) && !kept.contains(path.stem().string())) {
            gone.push_back(path);
        }
    }
    for (const fs::path& path : gone) {
        // An error is ignored, because a file that stays does no harm.
        fs::remove(path, error);
    }
}

Result<std::string> makeNinjaFile(const NinjaPlan& plan, std::span<const PlannedModule> modules) {
    if (std::optional<Diagnostic> impossible = findImpossible(plan)) {
        return *impossible;
    }
    const std::string file = escapePath(plan.folder.buildFile());
    const std::string tool = escapePath(plan.tool);
    std::string text = fmt::format(
        "{}. Do not edit.\n"
        "# Run it where that command ran: ninja -f {}\n"
        "ninja_required_version = 1.8\n"
        "builddir = {}\n"
        "glint = {}\n"
        "launcher = {}\n\n",
        kNinjaFirstWords, base::shellWords({plan.folder.buildFile()}), escapeValue(plan.folder.path),
        wordsValue({plan.tool}), escapeValue(plan.launcher.empty() ? "" : plan.launcher + " "));
    // An output that would be the same keeps its time stamp, which restat tells Ninja.
    text += fmt::format(
        "rule plan\n"
        "  command = $glint {} > /dev/null\n"
        "  description = PLAN\n"
        "  depfile = {}\n"
        "  generator = 1\n"
        "  restat = 1\n\n"
        "rule module\n"
        "  command = $launcher$glint compile-module $in -o $out\n"
        "  description = MODULE $name\n"
        "  restat = 1\n\n"
        "rule package\n"
        "  command = $glint {}\n"
        "  description = PACKAGE $out\n"
        "  depfile = {}\n"
        "  restat = 1\n\n",
        wordsValue(plan.plan), escapeValue(plan.folder.planDepfile()), wordsValue(plan.package),
        escapeValue(plan.folder.packageDepfile()));
    text += "build " + file + " |";
    for (const PlannedModule& module : modules) {
        text += " $\n    " + escapePath(pathOf(plan.folder, module.file, kModuleTextSuffix));
    }
    text += ": plan | " + tool + "\n\n";
    for (const PlannedModule& module : modules) {
        std::string parts;
        for (const std::string& part : module.parts) {
            parts += " " + escapePath(pathOf(plan.folder, part, kCompiledModuleSuffix));
        }
        text += fmt::format("build {}: module {} | {}{}\n  name = {}\n",
                            escapePath(pathOf(plan.folder, module.file, kCompiledModuleSuffix)),
                            escapePath(pathOf(plan.folder, module.file, kModuleTextSuffix)), tool, parts,
                            escapeValue(module.name));
    }
    text += "\nbuild" + escapePaths(plan.outputs) + ": package";
    for (const PlannedModule& module : modules) {
        text += " $\n    " + escapePath(pathOf(plan.folder, module.file, kCompiledModuleSuffix));
    }
    return text + " | " + tool + "\n\ndefault" + escapePaths(plan.outputs) + "\n";
}

}  // namespace

std::string PlanFolder::buildFile() const {
    return (fs::path(path) / "build.ninja").string();
}

std::string PlanFolder::modules() const {
    return (fs::path(path) / "modules").string();
}

std::string PlanFolder::planDepfile() const {
    return (fs::path(path) / "plan.d").string();
}

std::string PlanFolder::packageDepfile() const {
    return (fs::path(path) / "package.d").string();
}

Status writePlan(const NinjaPlan& plan, const PackagePlan& package,
                 std::span<const std::string> dependencies) {
    const std::string file = plan.folder.buildFile();
    const std::string modules = plan.folder.modules();
    GLINT_TRY(const auto text, makeNinjaFile(plan, package.modules));
    GLINT_TRY(const auto depfile, makeDepfile(std::span(&file, 1), dependencies));
    GLINT_TRY_DO(checkFolder(file));
    std::error_code error;
    fs::create_directories(modules, error);
    if (error) {
        return makeError("file-write", modules, "can't be made: " + error.message(),
                         "check the folder and its permissions");
    }
    std::set<std::string> kept;
    for (const PlannedModule& module : package.modules) {
        kept.insert(module.file);
        GLINT_TRY_DO(base::writeFile(pathOf(plan.folder, module.file, kModuleTextSuffix), module.text));
    }
    GLINT_TRY_DO(base::writeFile(plan.folder.planDepfile(), depfile));
    GLINT_TRY_DO(base::writeFile(file, text));
    removeOthers(modules, kept);
    return okStatus();
}

}  // namespace glint::compiler
