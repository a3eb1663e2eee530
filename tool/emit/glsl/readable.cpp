#include "emit/glsl/passes.h"
#include "emit/glsl/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

// --- The second half of a preprocessor: resolves what the text itself decides ---

constexpr std::string_view kOwnPrefix = "GLINT_";

// The values of macros without parameters, as text.
using Macros = std::map<std::string, std::string, std::less<>>;

// Returns the name at the start of a #define's or #undef's argument.
std::string_view nameIn(std::string_view argument) {
    return argument.substr(0, std::min(argument.find_first_of(" \t("), argument.size()));
}

// Parses a number; "2u" and "0x10" are numbers too.
std::optional<std::uint64_t> numberIn(std::string_view text) {
    if (text.ends_with('u')) {
        text.remove_suffix(1);
    }
    const bool hex = text.starts_with("0x");
    text.remove_prefix(hex ? 2 : 0);
    std::uint64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, value, hex ? 16 : 10);
    return parsed.ec == std::errc() && parsed.ptr == end ? std::optional(value) : std::nullopt;
}

// Evaluates a condition. Returns nothing if the text alone does not decide it.
std::optional<bool> evaluate(const Macros& macros, std::string_view word, std::string_view condition) {
    const std::string_view name = nameIn(condition);
    if (!name.starts_with(kOwnPrefix)) {
        return std::nullopt;
    }
    const auto found = macros.find(name);
    if (word == "ifdef" || word == "ifndef") {
        return (found != macros.end()) == (word == "ifdef");
    }
    if (found == macros.end()) {
        return std::nullopt;
    }
    const std::optional<std::uint64_t> value = numberIn(found->second);
    const std::string_view rest = trim(condition.substr(name.size()));
    if (rest.empty()) {
        return value ? std::optional(*value != 0) : std::nullopt;
    }
    const std::optional<std::uint64_t> other =
        numberIn(trim(rest.substr(std::min<std::size_t>(2, rest.size()))));
    if (!value || !other || !(rest.starts_with("==") || rest.starts_with("!="))) {
        return std::nullopt;
    }
    return (*value == *other) == rest.starts_with("==");
}

// A conditional that is open.
struct Conditional {
    bool decided = false;  // its directives are dropped
    bool taken = true;     // this branch stays
    bool done = false;     // an earlier branch has stayed
};

class Resolver {
public:
    // Returns false if the line is to be dropped.
    bool keep(std::string_view line) {
        const Directive directive = parseDirective(line);
        const std::string_view word = directive.word;
        if (word == "if" || word == "ifdef" || word == "ifndef") {
            return begin(directive);
        }
        if (!open_.empty() && (word == "else" || word == "elif")) {
            return next(directive);
        }
        if (!open_.empty() && word == "endif") {
            const bool decided = open_.back().decided;
            open_.pop_back();
            return !decided && isActive();
        }
        if (!isActive()) {
            return false;
        }
        const std::string_view name = nameIn(directive.argument);
        if (word == "define") {
            macros_[std::string(name)] = trim(directive.argument.substr(name.size()));
        } else if (word == "undef") {
            macros_.erase(std::string(name));
        }
        return true;
    }

private:
    bool isActive() const {
        return std::ranges::all_of(open_, &Conditional::taken);
    }
    bool begin(const Directive& directive) {
        const bool active = isActive();
        const std::optional<bool> value =
            active ? evaluate(macros_, directive.word, directive.argument) : std::optional(false);
        open_.push_back({value.has_value(), value.value_or(true), value.value_or(false)});
        return active && !value;
    }
    bool next(const Directive& directive) {
        Conditional& current = open_.back();
        if (!current.decided) {
            return isActive();
        }
        if (current.done) {
            current.taken = false;
        } else if (directive.word == "else") {
            current.taken = true;
        } else {
            // After flatten(), an #elif whose #if was decided always has a condition that can be decided too.
            current.taken = evaluate(macros_, "if", directive.argument).value_or(false);
        }
        current.done = current.done || current.taken;
        return false;
    }

