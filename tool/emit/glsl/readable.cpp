#include "emit/glsl/macros.h"
#include "emit/glsl/passes.h"
#include "emit/glsl/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

// Replaces the macros that `file` defines, each on one line, by their bodies. Lines that become empty are
// dropped.
GlslUnit expandMacros(const GlslUnit& unit, std::string_view file) {
    Macros macros;
    GlslUnit result;
    for (std::size_t i = 0; i < unit.size(); ++i) {
        const Directive directive = parseDirective(unit.line(i));
        if (unit.file(i) == file && directive.word == "define") {
            macros.define(directive.argument);
            continue;
        }
        if (!directive.word.empty() || identifiersOf(unit.line(i)).empty()) {
            result.add(unit, i, 1);
            continue;
        }
        const std::string text = macros.expand(unit.line(i));
        if (!trim(text).empty()) {
            result.add(text, unit.file(i), unit.number(i));
        }
    }
    return result;
}

// The file with the macros that let one text be both C++ and GLSL.
constexpr std::string_view kSharedTypes = "interop/types.h";
constexpr std::string_view kMadeBy = "// Made by glint";

bool isBlank(std::string_view line) {
    return trim(line).empty();
}

bool isComment(std::string_view line) {
    return trim(line).starts_with("//");
}

// Successive lines from one file.
struct Section {
    std::string file;
    std::vector<std::string> lines;

    bool isRemark() const {
        return std::ranges::all_of(lines,
                                   [](const std::string& line) { return isBlank(line) || isComment(line); });
    }
};

// A comment at the head of a file stands before its includes. It is moved down to the file's own code, or
// dropped if there is none.
std::vector<Section> placeRemarks(std::vector<Section> sections) {
    std::map<std::string, std::vector<std::string>> waiting;
    std::vector<Section> placed;
    for (Section& section : sections) {
        std::vector<std::string>& remark = waiting[section.file];
        if (section.isRemark()) {
            remark.insert(remark.end(), section.lines.begin(), section.lines.end());
            continue;
        }
        if (!remark.empty()) {
            remark.emplace_back();
        }
        remark.insert(remark.end(), section.lines.begin(), section.lines.end());
        section.lines = std::exchange(remark, {});
        if (!placed.empty() && placed.back().file == section.file) {
            placed.back().lines.insert(placed.back().lines.end(), section.lines.begin(), section.lines.end());
        } else {
            placed.push_back(std::move(section));
        }
    }
    return placed;
}

// Appends lines; several blank lines become one, and those at both ends are dropped.
void appendLines(std::string& text, const std::vector<std::string>& lines) {
    bool blank = false;
    bool any = false;
    for (const std::string& line : lines) {
        if (trim(line).empty()) {
            blank = any;
            continue;
        }
        text += blank ? "\n" : "";
        text += line + "\n";
        blank = false;
        any = true;
    }
}

// The lines of a unit by what becomes of them.
struct Parts {
    std::string header;                   // comments at the start that say what made the unit
    std::vector<std::string> extensions;  // each once, in order
    std::vector<Section> sections;        // everything else but #version
};

Parts partsOf(const GlslUnit& unit) {
    Parts parts;
    // #defines of the module may stand before the header.
    bool maybeHeader = true;
    for (std::size_t i = 0; i < unit.size(); ++i) {
        const std::string_view line = unit.line(i);
        const std::string_view word = parseDirective(line).word;
        if (maybeHeader && isComment(line) && (!parts.header.empty() || line.starts_with(kMadeBy))) {
            parts.header += fmt::format("{}\n", line);
            continue;
        }
        maybeHeader = maybeHeader && parts.header.empty() && (isBlank(line) || line.starts_with('#'));
        if (word == "version") {
            continue;
        }
        if (word == "extension") {
            if (std::ranges::find(parts.extensions, line) == parts.extensions.end()) {
                parts.extensions.emplace_back(line);
            }
            continue;
        }
        if (parts.sections.empty() || parts.sections.back().file != unit.file(i)) {
            parts.sections.push_back({std::string(unit.file(i)), {}});
        }
        parts.sections.back().lines.emplace_back(line);
    }
    return parts;
}

}  // namespace

std::string makeReadable(const GlslUnit& unit, std::string_view header) {
    Parts parts = partsOf(dropUnused(expandMacros(cutDecided(unit), kSharedTypes)));
    std::string text = "#version 460\n" + (parts.header.empty() ? std::string(header) : parts.header);
    if (!parts.extensions.empty()) {
        text += fmt::format("\n{}\n", fmt::join(parts.extensions, "\n"));
    }
    for (const Section& section : placeRemarks(std::move(parts.sections))) {
        text += fmt::format("\n// --- {}\n", section.file);
        appendLines(text, section.lines);
    }
    return text;
}

}  // namespace glint::compiler
