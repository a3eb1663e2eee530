#include "cli/ninja_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

namespace glint {

namespace {

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

std::string shellWords(std::span<const std::string> words) {
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
        escapeValue(shellWords(plan.plan)), escapeValue(plan.planDepfile),
        escapeValue(shellWords(plan.package)), escapeValue(plan.packageDepfile));
    text += "build " + file + " |";
    for (const NinjaModule& module : plan.modules) {
        text += " $\n    " + escapePath(module.input);
    }
    text += ": plan | " + tool + "\n\n";
    for (const NinjaModule& module : plan.modules) {
        text += fmt::format("build {}: module {} | {}\n  name = {}\n", escapePath(module.output),
                            escapePath(module.input), tool, escapeValue(module.name));
    }
    text += "\nbuild" + escapePaths(plan.outputs) + ": package";
    for (const NinjaModule& module : plan.modules) {
        text += " $\n    " + escapePath(module.output);
    }
    return text + " | " + tool + "\n\ndefault" + escapePaths(plan.outputs) + "\n";
}

}  // namespace glint
