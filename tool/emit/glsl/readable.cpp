#include "emit/glsl/readable.h"

#include "emit/glsl/glsl_text.h"
#include "emit/glsl/prune.h"
#include "emit/glsl/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace glint {

namespace {

// The file with the macros that let one text be both C++ and GLSL.
constexpr std::string_view kSharedTypes = "interop/types.h";
constexpr std::string_view kMadeBy = "// Made by glint";

bool isBlank(const GlslLine& line) {
    return trim(line.text).empty();
}

bool isComment(const GlslLine& line) {
    return trim(line.text).starts_with("//");
}

// Joins the lines to one text, in the form that flatten() gives.
std::string flattenedText(const std::vector<GlslLine>& lines) {
    std::string text;
    std::string file;
    for (const GlslLine& line : lines) {
        if (line.file != file) {
            file = line.file;
            text += fmt::format("#line 1 \"{}\"\n", file);
        }
        text += line.text;
        text += '\n';
    }
    return text;
}

// Successive lines from one file.
struct Section {
    std::string file;
    std::vector<std::string> lines;

    bool isRemark() const {
        return std::ranges::all_of(lines, [](const std::string& line) {
            return trim(line).empty() || trim(line).starts_with("//");
        });
    }
};

std::vector<Section> sectionsOf(const std::vector<GlslLine>& lines) {
    std::vector<Section> sections;
    for (const GlslLine& line : lines) {
        if (sections.empty() || sections.back().file != line.file) {
            sections.push_back({line.file, {}});
        }
        sections.back().lines.push_back(line.text);
    }
    return sections;
}

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

// Takes the extensions out of the lines. Returns each once, in order.
std::vector<std::string> takeExtensions(std::vector<GlslLine>& lines) {
    std::vector<std::string> extensions;
    std::erase_if(lines, [&](const GlslLine& line) {
        if (parseDirective(line.text).word != "extension") {
            return false;
        }
        if (std::ranges::find(extensions, line.text) == extensions.end()) {
            extensions.push_back(line.text);
        }
        return true;
    });
    return extensions;
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

// Takes the comments at the start of the module's own file if they say what made it.
std::string takeHeader(std::vector<GlslLine>& lines) {
    std::string header;
    auto line = lines.begin();
    // #defines of the module may come first.
    while (line != lines.end() && !isComment(*line) && (isBlank(*line) || line->text.starts_with('#'))) {
        ++line;
    }
    if (line == lines.end() || !line->text.starts_with(kMadeBy)) {
        return header;
    }
    const auto begin = line;
    for (; line != lines.end() && isComment(*line); ++line) {
        header += line->text + "\n";
    }
    lines.erase(begin, line);
    return header;
}

}  // namespace

std::string makeReadable(std::string_view flattened, std::string_view header) {
    std::vector<GlslLine> lines = expandMacros(resolveConditionals(linesOf(flattened)), kSharedTypes);
    lines = linesOf(dropUnused(flattenedText(lines)));
    const std::string own = takeHeader(lines);
    const std::vector<std::string> extensions = takeExtensions(lines);

    std::string text = "#version 460\n" + (own.empty() ? std::string(header) : own);
    if (!extensions.empty()) {
        text += fmt::format("\n{}\n", fmt::join(extensions, "\n"));
    }
    for (const Section& section : placeRemarks(sectionsOf(lines))) {
        text += fmt::format("\n// --- {}\n", section.file);
        appendLines(text, section.lines);
    }
    return text;
}

}  // namespace glint
