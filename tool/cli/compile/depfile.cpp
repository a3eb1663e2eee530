#include "cli/compile/depfile.h"

#include "base/files.h"
#include "cli/options/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

namespace glint::cli {

namespace {

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

Result<std::string> escape(std::string_view name, bool isTarget) {
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

void addDepfileOptions(CLI::App& command, DepfileArguments& arguments) {
    CLI::Option& file = addOutputFile(command, "--depfile", arguments.file, "FILE", {},
                                      "list the files that were read, for Make and Ninja");
    file.group("Output");
    addTexts(command, "--depfile-target", arguments.targets, "NAME",
             "target of that list (default: the package's\n"
             "manifest.json, else the file of --embed); needs --depfile;\n"
             "may be repeated")
        .group("Output")
        ->needs(&file)
        ->allow_extra_args(false);
}

Result<std::string> makeDepfile(std::span<const std::string> targets,
                                std::span<const std::string> dependencies) {
    std::string text;
    for (const std::string& target : targets) {
        Result<std::string> escaped = escape(target, true);
        if (!escaped) {
            return escaped;
        }
        if (!text.empty()) {
            text += ' ';
        }
        text += *escaped;
    }
    text += ':';
    // Make reads what follows the colon as an assignment if the first name contains a '='.
    std::vector<std::string_view> names(dependencies.begin(), dependencies.end());
    std::stable_partition(names.begin(), names.end(),
                          [](std::string_view name) { return !isAmong('=', name); });
    std::set<std::string_view> known;
    for (const std::string_view name : names) {
        if (!known.insert(name).second) {
            continue;
        }
        Result<std::string> escaped = escape(name, false);
        if (!escaped) {
            return escaped;
        }
        text += " \\\n  ";
        text += *escaped;
    }
    if (!names.empty() && isAmong('=', names.front())) {
        return nameError(names.front(), "every name has a '='");
    }
    text += '\n';
    return text;
}

Status writeDepfile(const DepfileArguments& arguments, std::span<const std::string> dependencies) {
    if (arguments.file.empty()) {
        return okStatus();
    }
    const Result<std::string> text = makeDepfile(arguments.targets, dependencies);
    return text ? base::writeFile(arguments.file, *text) : Status(text.error());
}

}  // namespace glint::cli