    Macros macros_;
    std::vector<Conditional> open_;
};
// A macro whose definition is on one line.
struct Macro {
    std::vector<std::string> parameters;
    bool takesArguments = false;
    std::string body;
};

std::vector<std::string> splitArguments(std::string_view text) {
    std::vector<std::string> parts;
    while (!text.empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        parts.emplace_back(trim(text.substr(0, comma)));
        text.remove_prefix(std::min(comma + 1, text.size()));
    }
    return parts;
}

Macro parseMacro(std::string_view argument) {
    const std::string_view name = nameIn(argument);
    std::string_view rest = argument.substr(name.size());
    Macro macro;
    if (rest.starts_with('(')) {
        const std::size_t end = rest.find(')');
        macro.takesArguments = true;
        macro.parameters = splitArguments(rest.substr(1, end - 1));
        rest = rest.substr(end + 1);
    }
    macro.body = trim(rest);
    return macro;
}

// Returns the macro's body with its parameters replaced and ## removed.
std::string substitute(const Macro& macro, const std::vector<std::string>& arguments) {
    std::string text = macro.body;
    for (std::size_t i = 0; i < macro.parameters.size() && i < arguments.size(); ++i) {
        std::string result;
        std::size_t done = 0;
        for (const std::string_view word : identifiersOf(text)) {
            const auto at = static_cast<std::size_t>(word.data() - text.data());
            result += text.substr(done, at - done);
            result += word == macro.parameters[i] ? arguments[i] : std::string(word);
            done = at + word.size();
        }
        result += text.substr(done);
        text = std::move(result);
    }
    for (std::size_t at = text.find("##"); at != std::string::npos; at = text.find("##")) {
        text.erase(at, 2);
    }
    return text;
}

std::string expandLine(std::string text, const std::map<std::string, Macro, std::less<>>& macros) {
    for (std::size_t from = 0; from < text.size();) {
        bool changed = false;
        for (const std::string_view word : identifiersOf(text)) {
            const auto at = static_cast<std::size_t>(word.data() - text.data());
            const auto found = macros.find(word);
            if (at < from || found == macros.end()) {
                continue;
            }
            std::size_t end = at + word.size();
            std::vector<std::string> arguments;
            if (found->second.takesArguments) {
                const std::size_t close = text.find(')', end);
                arguments = splitArguments(std::string_view(text).substr(end + 1, close - end - 1));
                end = close + 1;
            }
            const std::string replacement = substitute(found->second, arguments);
            text.replace(at, end - at, replacement);
            from = at + replacement.size();
            changed = true;
            break;
        }
        if (!changed) {
            break;
        }
    }
    return text;
}

// Drops the branches of conditionals that earlier #defines decide against, and the directives of decided
// conditionals. Undecided ones stay. It decides these conditions: NAME, NAME == number, NAME != number, and
// whether a name is defined, for names that begin with "GLINT_".
GlslUnit resolveConditionals(const GlslUnit& unit) {
    Resolver resolver;
    GlslUnit result;
    for (std::size_t i = 0; i < unit.size(); ++i) {
        if (resolver.keep(unit.line(i))) {
            result.add(unit, i, 1);
        }
    }
    return result;
}

// Replaces the macros that `file` defines, each on one line, by their bodies. Lines that become empty are
// dropped.
GlslUnit expandMacros(const GlslUnit& unit, std::string_view file) {
    std::map<std::string, Macro, std::less<>> macros;
    GlslUnit result;
    for (std::size_t i = 0; i < unit.size(); ++i) {
        const Directive directive = parseDirective(unit.line(i));
        if (unit.file(i) == file && directive.word == "define") {
            macros[std::string(nameIn(directive.argument))] = parseMacro(directive.argument);
            continue;
        }
        if (!directive.word.empty() || identifiersOf(unit.line(i)).empty()) {
            result.add(unit, i, 1);
            continue;
        }
        const std::string text = expandLine(std::string(unit.line(i)), macros);
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
    Parts parts = partsOf(dropUnused(expandMacros(resolveConditionals(unit), kSharedTypes)));
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
